#include "solver/reflected/irradiance_row.h"

#include "meshing/repair/repair.h"
#include "solver/exchange/form_factor.h"
#include "solver/reflected/exact_estimate.h"
#include "solver/reflected/exact_exchange.h"
#include "tests/support/scenes.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

const RowAccuracy accuracy{3e-5, 3e-3, 0.7};

/// Whose rounding puts a two-sided shelf's points on either side of its plane.
const std::vector<double> heights = {0.1, 0.2, 0.3, 0.6, 0.7, 1.1, 0.123456789, 1. / 3};

void add_shelf(Scene& scene, double z, const Eigen::Matrix3d& turn) {
  const int material = test::add_material(scene, 0.95, 0);
  scene.materials[at(material)].two_sided = true;
  std::vector<Vec3> corners = {{0.5, 1.8, z}, {1.5, 1.8, z}, {1.5, 2, z}, {0.5, 2, z}};
  for (Vec3& p : corners) p = turn * p;
  test::add_polygon(scene, corners, material);
}

/// A wall in y = 2, turned, and a two-sided shelf that touches it.
Scene wall_with_shelf(double z, const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  Scene scene;
  std::vector<Vec3> corners = {{0, 2, 0}, {2, 2, 0}, {2, 2, 2}, {0, 2, 2}};
  for (Vec3& p : corners) p = turn * p;
  test::add_polygon(scene, corners, test::add_material(scene, 0.5, 0));
  add_shelf(scene, z, turn);
  return scene;
}

Scene room_with_shelf(double z) {
  Scene scene = test::room({2, 2, 2}, {});
  add_shelf(scene, z, Eigen::Matrix3d::Identity());
  return scene;
}

/// What rows are made of.
struct Rows {
  explicit Rows(const Scene& input, double length = 0.2)
      : scene(make_sound(input)),
        reflecting(make_reflecting_scene(scene)),
        mesh(make_reflected_mesh(reflecting.roots, length, 2, 10000)),
        sight(scene, reflecting),
        maker(sight, mesh, accuracy) {}

  int root(int element) const { return mesh.root(element); }
  const Surface& surface(int element) const {
    return scene.surfaces[at(reflecting.roots.surface[at(root(element))])];
  }
  SurfacePoint point(int element, const TrianglePlace& place) const {
    return {mesh.position(element, place), reflecting.roots.normal[at(root(element))]};
  }
  std::vector<Sighted> targets(int element) const {
    return sight.may_see(mesh.forest.corners(mesh.triangle[at(element)]), root(element));
  }
  /// At each node of each element.
  template <class Use>
  void for_each_node(const Use& use) const {
    for (int e = 0; e < mesh.count(); ++e)
      for (const TrianglePlace& place :
           element_nodes_of(mesh.order[at(mesh.triangle[at(e)])]).places)
        use(e, point(e, place));
  }

  SoundScene scene;
  ReflectingScene reflecting;
  ReflectedMesh mesh;
  ExactSight sight;
  RowMaker maker;
};

/// Form factor to all fronts that are not in the plane of the point's surface; nothing hides any.
double in_closed_form(const Rows& rows, int element, const SurfacePoint& point) {
  double sum = 0;
  for (const Surface& other : rows.scene.surfaces) {
    if (other.plane == rows.surface(element).plane) continue;
    std::vector<Vec3> corners;
    for (const Vec2& q : other.rings.front()) corners.push_back(other.frame.to_space(q));
    sum += point_to_polygon(point.position, point.normal, corners);
  }
  return sum;
}

TEST(IrradianceRow, OfPointsInThePlaneOfATwoSidedFaceAreClosedForms) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const Eigen::Matrix3d& turned : {Eigen::Matrix3d(Eigen::Matrix3d::Identity()), turn})
    for (const double z : heights) {
      const Rows rows(wall_with_shelf(z, turned));
      rows.for_each_node([&](int e, const SurfacePoint& point) {
        const IrradianceRow row = rows.maker.row(point, rows.targets(e));
        ASSERT_NEAR(row.sum, in_closed_form(rows, e, point), 1e-12) << z << ' ' << e;
        ASSERT_LT(row.off, 1e-5) << z << ' ' << e;
        ASSERT_EQ(row.unsure, 0) << z << ' ' << e;
      });
    }
}

TEST(IrradianceRow, OfClosedRoomsWithATwoSidedShelfSumToOne) {
  for (const double z : heights) {
    const Rows rows(room_with_shelf(z), 0.5);
    rows.for_each_node([&](int e, const SurfacePoint& point) {
      const IrradianceRow row = rows.maker.row(point, rows.targets(e));
      ASSERT_NEAR(row.sum, 1, 1e-12) << z << ' ' << e;
      ASSERT_LT(row.off, 1e-5) << z << ' ' << e;
      ASSERT_EQ(row.unsure, 0) << z << ' ' << e;
    });
  }
}

TEST(IrradianceRow, PointsOfAWallLevelWithAShelfSeeItEdgeOn) {
  for (const double z : heights) {
    const Rows rows(wall_with_shelf(z));
    for (const double off : {-3e-17, -1e-17, 0., 1e-17, 3e-17})
      for (const double x : {0.1, 0.4, 0.49, 1.6}) {
        const SurfacePoint point{{x, 2, z + off}, -Vec3::UnitY()};
        const IrradianceRow row = rows.maker.row(point, rows.sight.may_see(point));
        EXPECT_EQ(row.sum, 0) << z << ' ' << off << ' ' << x;
        EXPECT_EQ(row.off, 0) << z << ' ' << off << ' ' << x;
      }
  }
}

TEST(IrradianceRow, PointsThatWereMeantToLieOnATwoSidedFaceDoNotSeeItsBack) {
  const Rows rows(wall_with_shelf(0.3));
  for (const double off : {-1e-10, -1e-16, 0., 1e-16, 1e-10})
    for (const double up : {-1., 1.}) {
      const SurfacePoint point{{0.9, 1.9, 0.3 + off}, up * Vec3::UnitZ()};
      const std::vector<Sighted> seen = rows.sight.may_see(point);
      ASSERT_EQ(seen.size(), 1U) << off << ' ' << up;
      EXPECT_EQ(rows.scene.surfaces[at(seen[0].surface)].frame.normal.y(), -1);
    }
}

TEST(IrradianceRow, KnowsThatItSeesMoreThanOneOrTooLittleInAClosedRoom) {
  const Rows rows(test::room({1, 1, 1}, {}), 0.5);
  const SurfacePoint point = rows.point(0, TrianglePlace::Constant(0.3));
  std::vector<Sighted> targets = rows.targets(0);
  const auto closed = [&] {
    IrradianceRow row;
    make_closed_row(rows.maker, rows.reflecting, rows.root(0), point.position, targets, row);
    return row;
  };
  EXPECT_EQ(closed().unsure, 0);
  const Sighted last = targets.back();
  const double factor = rows.maker.row(point, {&last, 1}).sum;
  targets.push_back(last);  // twice
  EXPECT_NEAR(closed().unsure, factor, 1e-12);
  targets.resize(targets.size() - 2);  // not at all
  EXPECT_NEAR(closed().unsure, factor, 1e-12);
}

/// Rows of one element lead it does not know where.
class UnsureExchange : public IrradianceOperator {
 public:
  bool update(const ReflectedMesh&, const Progress&) override { return true; }
  ElementField source(const ReflectedMesh& mesh) const override { return zero_field(mesh); }
  ElementField apply(const ReflectedMesh& mesh, const ElementField&) const override {
    return zero_field(mesh);
  }
  std::vector<int> seen_from(const ReflectedMesh&, int) const override { return {}; }
  double unsure(int element) const override { return element == 7 ? 0.1 : 0; }
};

TEST(ExactEstimate, AddsWhatRowsDoNotKnow) {
  const Rows rows(test::room({1, 1, 1}, {{{0, 3}, {0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 0}}}), 0.5);
  const FirstLight light = first_light(rows.scene, rows.reflecting.roots, {}, true);
  const UnsureExchange exchange;
  const LightSystems systems = find_systems(rows.reflecting, light, rows.mesh, exchange);
  const ExactGather gather(rows.sight, rows.reflecting, light, rows.mesh, zero_field(rows.mesh),
                           accuracy, 1000);
  ASSERT_TRUE((gather.brightest() == 3).all());
  // As if nothing arrived, so that without what is unsure all that does is off.
  const SplitIrradiance irradiance{ChannelArray::Zero(systems.count(), 3), zero_field(rows.mesh)};
  std::vector<double> shares(at(rows.mesh.count()), 0);
  shares[3] = 0.1;  // no place on the element
  const ReflectionEstimate estimate = estimate_exactly(
      rows.sight, gather, {rows.mesh, light, exchange, systems}, irradiance,
      spread_probes(rows.mesh, std::vector<double>(shares.size(), 2), shares, 1000, 0), {});
  EXPECT_NEAR(estimate.square_error[7], 2 * rows.mesh.area(7) * 3 * 0.3 * 0.3, 1e-12);
  EXPECT_NEAR(estimate.sum - estimate.square_error[3], estimate.square_error[7],
              1e-9 * estimate.sum);
}

}  // namespace
}  // namespace halfshade
