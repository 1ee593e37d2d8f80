#include "meshing/backprojection/opaque_scene.h"
#include "meshing/core/light_source.h"
#include "meshing/discontinuity/discontinuity.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "meshing/patches/patch_mesh.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair.h"
#include "tests/support/cornell.h"
#include "tests/support/degenerate_scenes.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/expect_error.h"
#include "tests/support/mesh_invariants.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

namespace halfshade {
namespace {

PatchMesh mesh_along_curves(const SoundScene& scene) {
  const OpaqueScene opaque(scene);
  const Discontinuities curves = find_discontinuities(scene, opaque, light_sources(scene));
  DiscontinuityMeshOptions options;
  options.min_angle = 10;
  return mesh_discontinuities(scene, curves, options).patches;
}

std::vector<int> all_of(const PatchMesh& mesh) {
  std::vector<int> all(at(mesh.element_count()));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Length of the edges of each order, as often as elements have them.
std::map<int, double> length_by_order(const ElementTable& table) {
  std::map<int, double> lengths;
  for (int e = 0; e < table.count(); ++e)
    for (std::size_t k = 0; k < 3; ++k)
      if (const int order = table.edge_order[at(e)][k]; order >= 0) {
        const auto t = table.triangle(e);
        lengths[order] += (t[(k + 1) % 3] - t[k]).norm();
      }
  return lengths;
}

using Corners = std::array<std::array<double, 3>, 3>;

/// What there is to an element but for its number: places of corners, and its labels.
struct Looks {
  Corners corners;
  std::array<int, 3> edge_order;
  int surface, face, group, material, level;
  bool operator==(const Looks&) const = default;
  auto operator<=>(const Looks&) const = default;
};

std::vector<Looks> looks_of(const ElementTable& table) {
  std::vector<Looks> looks;
  for (int e = 0; e < table.count(); ++e) {
    const auto t = table.triangle(e);
    Looks one{{},
              table.edge_order[at(e)],
              table.surface[at(e)],
              table.face[at(e)],
              table.group[at(e)],
              table.material[at(e)],
              table.level[at(e)]};
    std::size_t first = 0;
    for (std::size_t k = 0; k < 3; ++k) one.corners[k] = {t[k].x(), t[k].y(), t[k].z()};
    for (std::size_t k = 1; k < 3; ++k)
      if (one.corners[k] < one.corners[first]) first = k;
    std::rotate(one.corners.begin(), one.corners.begin() + static_cast<long>(first),
                one.corners.end());
    std::rotate(one.edge_order.begin(), one.edge_order.begin() + static_cast<long>(first),
                one.edge_order.end());
    looks.push_back(one);
  }
  std::sort(looks.begin(), looks.end());
  return looks;
}

/// Parents before children, two to four of them; leaves are the elements; parts make up the whole.
void expect_sound_forest(const PatchMesh& mesh, double area) {
  const PatchHierarchy forest = mesh.hierarchy();
  const ElementTable table = mesh.elements();
  std::vector<int> parts(forest.parent.size(), 0), seen(at(table.count()), 0);
  for (std::size_t n = 0; n < forest.parent.size(); ++n) {
    const int whole = forest.parent[n];
    ASSERT_LT(whole, static_cast<int>(n));
    ASSERT_EQ(forest.level[n], whole < 0 ? 0 : forest.level[at(whole)] + 1);
    if (whole >= 0) ++parts[at(whole)];
  }
  for (std::size_t n = 0; n < parts.size(); ++n) {
    ASSERT_EQ(parts[n] == 0, forest.element[n] >= 0);
    ASSERT_TRUE(parts[n] == 0 || (parts[n] >= 2 && parts[n] <= 4)) << parts[n];
    if (forest.element[n] >= 0) ++seen[at(forest.element[n])];
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
  EXPECT_NEAR(std::accumulate(table.area.begin(), table.area.end(), 0.), area, 1e-12 * area);
}

void split_some(PatchMesh& mesh, test::Random& random, int most) {
  std::vector<int> some;
  for (int k = random.integer(1, most); k > 0; --k)
    some.push_back(random.below(mesh.element_count()));
  random.below(2) == 0 ? mesh.bisect(some) : mesh.split_in_four(some);
}

/// Those of some share of the wholes, so that neighbours mostly agree.
void merge_some(PatchMesh& mesh, test::Random& random) {
  const ElementTable table = mesh.elements();
  const Vec3 centre = table.points[at(random.below(static_cast<int>(table.points.size())))];
  const double radius = random(0.1, 0.6) * (table.points.front() - table.points.back()).norm();
  std::vector<int> some;
  for (int e = 0; e < table.count(); ++e) {
    const auto t = table.triangle(e);
    if (((t[0] + t[1] + t[2]) / 3 - centre).norm() < radius || random.below(10) < 7)
      some.push_back(e);
  }
  mesh.merge(some);
}

struct Place {
  const char* name;
  SoundScene (*scene)();
  PatchMesh (*mesh)(const SoundScene&);
};

class MergeElements : public testing::TestWithParam<Place> {};

TEST_P(MergeElements, TwentyRoundsOfSplittingAndMergingKeepAllInvariants) {
  const SoundScene scene = GetParam().scene();
  PatchMesh mesh = GetParam().mesh(scene);
  const ElementTable start = mesh.elements();
  const double area = std::accumulate(start.area.begin(), start.area.end(), 0.);
  const double angle = summarize_quality(start).min_angle;
  const auto lengths = length_by_order(start);
  test::Random random(5);
  int merged = 0;
  for (int round = 0; round < 20; ++round) {
    for (int k = round % 3; k >= 0; --k) split_some(mesh, random, 1 + start.count() / 8);
    const int before = mesh.element_count();
    merge_some(mesh, random);
    merged += before - mesh.element_count();
    const ElementTable table = mesh.elements();
    test::expect_sound(table, scene);
    test::expect_alike_across_surfaces(table, scene);
    expect_sound_forest(mesh, area);
    // Longest-edge bisection at worst halves the smallest angle (Rosenberg and Stenger 1975).
    EXPECT_GE(summarize_quality(table).min_angle, angle / 2 - 1e-9);
    const auto now = length_by_order(table);
    ASSERT_EQ(now.size(), lengths.size());
    for (const auto& [order, length] : lengths)
      EXPECT_NEAR(now.at(order), length, 1e-9 * length) << "curves of order " << order;
    if (testing::Test::HasFailure()) FAIL() << "round " << round;
  }
  EXPECT_GT(merged, 100);
  EXPECT_GT(mesh.element_count(), start.count());
  // All that was split can be undone, to the last bit.
  for (int before = 0; before != mesh.element_count();) {
    before = mesh.element_count();
    mesh.merge(all_of(mesh));
  }
  EXPECT_EQ(looks_of(mesh.elements()), looks_of(start));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, MergeElements,
    testing::Values(
        Place{"cornell_box", [] { return make_sound(test::cornell_box()); },
              [](const SoundScene& scene) { return PatchMesh(scene, {.max_length = 200}); }},
        Place{"s1", test::s1, mesh_along_curves},
        Place{"skew_bars", [] { return test::skew_bars_maker().sound(); }, mesh_along_curves},
        Place{"touching_boxes", test::touching_boxes, mesh_along_curves}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(MergeElementsOfPatches, NodesAreToldWhereTheyAre) {
  const SoundScene scene = make_sound(test::l_room(false));
  PatchMesh mesh(scene, {.max_length = 0.4});
  test::Random random(2);
  for (int round = 0; round < 5; ++round) split_some(mesh, random, 30);
  const PatchHierarchy before = mesh.hierarchy();
  const ElementTable old = mesh.elements();
  const std::vector<int> now = mesh.merge(all_of(mesh));
  const PatchHierarchy after = mesh.hierarchy();
  const ElementTable table = mesh.elements();
  ASSERT_EQ(now.size(), before.parent.size());
  std::size_t kept = 0;
  for (std::size_t n = 0; n < now.size(); ++n) {
    if (now[n] < 0) {
      EXPECT_GE(before.element[n], 0) << "only elements go";
      continue;
    }
    EXPECT_EQ(now[n], static_cast<int>(kept++)) << "the others keep their order";
    const int whole = before.parent[n];
    EXPECT_EQ(after.parent[at(now[n])], whole < 0 ? -1 : now[at(whole)]);
    if (before.element[n] >= 0) {
      EXPECT_EQ(old.triangle(before.element[n]), table.triangle(after.element[at(now[n])]));
    }
  }
  EXPECT_EQ(kept, after.parent.size());
  EXPECT_LT(mesh.element_count(), old.count());
}

TEST(MergeElementsOfPatches, NothingIsMergedThatIsNotNamedAsAWhole) {
  const SoundScene scene = make_sound(test::l_room(false));
  PatchMesh mesh(scene, {.max_length = 0.4});
  mesh.split_in_four(std::vector<int>{7});
  const auto before = looks_of(mesh.elements());
  const PatchHierarchy forest = mesh.hierarchy();
  std::vector<int> all_but_one = all_of(mesh);
  all_but_one.erase(std::find(all_but_one.begin(), all_but_one.end(), forest.element.back()));
  mesh.merge(std::vector<int>{});
  EXPECT_EQ(looks_of(mesh.elements()), before);
  // One split in four took others with it.
  const int without = forest.parent.back();
  mesh.merge(all_but_one);
  EXPECT_EQ(mesh.hierarchy().element[at(without)], -1);
  test::expect_sound(mesh.elements(), scene);
  for (const int e : {-1, mesh.element_count()})
    test::expect_error([&] { mesh.merge(std::vector<int>{e}); }, ErrorCode::contract, {"element"});
}

}  // namespace
}  // namespace halfshade
