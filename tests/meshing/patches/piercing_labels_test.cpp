#include "meshing/core/light_source.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "tests/support/clipped_view.h"
#include "tests/support/effort.h"
#include "tests/support/scene_maker.h"
#include "tests/support/signature_bisection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

// Labels of meshes of polygons that cut through each other, through the floor and through the
// light, held against visibility by clipping.

namespace halfshade {
namespace {

/// A polygon in the plane and convex ones that it is made of.
struct Outline2 {
  std::vector<Vec2> corners;
  std::vector<std::vector<std::size_t>> parts;
};

Outline2 random_outline(test::Random& random) {
  const std::array<Outline2, 4> outlines = {{
      {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, {{0, 1, 2, 3}}},
      {{{-1, -0.6}, {1, -1}, {0.2, 1}}, {{0, 1, 2}}},
      {{{-1, -1}, {0, -0.2}, {1, -1}, {0.1, 1}}, {{0, 1, 3}, {1, 2, 3}}},
      {{{-1, -1}, {1, -1}, {1, -0.2}, {-0.2, -0.3}, {-0.3, 1}, {-1, 1}},
       {{0, 1, 2, 3}, {0, 3, 4, 5}}},
  }};
  Outline2 outline = outlines[at(random.below(4))];
  const Vec2 size(random(0.2, 0.7), random(0.2, 0.7));
  for (Vec2& p : outline.corners) p = p.cwiseProduct(size);
  return outline;
}

struct Piercing {
  test::SceneMaker maker;
  std::vector<int> thing_of_face;
  std::vector<test::ClippedPiece> pieces;  ///< the light, the floor and the others

  void add_face(const std::vector<Vec3>& corners, int material, int thing) {
    maker.polygon(corners, material);
    thing_of_face.push_back(thing);
  }
};

enum class Sides { one, two_faces, two_sided };

/// Around a place.
void add_sheet(Piercing& out, test::Random& random, const Vec3& centre, Sides sides, int thing) {
  const PlaneFrame plane = make_frame(centre, random.direction());
  const Outline2 outline = random_outline(random);
  std::vector<Vec3> corners;
  for (const Vec2& p : outline.corners) corners.push_back(plane.to_space(p));
  for (const auto& part : outline.parts) {
    test::ClippedPiece& piece = out.pieces.emplace_back();
    piece.thing = thing;
    for (const std::size_t k : part) piece.corners.push_back(corners[k]);
  }
  out.add_face(corners, sides == Sides::two_sided ? test::two_sided_grey : test::grey, thing);
  if (sides == Sides::two_faces)
    out.add_face({corners.rbegin(), corners.rend()}, test::grey, thing);
}

/// So close together that nearly all cut others, the third through the light and the fourth
/// through the floor.
Piercing piercing_sheets(std::uint64_t seed, Sides sides) {
  test::Random random(seed);
  Piercing out;
  out.maker.square_light().floor();
  out.thing_of_face = {0, 1};
  for (const int f : {0, 1}) out.pieces.push_back({face_corners(out.maker.scene, f), f});
  for (const double z : {1.1, 1.3, 1.9, 0.2})
    add_sheet(out, random, random.in_box({-0.4, -0.4, z - 0.15}, {0.4, 0.4, z + 0.15}), sides,
              static_cast<int>(out.pieces.back().thing) + 1);
  return out;
}

/// How far from all curves that are drawn as they are, and from those that are flattened.
struct CurveDistances {
  double straight = HUGE_VAL, bent = HUGE_VAL;
};

CurveDistances distances(const SoundScene& scene, const Discontinuities& found, int surface,
                         const Vec3& point) {
  const Surface& receiver = scene.surfaces[at(surface)];
  const Vec2 p = receiver.frame.to_plane(point);
  CurveDistances least;
  least.straight = test::distance_to_border_lines(receiver, p);
  for (const DiscontinuityCurve& curve : found.curves) {
    if (curve.receiver != surface) continue;
    double& of_kind = curve.arc.is_straight ? least.straight : least.bent;
    of_kind = std::min(of_kind, distance(curve.arc, p));
  }
  return least;
}

struct RegionTally {
  std::array<int, 4> of{};
  int near_a_curve = 0, slits = 0;
};

void check_labels(const Piercing& piercing, int count, RegionTally& tally) {
  const SoundScene scene = piercing.maker.sound();
  const OpaqueScene opaque(scene);
  const std::vector<LightSource> sources = light_sources(scene);
  ASSERT_EQ(sources.size(), 1u);
  const Discontinuities found = find_discontinuities(scene, opaque, sources);
  const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, {});
  const ElementTable table = mesh.patches.elements();
  const std::vector<Region> labels = label_cells(scene, opaque, table, sources);
  std::vector<double> area_up_to(table.area.size());
  std::partial_sum(table.area.begin(), table.area.end(), area_up_to.begin());
  test::Random random(5);
  int wrong = 0;
  for (int i = 0; i < count; ++i) {
    // Every second time any element alike, so that small ones are met.
    const auto by_area = std::lower_bound(area_up_to.begin(), area_up_to.end() - 1,
                                          random(0, 1) * area_up_to.back());
    const int e = i % 2 == 0 ? random.integer(0, table.count() - 1)
                             : static_cast<int>(by_area - area_up_to.begin());
    const auto [a, b, c] = table.triangle(e);
    const double u = std::sqrt(random(0, 1)), v = random(0, 1);
    const Vec3 point = a + u * (1 - v) * (b - a) + u * v * (c - a);
    const int surface = table.surface[at(e)];
    const int thing = piercing.thing_of_face[at(scene.surfaces[at(surface)].faces[0])];
    const test::ClippedView view =
        test::clipped_view(piercing.pieces, piercing.pieces[0], point, table.normal[at(e)], thing);
    const Region label = labels[at(e)];
    // A share this small is rounding, or that of a place just beside an umbra.
    const bool is_slit = view.region == Region::penumbra && view.share < 1e-9;
    const Region seen = is_slit ? Region::umbra : view.region;
    ++tally.of[static_cast<std::size_t>(seen)];
    if (label == seen) continue;
    const CurveDistances far = distances(scene, found, surface, point);
    if (far.straight <= 1e-9 * scene.diagonal || far.bent <= 1.01 * mesh.report.deviation) {
      ++tally.near_a_curve;
    } else if (is_slit && label == Region::penumbra && std::min(far.straight, far.bent) < 0.01) {
      ++tally.slits;
    } else if (++wrong <= 3) {
      ADD_FAILURE() << "element " << e << " of surface " << surface << ": label "
                    << static_cast<int>(label) << ", but (" << point.transpose() << ") sees "
                    << static_cast<int>(seen) << ", a share of " << view.share << "; "
                    << far.straight << " and " << far.bent << " from curves";
    }
  }
  EXPECT_EQ(wrong, 0) << "of " << count;
}

TEST(PiercingLabels, HoldWhereSheetsCutEachOtherTheFloorAndTheLight) {
  RegionTally tally;
  int points = 0;
  for (const auto& [sides, name] : {std::pair{Sides::one, "one-sided"},
                                    {Sides::two_faces, "back to back"},
                                    {Sides::two_sided, "two-sided"}})
    for (int seed = 1; seed <= 6 * test::effort(); ++seed) {
      SCOPED_TRACE(std::string(name) + ", seed " + std::to_string(seed));
      check_labels(piercing_sheets(static_cast<std::uint64_t>(seed), sides), 1500, tally);
      points += 1500;
    }
  RecordProperty("near_a_curve", tally.near_a_curve);
  EXPECT_LT(tally.near_a_curve, points / 500);
  RecordProperty("slits", tally.slits);
  EXPECT_LT(tally.slits, points / 500);
  for (const Region region : {Region::lit, Region::penumbra, Region::umbra})
    EXPECT_GT(tally.of[static_cast<std::size_t>(region)], points / 200);
}

}  // namespace
}  // namespace halfshade
