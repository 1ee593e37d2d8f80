#include "meshing/core/light_source.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "solver/direct/direct_light.h"
#include "tests/support/degenerate_scenes.h"
#include "tests/support/effort.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/signature_bisection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

// Complete meshes are sound, and their labels are right for whole elements.

namespace halfshade {
namespace {

using test::NamedScene;

struct Meshed {
  Meshed(const SoundScene& scene, const OpaqueScene& opaque,
         const DiscontinuityMeshOptions& options)
      : sources(light_sources(scene)),
        found(find_discontinuities(scene, opaque, sources)),
        mesh(mesh_discontinuities(scene, found, options)),
        elements(mesh.patches.elements()),
        labels(label_cells(scene, opaque, elements, sources)),
        by_element(label_elements(scene, opaque, elements, sources)) {}

  std::vector<LightSource> sources;
  Discontinuities found;
  DiscontinuityMesh mesh;
  ElementTable elements;
  std::vector<Region> labels, by_element;
};

/// Every second time any of them alike, so that small ones are met, and else by area.
int random_element(const ElementTable& elements, const std::vector<double>& area_up_to, int i,
                   test::Random& random) {
  if (i % 2 == 0) return random.integer(0, elements.count() - 1);
  const double place = random(0, 1) * area_up_to.back();
  const auto found = std::lower_bound(area_up_to.begin(), area_up_to.end(), place);
  return static_cast<int>(found - area_up_to.begin());
}

/// Cells and elements may disagree only in elements no wider than bent curves are off.
void expect_alike(const Meshed& m, double diagonal) {
  const double allowed = 1.01 * m.mesh.report.deviation + 1e-9 * diagonal;
  for (std::size_t k = 0; k < m.labels.size(); ++k) {
    if (m.labels[k] == m.by_element[k]) continue;
    const auto e = static_cast<int>(k / m.sources.size());
    const auto [a, b, c] = m.elements.triangle(e);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    EXPECT_LE(2 * m.elements.area[static_cast<std::size_t>(e)] / longest, 3 * allowed)
        << "element " << e << " of surface " << m.elements.surface[static_cast<std::size_t>(e)];
  }
}

Vec3 random_point(const ElementTable& elements, int element, test::Random& random) {
  double u = random(0, 1), v = random(0, 1);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  const auto t = elements.triangle(element);
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

/// How near a point is to a curve of any emitter in its receiver, or to the border.
double distance_to_lines(const SoundScene& scene, const Discontinuities& found, int receiver,
                         const Vec3& point) {
  const Surface& surface = scene.surfaces[static_cast<std::size_t>(receiver)];
  const Vec2 p = surface.frame.to_plane(point);
  double best = test::distance_to_border_lines(surface, p);
  for (const DiscontinuityCurve& curve : found.curves)
    if (curve.receiver == receiver) best = std::min(best, distance(curve.arc, p));
  return best;
}

struct LabelTally {
  int points = 0, near_a_curve = 0, rounding = 0;
  std::array<int, 4> by_region{};
};

/// Absolute: form factors are sums of terms of the order of 0.1, which cancel where light comes in
/// a sliver at the horizon.
constexpr double horizon_rounding = 1e-16;

/// Next to a face's own border, rounding may lift the border over the horizon.
bool is_lit_to_rounding(const DirectLightIndex& index, const SurfacePoint& point, int emitter) {
  const PointFactor factor = index.factor(point, emitter);
  return factor.visible > (1 - 1e-12) * factor.unobstructed - horizon_rounding;
}

void compare(const NamedScene& named, const OpaqueScene& opaque, const Meshed& m, int count,
             LabelTally& tally) {
  const SoundScene& scene = named.scene;
  ASSERT_EQ(m.labels.size(), static_cast<std::size_t>(m.elements.count()) * m.sources.size());
  VisiblePartFinder finder(opaque);
  VisiblePart part;
  test::Random random(8);
  const double allowed = 1.01 * m.mesh.report.deviation + 1e-9 * scene.diagonal;
  const DirectLightIndex index(scene);
  std::vector<double> area_up_to(m.elements.area.size());
  std::partial_sum(m.elements.area.begin(), m.elements.area.end(), area_up_to.begin());
  int wrong = 0;
  for (int i = 0; i < count; ++i) {
    const int element = random_element(m.elements, area_up_to, i, random);
    const auto e = static_cast<std::size_t>(element);
    const int receiver = m.elements.surface[e];
    const Vec3 point = random_point(m.elements, element, random);
    const auto source =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(m.sources.size()) - 1));
    const Vec3& normal = scene.surfaces[static_cast<std::size_t>(receiver)].frame.normal;
    const int emitter = m.sources[source].surface;
    finder.find(point, normal, emitter, part);
    ++tally.points;
    ++tally.by_region[static_cast<std::size_t>(part.region)];
    const Region label = m.labels[e * m.sources.size() + source];
    if (label == part.region) continue;
    const double distance = distance_to_lines(scene, m.found, receiver, point);
    if (distance <= allowed) {
      ++tally.near_a_curve;
    } else if (label != Region::umbra && is_lit_to_rounding(index, {point, normal}, emitter)) {
      ++tally.rounding;
    } else if (++wrong <= 3) {
      ADD_FAILURE() << named.name << ": element " << element << " of receiver " << receiver
                    << ", light " << emitter << ": label " << static_cast<int>(label) << ", point ("
                    << point.transpose() << ") sees " << static_cast<int>(part.region) << ", "
                    << distance << " from any curve, " << allowed
                    << " allowed; hidden is a factor of "
                    << index.factor({point, normal}, emitter).unobstructed -
                           index.factor({point, normal}, emitter).visible;
    }
  }
  EXPECT_EQ(wrong, 0) << named.name << ": of " << count;
}

TEST(DiscontinuityLabels, HoldForWholeElementsOfSoundMeshes) {
  LabelTally tally;
  for (const NamedScene& named : test::discontinuity_scenes()) {
    if (!test::is_wanted(named.name)) continue;
    SCOPED_TRACE(named.name);
    const OpaqueScene opaque(named.scene);
    const Meshed m(named.scene, opaque, {});
    test::expect_sound(m.elements, named.scene);
    EXPECT_EQ(m.mesh.report.unfinished_surfaces, 0u);
    compare(named, opaque, m, 1500 * test::effort(), tally);
    expect_alike(m, named.scene.diagonal);
  }
  RecordProperty("points", tally.points);
  RecordProperty("near_a_curve", tally.near_a_curve);
  if (std::getenv("HALFSHADE_SCENE")) return;
  EXPECT_LT(tally.near_a_curve, tally.points / 1000);
  EXPECT_LE(tally.rounding, tally.points / 10000);
  for (const Region region : {Region::lit, Region::penumbra, Region::umbra})
    EXPECT_GT(tally.by_region[static_cast<std::size_t>(region)], tally.points / 50);
}

/// Chords a ten-millionth of the surface off their conics: what is nearer to a curve than that is
/// hardly met.
TEST(DiscontinuityLabels, HoldCloserToConicsWhereThatIsAsked) {
  const SoundScene scene = test::skew_bars_maker().sound();
  const OpaqueScene opaque(scene);
  DiscontinuityMeshOptions options;
  options.deviation = 1e-7;
  const Meshed m(scene, opaque, options);
  EXPECT_LT(m.mesh.report.deviation, 2 * options.deviation * scene.diagonal);
  LabelTally tally;
  compare({"skew_bars", scene}, opaque, m, 10000 * test::effort(), tally);
  EXPECT_LT(tally.near_a_curve, tally.points / 1000);
}

/// Length of all edges on curves, by order.
std::array<double, 4> line_lengths(const ElementTable& elements, int receiver) {
  std::array<double, 4> twice{};
  for (int e = 0; e < elements.count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (elements.surface[i] != receiver) continue;
    const auto t = elements.triangle(e);
    for (std::size_t k = 0; k < 3; ++k)
      if (const int order = elements.edge_order[i][k]; order >= 0)
        twice[static_cast<std::size_t>(order)] += (t[(k + 1) % 3] - t[k]).norm();
  }
  for (double& length : twice) length /= 2;
  return twice;
}

TEST(DiscontinuityLabels, AreExactForASquareOverASquare) {
  const SoundScene scene = test::s1();
  const OpaqueScene opaque(scene);
  const Meshed m(scene, opaque, {});
  std::array<double, 4> area{};
  for (int e = 0; e < m.elements.count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    if (m.elements.surface[i] != 2) continue;
    area[static_cast<std::size_t>(m.labels[i])] += m.elements.area[i];
    const Region label = m.labels[i];
    const auto t = m.elements.triangle(e);
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3;
    const double place = middle.lpNorm<Eigen::Infinity>();
    EXPECT_EQ(label, place < 0.25   ? Region::umbra
                     : place < 1.25 ? Region::penumbra
                                    : Region::lit)
        << middle.transpose();
  }
  EXPECT_NEAR(area[static_cast<std::size_t>(Region::umbra)], 0.25, 1e-12);
  EXPECT_NEAR(area[static_cast<std::size_t>(Region::penumbra)], 6, 1e-11);
  const auto lengths = line_lengths(m.elements, 2);
  EXPECT_NEAR(lengths[1], 20, 1e-10);
  EXPECT_EQ(lengths[2], 0);
}

/// The lines cut the floor into nine cells within the penumbra and one around it. (Prolonged over
/// the whole floor, where nothing happens, they would make 25.)
TEST(DiscontinuityLabels, ASquareOverASquareMakesTenCells) {
  const SoundScene scene = test::s1();
  const OpaqueScene opaque(scene);
  const Meshed m(scene, opaque, {});
  const auto count = static_cast<std::size_t>(m.elements.count());
  std::vector<int> cell(count, -1);
  int cells = 0;
  for (std::size_t start = 0; start < count; ++start) {
    if (m.elements.surface[start] != 2 || cell[start] >= 0) continue;
    std::vector<std::size_t> stack = {start};
    cell[start] = cells;
    while (!stack.empty()) {
      const std::size_t e = stack.back();
      stack.pop_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const int other = m.elements.neighbours[e][k];
        if (other < 0 || m.elements.edge_order[e][k] >= 0) continue;
        const auto o = static_cast<std::size_t>(other);
        if (cell[o] >= 0) continue;
        cell[o] = cells;
        stack.push_back(o);
      }
    }
    ++cells;
  }
  EXPECT_EQ(cells, 10);
}

TEST(DiscontinuityLabels, MeshesOfDegenerateScenesAreSound) {
  for (const NamedScene& named : test::degenerate_scenes()) {
    if (!test::is_wanted(named.name)) continue;
    SCOPED_TRACE(named.name);
    const OpaqueScene opaque(named.scene);
    const Meshed m(named.scene, opaque, {});
    test::expect_sound(m.elements, named.scene);
    EXPECT_EQ(m.mesh.report.unfinished_surfaces, 0u);
    LabelTally tally;
    compare(named, opaque, m, 300 * test::effort(), tally);
    expect_alike(m, named.scene.diagonal);
  }
}

}  // namespace
}  // namespace halfshade
