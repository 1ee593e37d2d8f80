#include "solver/reflected/leaving_field.h"

#include "meshing/repair/repair.h"
#include "solver/reflected/reflecting_scene.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(LeavingField, IsTheFieldOnLeavesOfAllOrders) {
  test::Random random(11);
  const ReflectingScene scene = make_reflecting_scene(make_sound(test::room({1, 1, 1}, {})));
  for (int highest = 0; highest <= max_reflected_order; ++highest) {
    ReflectedMesh mesh = make_reflected_mesh(scene.roots, 0.4, highest, 1000);
    for (const int t : mesh.triangle) mesh.order[at(t)] = t % (highest + 1);
    ElementField field = zero_field(mesh);
    for (double& c : field.coefficients.reshaped()) c = random(-1, 1);
    const LeavingField leaving(mesh, field);
    for (int e = 0; e < mesh.count(); ++e) {
      const TrianglePlace place(random(0, 0.5), random(0, 0.5));
      leaving.prefetch(mesh.triangle[at(e)]);
      const Rgb off = leaving.value(mesh.triangle[at(e)], place) - value_at(field, e, place);
      EXPECT_LT(off.abs().maxCoeff(), 1e-12) << highest << ' ' << e;
    }
  }
}

}  // namespace
}  // namespace halfshade
