#include "solver/factors/factor_matrix.h"
#include "tests/support/face_factors.h"
#include "tests/support/round_things.h"
#include "tests/support/scenes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

/// Rows are as exact as asked for, and say so.
void expect_reached(const FactorMatrix& matrix, double tolerance, const std::string& what) {
  EXPECT_LE((matrix.row_sum - 1).abs().maxCoeff(), 2 * tolerance) << what << " " << tolerance;
  EXPECT_LE(matrix.error.maxCoeff(), tolerance) << what << " " << tolerance;
  EXPECT_EQ(matrix.report.rows_not_reached, 0) << what << " " << tolerance;
}

/// The side of a cylinder of radius 1 and height 4, seen from outside, as a group.
void add_cylinder(Scene& scene, double middle, int sides) {
  const int group = static_cast<int>(scene.groups.size());
  scene.groups.push_back("cylinder " + std::to_string(group));
  const std::size_t first = scene.faces.size();
  test::add_cylinder(scene, {{middle, 0, 0}, 1, 4, sides, false, false}, 0);
  for (std::size_t f = first; f < scene.faces.size(); ++f) scene.faces[f].group = group;
}

/// Lattices of points agree about some pairs of their sides, and are wrong: rows tell.
TEST(RowSums, TwoCylinders) {
  for (const int sides : {8, 16}) {
    Scene scene;
    test::add_material(scene, 0.5, 0);
    add_cylinder(scene, 0, sides);
    add_cylinder(scene, 3, sides);
    for (const FactorUnit unit : {FactorUnit::face, FactorUnit::group})
      for (const double tolerance : {1e-3, 1e-4}) {
        FactorOptions options;
        options.unit = unit;
        options.tolerance = tolerance;
        expect_reached(form_factor_matrix(scene, options), tolerance,
                       std::to_string(sides) + (unit == FactorUnit::face ? " faces" : " groups"));
      }
  }
}

Scene squares_and_sheets() {
  Scene scene;
  test::add_material(scene, 0.5, 0);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 0);
  test::add_polygon(scene, {{0, 1, 1}, {1, 1, 1}, {1, 0, 1}, {0, 0, 1}}, 0);
  test::add_polygon(scene, {{.31, .17, .3}, {.62, .17, .3}, {.62, .48, .3}, {.31, .48, .3}}, 0);
  test::add_polygon(scene, {{.1, .1, .6}, {.8, .2, .7}, {.3, .9, .5}}, 0);
  return scene;
}

Scene concave_room() {
  const std::vector<Vec2> plan = {{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}};
  Scene scene;
  test::add_material(scene, 0.5, 0);
  std::vector<Vec3> floor, ceiling;
  for (std::size_t k = 0; k < plan.size(); ++k) {
    const Vec2 &a = plan[k], &b = plan[(k + 1) % plan.size()];
    floor.emplace_back(a.x(), a.y(), 0);
    ceiling.insert(ceiling.begin(), Vec3(a.x(), a.y(), 2.5));
    test::add_polygon(
        scene, {{b.x(), b.y(), 0}, {a.x(), a.y(), 0}, {a.x(), a.y(), 2.5}, {b.x(), b.y(), 2.5}}, 0);
  }
  test::add_polygon(scene, floor, 0);
  test::add_polygon(scene, ceiling, 0);
  return scene;
}

/// Corners that walls share lie off their planes, which hid all from what lay behind them.
TEST(RowSums, AConcaveRoomInSinglePrecision) {
  const FactorMatrix exact = test::face_factors(concave_room(), 1e-4);
  expect_reached(exact, 1e-4, "exact");
  for (const double angle : {0.7, 1.9}) {
    Scene scene = concave_room();
    const Eigen::AngleAxisd turn(angle, Vec3(1, 2, 3).normalized());
    for (Vec3& p : scene.vertices) p = (turn * p).cast<float>().cast<double>();
    const FactorMatrix matrix = test::face_factors(scene, 1e-3);
    expect_reached(matrix, 1e-3, "turned");
    ASSERT_EQ(matrix.factors.rows(), exact.factors.rows());
    EXPECT_LE((matrix.factors - exact.factors).cwiseAbs().maxCoeff(), 1.2e-3) << angle;
  }
}

/// A level sheet with two sides.
void add_sheet(Scene& scene, const Vec2& low, const Vec2& high, double z) {
  const int material = test::add_material(scene, 0.5, 0);
  scene.materials.back().two_sided = true;
  test::add_polygon(scene,
                    {{low.x(), low.y(), z},
                     {high.x(), low.y(), z},
                     {high.x(), high.y(), z},
                     {low.x(), high.y(), z}},
                    material);
}

/// It hides all from under itself and nothing from elsewhere: points of a lattice, or of a cell,
/// may all be elsewhere.
TEST(RowSums, ASheetCloseAboveAFloor) {
  const Vec2 centre(0.31, 0.62);
  for (const double height : {1e-5, 1e-4, 1e-3})
    for (const Vec2& size : {Vec2(0.1, 0.1), Vec2(0.5, 0.5), Vec2(0.02, 0.5)})
      for (const double tolerance : {1e-3, 1e-5}) {
        Scene scene = test::room({1, 1, 1}, {});
        add_sheet(scene, centre - size / 2, centre + size / 2, height);
        expect_reached(test::face_factors(scene, tolerance), tolerance,
                       std::to_string(size.x()) + " at " + std::to_string(height));
      }
}

/// The same where floor and ceiling are of several convex parts.
TEST(RowSums, AStripCloseAboveTheFloorOfAConcaveRoom) {
  Scene scene = concave_room();
  add_sheet(scene, {3.86, 0.37}, {3.9, 0.54}, 0.013);
  for (const double tolerance : {1e-4, 1e-6})
    expect_reached(test::face_factors(scene, tolerance), tolerance, "strip");
}

/// A sheet with two sides whose front edge is `low` and whose back edge `high` up.
void add_slope(Scene& scene, const Vec2& from, const Vec2& to, double low, double high) {
  add_sheet(scene, from, to, low);
  for (const std::size_t k : {1, 2}) scene.vertices[scene.vertices.size() - k].z() = high;
}

/// Of a sheet above a floor, corners reach over cells, between their points; what is next to it
/// from there is seen by all alike.
TEST(RowSums, CornersOfSheetsCloseAboveTheFloorOfAConcaveRoom) {
  Scene scene = test::l_room(false);
  add_slope(scene, {0.779272, 0.608236}, {0.804838, 0.683867}, 0.000956, 0.183861);
  add_sheet(scene, {0.760529, 1.602322}, {0.921465, 1.900127}, 0.979824);
  add_sheet(scene, {0.143162, 0.849777}, {0.270148, 1.069945}, 0.003764);
  expect_reached(test::face_factors(scene, 1e-6), 1e-6, "sheets");
}

/// Right under a ceiling things hide in thin layers from there what they hide smoothly from the
/// floor: few points do not tell from where it takes less.
TEST(RowSums, SheetsCloseUnderTheCeilingOfAConcaveRoom) {
  Scene scene = test::l_room(false);
  add_sheet(scene, {0.725651, 0.829446}, {0.860549, 1.313902}, 0.999294);
  add_sheet(scene, {1.645592, 0.183992}, {1.681693, 0.451599}, 0.036298);
  add_sheet(scene, {0.112885, 1.224391}, {0.271749, 1.542091}, 0.999849);
  const auto box = test::box_faces({1.006066, 0.963691, 0}, {1.215597, 0.985003, 0.362114}, false);
  for (const std::size_t face : {0, 1, 2, 3, 5}) test::add_polygon(scene, box[face], 0);
  expect_reached(test::face_factors(scene, 1e-6), 1e-6, "sheets");
}

/// What stands far off makes the box of the surroundings large, and changes nothing else: neither
/// points on the box, from which all the rest is next to nothing, nor its contour are rounded away.
TEST(RowSums, SomethingFarOff) {
  const FactorMatrix alone = test::face_factors(squares_and_sheets(), 1e-6);
  for (const double far : {1e3, 1e8})
    for (const double tolerance : {1e-4, 1e-5}) {
      Scene scene = squares_and_sheets();
      test::add_polygon(scene, {{far, 0, 0}, {far, 1, 0}, {far, 0, 1}}, 0);
      const FactorMatrix matrix = test::face_factors(scene, tolerance);
      expect_reached(matrix, tolerance, std::to_string(far));
      EXPECT_LE((matrix.factors.topLeftCorner(4, 4) - alone.factors).cwiseAbs().maxCoeff(),
                1.2 * tolerance)
          << far << " " << tolerance;
      EXPECT_LE((matrix.space.head(4) - alone.space).abs().maxCoeff(), 1.2 * tolerance)
          << far << " " << tolerance;
    }
}

/// Two coaxial disks by Howell's C-41, as polygons with so many corners: off by the square of their
/// sides.
TEST(RowSums, DisksConverge) {
  constexpr double near = 1, far = 2, distance = 1.5;
  const double x = 1 + (1 + std::pow(far / distance, 2)) / std::pow(near / distance, 2);
  const double expected = 0.5 * (x - std::sqrt(x * x - 4 * std::pow(far / near, 2)));
  double before = 0;
  for (const int corners : {16, 32, 64}) {
    Scene scene;
    test::add_material(scene, 0.5, 0);
    std::vector<Vec3> low, high;
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * std::numbers::pi * k / corners;
      low.emplace_back(near * std::cos(angle), near * std::sin(angle), 0);
      high.emplace_back(far * std::cos(angle), -far * std::sin(angle), distance);
    }
    test::add_polygon(scene, low, 0);
    test::add_polygon(scene, high, 0);
    const FactorMatrix matrix = test::face_factors(scene, 1e-5);
    expect_reached(matrix, 1e-5, std::to_string(corners));
    const double off = std::abs(matrix.factors(0, 1) - expected);
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / off), 2, 0.05) << corners;
    }
    before = off;
  }
  EXPECT_LT(before, 1e-3);
}

/// Round a corner, with a box that hangs in the way, and nothing put right afterwards.
TEST(RowSums, AConcaveRoomWithABoxInIt) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const FactorMatrix matrix = test::face_factors(test::l_room(true), tolerance);
    expect_reached(matrix, tolerance, std::to_string(std::log10(tolerance)));
    EXPECT_LE((matrix.row_sum - 1).abs().maxCoeff(), tolerance) << tolerance;
  }
}

/// A run that may look at few points says that it would take more.
TEST(RowSums, PairsThatTakeAllPointsAreCounted) {
  FactorOptions options;
  options.unit = FactorUnit::face;
  EXPECT_EQ(form_factor_matrix(squares_and_sheets(), options).report.pairs_at_limit, 0u);
  options.tolerance = 1e-7;
  options.max_points = 100;
  const FactorReport report = form_factor_matrix(squares_and_sheets(), options).report;
  EXPECT_GT(report.pairs_at_limit, 0u);
  EXPECT_LE(report.pairs_at_limit, report.clear_pairs + report.partial_pairs);
  EXPECT_GT(report.rows_not_reached, 0);
}

}  // namespace
}  // namespace halfshade
