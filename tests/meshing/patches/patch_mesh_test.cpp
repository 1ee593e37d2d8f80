#include "meshing/patches/patch_mesh.h"

#include "meshing/core/error.h"
#include "meshing/patches/quality.h"
#include "meshing/repair/repair.h"
#include "tests/support/cornell.h"
#include "tests/support/expect_error.h"
#include "tests/support/mesh_invariants.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace halfshade {
namespace {

using test::expect_sound;

Vec3 centroid(const ElementTable& table, int e) {
  const auto t = table.triangle(e);
  return (t[0] + t[1] + t[2]) / 3;
}

void expect_equal(const ElementTable& a, const ElementTable& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.corners, b.corners);
  EXPECT_EQ(a.neighbours, b.neighbours);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.face, b.face);
  EXPECT_EQ(a.level, b.level);
}

// The forest: parents before children, leaves are the elements, parts make up the whole.
void expect_sound(const PatchHierarchy& forest, int elements) {
  std::vector<int> children(forest.parent.size(), 0), seen(static_cast<std::size_t>(elements), 0);
  for (std::size_t n = 0; n < forest.parent.size(); ++n) {
    const int parent = forest.parent[n];
    EXPECT_LT(parent, static_cast<int>(n));
    if (parent < 0) {
      EXPECT_EQ(forest.level[n], 0);
      continue;
    }
    EXPECT_EQ(forest.level[n], forest.level[static_cast<std::size_t>(parent)] + 1);
    ++children[static_cast<std::size_t>(parent)];
  }
  for (std::size_t n = 0; n < forest.parent.size(); ++n) {
    EXPECT_EQ(children[n] == 0, forest.element[n] >= 0);
    if (children[n] != 0) {
      EXPECT_GE(children[n], 2);
      EXPECT_LE(children[n], 4);
    }
    if (forest.element[n] >= 0) ++seen[static_cast<std::size_t>(forest.element[n])];
  }
  for (const int times : seen) EXPECT_EQ(times, 1);
}

TEST(PatchMesh, CornellBoxIsSoundWithGoodAngles) {
  const SoundScene scene = make_sound(test::cornell_box());
  const PatchMesh mesh(scene, {.max_length = length_for_count(scene, 3000)});
  const ElementTable table = mesh.elements();
  EXPECT_EQ(mesh.element_count(), table.count());
  expect_sound(table, scene);
  const QualitySummary quality = summarize_quality(table);
  EXPECT_GE(quality.min_angle, 20.7);
  EXPECT_LE(quality.longest_edge, length_for_count(scene, 3000));
  expect_sound(mesh.hierarchy(), table.count());
}

TEST(PatchMesh, CountComesOutAsAskedFor) {
  std::array<std::pair<double, double>, 6> grey;
  grey.fill({0.5, 0});
  for (const Scene& input : {test::room({3, 4, 2.5}, grey), test::cornell_box()}) {
    const SoundScene scene = make_sound(input);
    for (const int asked : {500, 2000, 20000}) {
      const PatchMesh mesh(scene, {.max_length = length_for_count(scene, asked)});
      EXPECT_NEAR(mesh.element_count() / static_cast<double>(asked), 1, 0.3);
    }
  }
}

TEST(PatchMesh, LabelsComeFromSurfacesAndFaces) {
  Scene input;
  test::add_material(input, 0.5, 1);
  test::add_polygon(input, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 0);
  test::add_polygon(input, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}, 0);
  input.groups.emplace_back("second");
  test::add_polygon(input, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                    test::add_material(input, 0.1, 0));
  input.faces[2].group = 1;
  const SoundScene scene = make_sound(input);
  const ElementTable table = PatchMesh(scene, {.max_length = 0.1}).elements();
  for (int e = 0; e < table.count(); ++e) {
    const auto i = static_cast<std::size_t>(e);
    const Vec3 c = centroid(table, e);
    const int face = c.z() > 0.5 ? 2 : c.x() < 1 ? 0 : 1;
    EXPECT_EQ(table.face[i], face);
    EXPECT_EQ(table.surface[i], face == 2 ? 1 : 0);
    EXPECT_EQ(table.material[i], face == 2 ? 1 : 0);
    EXPECT_EQ(table.group[i], face == 2 ? 1 : 0);
    EXPECT_EQ(table.level[i], 0);
  }
  EXPECT_TRUE(std::is_sorted(table.surface.begin(), table.surface.end()));
}

TEST(PatchMesh, PointsSplitAcrossContactLinesButNotAtTheirEnds) {
  Scene input;
  test::add_material(input, 0.5, 1);
  test::add_polygon(input, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}}, 0);
  test::add_polygon(input, {{1, 2, 0}, {3, 2, 0}, {3, 2, 1}, {1, 2, 1}}, 0);
  const SoundScene scene = make_sound(input);
  const ElementTable table = PatchMesh(scene, {.max_length = 0.5}).elements();
  std::map<std::pair<double, double>, std::set<int>> ids;  // of the floor's points, by place
  for (int e = 0; e < table.count(); ++e)
    if (table.surface[static_cast<std::size_t>(e)] == 0)
      for (const int p : table.corners[static_cast<std::size_t>(e)]) {
        const Vec3& x = table.points[static_cast<std::size_t>(p)];
        ids[{x.x(), x.y()}].insert(p);
      }
  int split = 0;
  for (const auto& [place, points] : ids) {
    const auto [x, y] = place;
    const bool on_line = std::abs(y - 2) < 1e-9 && x > 1 + 1e-9 && x < 3 - 1e-9;
    EXPECT_EQ(points.size(), on_line ? 2u : 1u) << x << " " << y;
    split += on_line ? 1 : 0;
  }
  EXPECT_GE(split, 3);  // edges are at most 0.5 long
}

TEST(PatchMesh, SplitInFourOfAllKeepsShapes) {
  const SoundScene scene = make_sound(test::l_room(false));
  PatchMesh mesh(scene, {.max_length = 0.5});
  const ElementTable before = mesh.elements();
  std::vector<int> all(static_cast<std::size_t>(before.count()));
  for (int e = 0; e < before.count(); ++e) all[static_cast<std::size_t>(e)] = e;
  mesh.split_in_four(all);
  const ElementTable after = mesh.elements();
  EXPECT_EQ(after.count(), 4 * before.count());
  expect_sound(after, scene);
  EXPECT_NEAR(summarize_quality(after).min_angle, summarize_quality(before).min_angle, 1e-9);
  EXPECT_NEAR(summarize_quality(after).longest_edge, summarize_quality(before).longest_edge / 2,
              1e-12);
}

TEST(PatchMesh, OneSplitMakesFourAndClosesAround) {
  const SoundScene scene = make_sound(test::l_room(false));
  PatchMesh mesh(scene, {.max_length = 0.4});
  const int before = mesh.element_count();
  const std::vector<int> one = {before / 2};
  mesh.split_in_four(one);
  const PatchHierarchy forest = mesh.hierarchy();
  expect_sound(forest, mesh.element_count());
  EXPECT_EQ(std::count(forest.parent.begin(), forest.parent.end(), before / 2), 4);
  EXPECT_GE(mesh.element_count(), before + 3);
  EXPECT_LE(mesh.element_count(), before + 60);
  expect_sound(mesh.elements(), scene);
}

TEST(PatchMesh, BisectHalvesTheNamedElement) {
  const SoundScene scene = make_sound(test::l_room(false));
  PatchMesh mesh(scene, {.max_length = 0.4});
  const int e = mesh.element_count() / 3;
  const ElementTable before = mesh.elements();
  mesh.bisect(std::vector<int>{e});
  const PatchHierarchy forest = mesh.hierarchy();
  const ElementTable after = mesh.elements();
  double parts = 0;
  for (std::size_t n = 0; n < forest.parent.size(); ++n)
    if (forest.parent[n] == e) parts += after.area[static_cast<std::size_t>(forest.element[n])];
  EXPECT_NEAR(parts, before.area[static_cast<std::size_t>(e)], 1e-14);
  expect_sound(after, scene);
}

TEST(PatchMesh, RandomSplitsStayConforming) {
  const SoundScene scene = make_sound(test::cornell_box());
  PatchMesh mesh(scene, {.max_length = 150});
  std::mt19937 random(11);
  for (int round = 0; round < 8; ++round) {
    std::vector<int> chosen;
    for (int k = 0; k < 30; ++k)
      chosen.push_back(static_cast<int>(random() % static_cast<unsigned>(mesh.element_count())));
    round % 2 == 0 ? mesh.split_in_four(chosen) : mesh.bisect(chosen);
    expect_sound(mesh.elements(), scene);
    expect_sound(mesh.hierarchy(), mesh.element_count());
  }
}

TEST(PatchMesh, AnglesStayBoundedTowardsAPoint) {
  const SoundScene scene = make_sound(test::l_room(false));
  for (const bool bisect : {false, true}) {
    PatchMesh mesh(scene, {.max_length = 0.5});
    const double start = summarize_quality(mesh.elements()).min_angle;
    double size = 0.4;
    for (int round = 0; round < 10; ++round, size *= bisect ? 0.7 : 0.5) {
      const ElementTable table = mesh.elements();
      std::vector<int> near;
      for (int e = 0; e < table.count(); ++e)
        if ((centroid(table, e) - Vec3(1, 1, 0)).norm() < size) near.push_back(e);
      ASSERT_FALSE(near.empty());
      bisect ? mesh.bisect(near) : mesh.split_in_four(near);
    }
    const ElementTable table = mesh.elements();
    expect_sound(table, scene);
    // Longest-edge bisection at worst halves the smallest angle (Rosenberg and Stenger 1975).
    EXPECT_GE(summarize_quality(table).min_angle, start / 2 - 1e-9);
  }
}

TEST(PatchMesh, SameForAnyNumberOfThreads) {
  const SoundScene scene = make_sound(test::cornell_box());
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    PatchMesh mesh(scene, {.max_length = 40});
    mesh.split_in_four(std::vector<int>{5, 100, 900});
    mesh.bisect(std::vector<int>{1, 17, 333});
    return mesh.elements();
  };
  const ElementTable one = run(1);
  for (const std::size_t threads : {2u, 5u}) expect_equal(one, run(threads));
}

TEST(PatchMesh, FoldsOfAPinchedSurfaceAreMeshed) {
  Scene input;
  test::add_material(input, 0.5, 1);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if ((i != 1 || j != 1) && (i != 0 || j != 0))
        test::add_polygon(input,
                          {{1.0 * i, 1.0 * j, 0},
                           {1.0 + i, 1.0 * j, 0},
                           {1.0 + i, 1.0 + j, 0},
                           {1.0 * i, 1.0 + j, 0}},
                          0);
  const SoundScene scene = make_sound(input);
  ASSERT_EQ(scene.surfaces.size(), 1u);
  PatchMesh mesh(scene, {.max_length = 0.3});
  expect_sound(mesh.elements(), scene);
  mesh.split_in_four(std::vector<int>{0, 1, 2});
  expect_sound(mesh.elements(), scene);
}

TEST(PatchMesh, TooManyElementsAreRefused) {
  const SoundScene scene = make_sound(test::l_room(false));
  // Refused by area before meshing, and by counting after it.
  for (const double length : {1e-4, 0.05})
    test::expect_error([&] { PatchMesh(scene, {.max_length = length, .max_triangles = 8000}); },
                       ErrorCode::too_large, {"8000"});
}

TEST(PatchMesh, StoppedEarlyStaysCoarseButWhole) {
  const SoundScene scene = make_sound(test::cornell_box());
  std::stop_source stop;
  stop.request_stop();
  const PatchMesh mesh(scene, {.max_length = 10}, {.stop = stop.get_token(), .report = {}});
  expect_sound(mesh.elements(), scene);
  EXPECT_LT(mesh.element_count(), 200);
}

TEST(PatchMesh, UnknownElementsAreRefused) {
  const SoundScene scene = make_sound(test::l_room(false));
  PatchMesh mesh(scene, {});
  const int count = mesh.element_count();
  for (const int e : {-1, count})
    test::expect_error(
        [&] {
          mesh.split_in_four(std::vector<int>{0, e});
        },
        ErrorCode::contract, {fmt::format("element {}", e)});
  EXPECT_EQ(mesh.element_count(), count);
}

}  // namespace
}  // namespace halfshade
