#include "meshing/patches/discontinuity_mesh.h"

#include "meshing/core/light_source.h"
#include "meshing/patches/quality.h"
#include "meshing/patches/shared_edges.h"
#include "meshing/repair/repair.h"
#include "tests/support/cornell.h"
#include "tests/support/degenerate_scenes.h"
#include "tests/support/expect_error.h"
#include "tests/support/mesh_invariants.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace halfshade {
namespace {

using test::expect_alike_across_surfaces;
using test::expect_sound;

DiscontinuityCurve straight(int surface, const Vec2& from, const Vec2& to, int order = 2) {
  DiscontinuityCurve curve;
  curve.receiver = surface;
  curve.order = order;
  curve.arc = straight_arc(from, to);
  curve.jump = {1, 1, 1};
  return curve;
}

/// Lines and arcs in a surface that reach over its borders and across each other.
void add_random_curves(const SoundScene& scene, int surface, int count, test::Random& random,
                       Discontinuities& found) {
  Eigen::AlignedBox2d box;
  for (const Vec2& p : scene.surfaces[static_cast<std::size_t>(surface)].rings[0]) box.extend(p);
  const auto point = [&] {
    return Vec2(random(box.min().x(), box.max().x()), random(box.min().y(), box.max().y()));
  };
  for (int k = 0; k < count; ++k) {
    DiscontinuityCurve curve = straight(surface, point(), point(), random.integer(1, 2));
    if (k % 2 == 1) curve.arc = {curve.arc.from, point(), curve.arc.to, random(0.5, 1.5), false};
    found.curves.push_back(curve);
  }
}

Discontinuities random_curves(const SoundScene& scene, int count) {
  test::Random random(3);
  Discontinuities found;
  for (int r = 0; r < static_cast<int>(scene.surfaces.size()); ++r)
    add_random_curves(scene, r, count, random, found);
  return found;
}

/// Each edge counts from both sides.
double length_of_order(const ElementTable& table, int order) {
  double sum = 0;
  for (int e = 0; e < table.count(); ++e)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto t = table.triangle(e);
      if (table.edge_order[static_cast<std::size_t>(e)][k] == order)
        sum += 0.5 * (t[(k + 1) % 3] - t[k]).norm();
    }
  return sum;
}

/// Two walls and a floor of 1 × 1 that meet in a corner, everything 0.25…0.75 from it.
SoundScene corner() {
  test::SceneMaker maker;
  maker.polygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})
      .polygon({{0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}})
      .polygon({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  return maker.sound();
}

Vec2 in_surface(const SoundScene& scene, int surface, const Vec3& p) {
  return scene.surfaces[static_cast<std::size_t>(surface)].frame.to_plane(p);
}

TEST(DiscontinuityMesh, EdgesRunAlongCurvesOverSharedEdges) {
  const SoundScene scene = corner();
  // A band goes from the floor up the wall x = 0; a third line ends in the middle of the floor.
  Discontinuities found;
  for (const double y : {0.3, 0.4})
    for (const int r : {0, 1})
      found.curves.push_back(straight(r, in_surface(scene, r, {0, y, 0}),
                                      in_surface(scene, r, r == 0 ? Vec3(1, y, 0) : Vec3(0, y, 1)),
                                      1));
  found.curves.push_back(
      straight(0, in_surface(scene, 0, {0, 0.7, 0}), in_surface(scene, 0, {0.5, 0.7, 0}), 2));
  for (const double length : {0., 0.2}) {
    const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, {.max_length = length});
    const ElementTable table = mesh.patches.elements();
    expect_sound(table, scene);
    EXPECT_GT(expect_alike_across_surfaces(table, scene), 3);
    EXPECT_NEAR(length_of_order(table, 1), 4, 1e-9);
    EXPECT_NEAR(length_of_order(table, 2), 0.5, 1e-9);
    EXPECT_EQ(mesh.report.kept, 5u);
    EXPECT_EQ(mesh.report.culled, 0u);
    EXPECT_EQ(mesh.report.unfinished_surfaces, 0u);
    EXPECT_LT(mesh.report.deviation, 1e-6);
    EXPECT_GE(mesh.report.boundary_rounds, 1);
    EXPECT_GE(summarize_quality(table).min_angle, 20.7);
    EXPECT_LE(summarize_quality(table).longest_edge, length > 0 ? length * (1 + 1e-9) : 2);
  }
}

TEST(DiscontinuityMesh, CurvesThatMeetAtASharedEdgeButForRoundingMakeOneVertex) {
  const SoundScene scene = corner();
  const double size = scene.diagonal;
  for (const double off : {0., 1e-12, 1e-9, 3e-8}) {
    Discontinuities found;
    found.curves.push_back(
        straight(0, in_surface(scene, 0, {0, 0.5, 0}), in_surface(scene, 0, {1, 0.5, 0})));
    found.curves.push_back(straight(1, in_surface(scene, 1, {0, 0.5 + off * size, 0}),
                                    in_surface(scene, 1, {0, 0.5, 1})));
    const ElementTable table = mesh_discontinuities(scene, found, {}).patches.elements();
    expect_sound(table, scene);
    expect_alike_across_surfaces(table, scene);
    EXPECT_GT(summarize_quality(table).min_angle, 20.6);
    EXPECT_LT(table.count(), 60);
  }
}

TEST(DiscontinuityMesh, RandomCurvesInRoomsMakeSoundMeshes) {
  const std::vector<test::NamedScene> scenes = {{"L-room", make_sound(test::l_room(true))},
                                                {"Cornell", make_sound(test::cornell_box())},
                                                {"closed", test::closed_room()},
                                                {"touching", test::touching_boxes()},
                                                {"window", test::window_in_a_sheet()},
                                                {"far away", test::far_from_the_origin()}};
  for (const auto& [name, scene] : scenes) {
    SCOPED_TRACE(name);
    DiscontinuityMesh mesh = mesh_discontinuities(scene, random_curves(scene, 4), {});
    std::mt19937 random(7);
    for (int round = 0; round < 4; ++round) {
      const ElementTable table = mesh.patches.elements();
      expect_sound(table, scene);
      expect_alike_across_surfaces(table, scene);
      std::vector<int> chosen;
      for (int k = 0; k < 20; ++k)
        chosen.push_back(static_cast<int>(random() % static_cast<unsigned>(table.count())));
      const double curved = length_of_order(table, 1) + length_of_order(table, 2);
      round % 2 == 0 ? mesh.patches.split_in_four(chosen) : mesh.patches.bisect(chosen);
      const ElementTable after = mesh.patches.elements();
      EXPECT_NEAR(length_of_order(after, 1) + length_of_order(after, 2), curved, 1e-9 * curved);
    }
  }
}

TEST(DiscontinuityMesh, SameForAnyNumberOfThreads) {
  const SoundScene scene = test::closed_room();
  const Discontinuities found = random_curves(scene, 5);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    DiscontinuityMesh mesh = mesh_discontinuities(scene, found, {.max_length = 0.5});
    mesh.patches.split_in_four(std::vector<int>{3, 30, 300});
    return mesh.patches.elements();
  };
  const ElementTable one = run(1), two = run(2);
  EXPECT_EQ(one.points, two.points);
  EXPECT_EQ(one.corners, two.corners);
  EXPECT_EQ(one.neighbours, two.neighbours);
  EXPECT_EQ(one.edge_order, two.edge_order);
}

TEST(DiscontinuityMesh, DegenerateScenesWithTheirOwnCurvesAreSound) {
  for (const auto& [name, scene] : test::degenerate_scenes()) {
    SCOPED_TRACE(name);
    const OpaqueScene opaque(scene);
    const Discontinuities found = find_discontinuities(scene, opaque, light_sources(scene));
    const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, {});
    const ElementTable table = mesh.patches.elements();
    expect_sound(table, scene);
    expect_alike_across_surfaces(table, scene);
    EXPECT_EQ(mesh.report.kept, found.curves.size());
  }
}

TEST(DiscontinuityMesh, ToleranceLeavesCurvesOut) {
  const SoundScene scene = corner();
  Discontinuities found;
  for (const double jump : {1., 1e-6}) {
    found.curves.push_back(straight(0, in_surface(scene, 0, {0, 0.5 * jump, 0}),
                                    in_surface(scene, 0, {1, 0.5, 0}), 1));
    found.curves.back().jump = {0, jump, 0};
  }
  const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, {.irradiance_tolerance = 1e-4});
  EXPECT_EQ(mesh.report.kept, 1u);
  EXPECT_EQ(mesh.report.culled, 1u);
  const ElementTable table = mesh.patches.elements();
  EXPECT_NEAR(length_of_order(table, 1), 1, 1e-9);
}

TEST(DiscontinuityMesh, StoppedEarlyStaysCoarseButWhole) {
  const SoundScene scene = corner();
  std::stop_source stop;
  stop.request_stop();
  const DiscontinuityMesh mesh = mesh_discontinuities(scene, random_curves(scene, 3), {},
                                                      {.stop = stop.get_token(), .report = {}});
  EXPECT_EQ(mesh.report.unfinished_surfaces, scene.surfaces.size());
  expect_sound(mesh.patches.elements(), scene);
}

TEST(DiscontinuityMesh, RefusesWhatMakesNoSense) {
  const SoundScene scene = corner();
  Discontinuities found;
  found.curves.push_back(straight(7, {0, 0}, {1, 0}));
  test::expect_error([&] { mesh_discontinuities(scene, found, {}); }, ErrorCode::contract,
                     {"surface 7 of 3"});
  test::expect_error([&] { mesh_discontinuities(scene, {}, {.max_length = -1}); },
                     ErrorCode::contract, {"-1"});
  test::expect_error([&] { mesh_discontinuities(scene, {}, {.irradiance_tolerance = NAN}); },
                     ErrorCode::contract, {"nan"});
  test::expect_error(
      [&] { mesh_discontinuities(scene, {}, {.max_length = 1e-3, .max_triangles = 1000}); },
      ErrorCode::too_large, {"1000"});
}

TEST(PatchMeshOfCurveMeshes, RefusesMeshesAndCurvesThatDoNotFit) {
  const SoundScene scene = corner();
  std::vector<CurveMesh> meshes;
  for (const Surface& surface : scene.surfaces)
    meshes.push_back(mesh_with_curves(surface.rings, surface.contacts, {}, {}));
  EXPECT_EQ(PatchMesh(scene, SharedEdges(scene), meshes, {}).element_count() > 0, true);
  const std::vector<CurvePolyline> lines = {{{{-0.2, -0.1}, {0.3, 0.2}}, 5}};
  meshes[1] = mesh_with_curves(scene.surfaces[1].rings, {}, lines, {});
  test::expect_error(
      [&] {
        PatchMesh(scene, SharedEdges(scene), meshes, std::vector<int>{1, 2});
      },
      ErrorCode::contract, {"curve 5"});
  meshes.pop_back();
  test::expect_error([&] { PatchMesh(scene, SharedEdges(scene), meshes, {}); }, ErrorCode::contract,
                     {"2 meshes", "3 surfaces"});
}

// Where only one side has points, the other gets them.
TEST(PatchMeshOfCurveMeshes, MissingVerticesAreFilledIn) {
  for (const SoundScene& scene : {corner(), test::touching_boxes(), test::closed_room()}) {
    std::vector<CurveMesh> meshes;
    for (const Surface& surface : scene.surfaces) {
      CurveMeshOptions options;
      options.quality.max_length = 0.17 + 0.13 * static_cast<double>(meshes.size() % 5);
      meshes.push_back(mesh_with_curves(surface.rings, surface.contacts, {}, options));
    }
    PatchMesh mesh(scene, SharedEdges(scene), meshes, {});
    expect_sound(mesh.elements(), scene);
    EXPECT_GT(expect_alike_across_surfaces(mesh.elements(), scene), 0);
    const PatchHierarchy forest = mesh.hierarchy();
    EXPECT_EQ(static_cast<int>(forest.parent.size()), mesh.element_count());
    mesh.split_in_four(std::vector<int>{0, 5, 9, 14});
    expect_sound(mesh.elements(), scene);
    expect_alike_across_surfaces(mesh.elements(), scene);
  }
}

// S1: the umbra is |x|, |y| ≤ 0.25, the penumbra ends at 1.25.
TEST(LabelElements, AreasOfUmbraAndPenumbraAreExact) {
  const SoundScene scene = test::s1();
  const OpaqueScene opaque(scene);
  const std::vector<LightSource> sources = light_sources(scene);
  const Discontinuities found = find_discontinuities(scene, opaque, sources);
  const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, {});
  const ElementTable table = mesh.patches.elements();
  const std::vector<Region> regions = label_elements(scene, opaque, table, sources);
  ASSERT_EQ(sources.size(), 1u);
  ASSERT_EQ(regions.size(), table.corners.size());
  std::array<double, 4> area{};
  for (int e = 0; e < table.count(); ++e)
    if (table.surface[static_cast<std::size_t>(e)] == 2)
      area[static_cast<std::size_t>(regions[static_cast<std::size_t>(e)])] +=
          table.area[static_cast<std::size_t>(e)];
    else
      EXPECT_EQ(regions[static_cast<std::size_t>(e)],
                table.surface[static_cast<std::size_t>(e)] == 0 ? Region::away : Region::lit);
  const double side = 1.8613 + 1.9371;
  EXPECT_NEAR(area[static_cast<std::size_t>(Region::umbra)], 0.25, 1e-7);
  EXPECT_NEAR(area[static_cast<std::size_t>(Region::penumbra)], 6, 1e-6);
  EXPECT_NEAR(area[static_cast<std::size_t>(Region::lit)], side * side - 6.25, 1e-6);
}

TEST(LabelElements, HoldForWholeElements) {
  for (const SoundScene& scene :
       {test::s1(), test::skew_bars_maker().sound(), test::light_with_a_hole()}) {
    const OpaqueScene opaque(scene);
    const std::vector<LightSource> sources = light_sources(scene);
    const Discontinuities found = find_discontinuities(scene, opaque, sources);
    const DiscontinuityMesh mesh = mesh_discontinuities(scene, found, {});
    const ElementTable table = mesh.patches.elements();
    const std::vector<Region> regions = label_elements(scene, opaque, table, sources);
    VisiblePartFinder finder(opaque);
    VisiblePart part;
    test::Random random(17);
    const double near = mesh.report.deviation + 1e-6;
    int checked = 0;
    for (int i = 0; i < 4000; ++i) {
      const int e = random.integer(0, table.count() - 1);
      const auto [a, b, c] = table.triangle(e);
      const double u = random(0, 1), v = random(0, 1 - u);
      // Heights over the sides: what lies at the border of an element may be on a curve's other
      // side.
      const double twice = 2 * table.area[static_cast<std::size_t>(e)];
      if (std::min({u * twice / (c - a).norm(), v * twice / (b - a).norm(),
                    (1 - u - v) * twice / (c - b).norm()}) < near)
        continue;
      ++checked;
      for (std::size_t s = 0; s < sources.size(); ++s) {
        finder.find(a + u * (b - a) + v * (c - a), table.normal[static_cast<std::size_t>(e)],
                    sources[s].surface, part);
        const Region label = regions[static_cast<std::size_t>(e) * sources.size() + s];
        EXPECT_EQ(static_cast<int>(part.region), static_cast<int>(label))
            << "element " << e << " of surface " << table.surface[static_cast<std::size_t>(e)]
            << " at " << (a + u * (b - a) + v * (c - a)).transpose();
      }
    }
    EXPECT_GT(checked, 1000);
  }
}

TEST(LabelElements, RefusesUnknownSources) {
  const SoundScene scene = corner();
  const std::vector<LightSource> none = {{8, 1}};
  test::expect_error(
      [&] { label_elements(scene, OpaqueScene(scene), PatchMesh(scene, {}).elements(), none); },
      ErrorCode::contract, {"8", "3"});
}

}  // namespace
}  // namespace halfshade
