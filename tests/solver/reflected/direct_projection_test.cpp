#include "solver/reflected/direct_projection.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/discontinuity_scenes.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(DirectProjection, SmoothLightIsTakenAsItIsAndItsMeanWhereItBreaks) {
  const SoundScene scene = make_sound(test::room({1, 1, 1}, {}));
  const ElementTable roots = PatchMesh(scene, {}).elements();
  const ReflectedMesh mesh = make_reflected_mesh(roots, 0.4, 2, 1000);
  const auto integral_of = [&](const DirectIrradiance& direct) {
    const FirstLight light = first_light(scene, roots, direct, false);
    DirectProjection projection(20000);
    projection.update(mesh, light);
    double sum = 0;
    for (int e = 0; e < mesh.count(); ++e) sum += mesh.area(e) * projection.mean(mesh, e)[0];
    return sum;
  };
  const double smooth =
      integral_of([](int, const Vec3& p) { return Rgb::Constant(p.x() * p.x()); });
  EXPECT_NEAR(smooth, 4. / 3 + 1, 1e-12);  // four walls with ∫ x² = 1/3, and those at 0 and 1
  const double broken =
      integral_of([](int, const Vec3& p) { return Rgb::Constant(p.x() > 0.3141 ? 1. : 0.); });
  EXPECT_NEAR(broken, 4 * (1 - 0.3141) + 1, 3e-3);
}

}  // namespace
}  // namespace halfshade
