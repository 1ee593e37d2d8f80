#include "solver/reflected/forest_field.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/discontinuity_scenes.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

ReflectedMesh mesh_of_a_cube(int order) {
  const SoundScene scene = make_sound(test::room({1, 1, 1}, {}));
  return make_reflected_mesh(PatchMesh(scene, {}).elements(), 0.4, order, 1000);
}

double polynomial(int order, const Vec3& p) {
  return std::pow(0.3 + p.x() - 0.7 * p.y() + p.z(), order);
}

ElementField sampled(const ReflectedMesh& mesh, int order) {
  ElementField field = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e) {
    const ElementNodes& nodes = element_nodes_of(mesh.order[at(mesh.triangle[at(e)])]);
    Eigen::MatrixXd values(static_cast<Eigen::Index>(nodes.places.size()), 3);
    for (std::size_t k = 0; k < nodes.places.size(); ++k)
      values.row(static_cast<Eigen::Index>(k))
          .setConstant(polynomial(order, mesh.position(e, nodes.places[k])));
    field.of(e) = (nodes.fit * values).array();
  }
  return field;
}

TEST(ForestField, PolynomialsOfTheOrderAreTheSameOnAllTriangles) {
  test::Random random(1);
  for (int order = 0; order <= max_reflected_order; ++order) {
    const ReflectedMesh mesh = mesh_of_a_cube(order);
    const ElementField field = forest_field(mesh, sampled(mesh, order));
    ASSERT_EQ(field.count(), mesh.forest.count());
    for (int t = 0; t < mesh.forest.count(); ++t) {
      const double s = random(0, 1), u = random(0, 1 - s);
      EXPECT_NEAR(value_at(field, t, {s, u})[0],
                  polynomial(order, position(mesh.forest.corners(t), {s, u})), 1e-11);
    }
  }
}

TEST(ForestField, MeansAndMomentsAreKept) {
  const ReflectedMesh mesh = mesh_of_a_cube(2);
  const ElementField field = sampled(mesh, 3), on_forest = forest_field(mesh, field);
  for (int t = 0; t < mesh.forest.root_count(); ++t) {
    Rgb sum = Rgb::Zero();
    for (int e = 0; e < mesh.count(); ++e)
      if (mesh.root(e) == t) sum += mesh.area(e) * field.of(e).row(0).transpose();
    EXPECT_NEAR(on_forest.of(t)(0, 0) * mesh.forest.area(t), sum[0], 1e-12);
  }
}

TEST(ForestField, RestrictedItIsTheSame) {
  test::Random random(2);
  const ReflectedMesh mesh = mesh_of_a_cube(2), fine = bisected(mesh, 2);
  EXPECT_EQ(fine.count(), 4 * mesh.count());
  const ElementField field = sampled(mesh, 3), on_fine = restricted(mesh, field, fine);
  for (int e = 0; e < fine.count(); ++e) {
    const double s = random(0, 1), u = random(0, 1 - s);
    const Vec3 p = fine.position(e, {s, u});
    const ForestPlace whole =
        mesh.forest.leaf_at({fine.root(e), place_of(mesh.forest.corners(fine.root(e)), p)});
    EXPECT_NEAR(value_at(on_fine, e, {s, u})[0],
                value_at(field, mesh.element[at(whole.triangle)], whole.place)[0], 1e-11);
  }
}

}  // namespace
}  // namespace halfshade
