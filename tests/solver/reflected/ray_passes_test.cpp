#include "solver/reflected/ray_passes.h"

#include "meshing/repair/repair.h"
#include "solver/reflected/ray_exchange.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

TEST(RaysMissing, MakeUpForWhatIsThere) {
  EXPECT_EQ(rays_missing(100, 100), 0);
  EXPECT_EQ(rays_missing(100, 200), 0);
  EXPECT_DOUBLE_EQ(rays_missing(100, 0), 100);
  for (const double sent : {10., 50., 99.}) {
    const double more = rays_missing(100, sent);
    EXPECT_GT(more, 100 - sent) << "independent results are worth less than their rays at once";
    EXPECT_NEAR(rays_as_good_as(sent, more), 100, 1e-9);
    // Of the mean of results of variances a and b, weighted by 1/a and 1/b: a b / (a + b).
    const double a = std::pow(sent, -noise_exponent), b = std::pow(more, -noise_exponent);
    EXPECT_NEAR(a * b / (a + b), std::pow(100., -noise_exponent), 1e-12);
  }
}

/// Two passes after what is kept, each planned to leave a share of the noise before it: as much is
/// left as was planned.
TEST(RayPasses, LeaveTheNoiseThatWasWanted) {
  const SoundScene sound = make_sound(test::room({1, 1, 1}, {}));
  const ReflectingScene scene = make_reflecting_scene(sound);
  const auto direct = [](int, const Vec3& p) {
    return Rgb(Rgb::Constant(p.x() + 0.3 * p.y() > 0.6 ? 2 : 1));
  };
  FirstLight light = first_light(sound, scene.roots, direct, false);
  for (Rgb& rho : light.rho) rho = Rgb::Constant(0.5);
  const ReflectedMesh mesh = make_reflected_mesh(scene.roots, 0.1, 2, 100000);
  RayExchange exchange(scene, light, 7);
  ASSERT_TRUE(exchange.update(mesh, {}));
  const ElementField leaving = zero_field(mesh), kept = exchange.source(mesh);
  const FieldNoise of_kept = exchange.noise(mesh, leaving);
  const std::vector<double> weight(at(mesh.count()), 1);
  const auto sum = [&](const FieldNoise& noise) {
    const std::vector<double> each = noise_of_elements(noise, weight);
    return std::accumulate(each.begin(), each.end(), 0.);
  };
  RayPasses passes;
  FieldNoise noise = of_kept;
  for (int pass = 0; pass < 2; ++pass) {
    const double wanted = 0.4 * sum(noise);
    const std::vector<int> strata = share_rays(
        mesh, noise_of_elements(of_kept, weight), weight,
        {exchange.most_rays(), passes.sent(mesh, exchange.rays_of_nodes(mesh)), wanted, 1e6});
    const FinalPass found = final_pass(scene, mesh, light, leaving, strata, pass + 1, {});
    passes.add(mesh, found, strata, weight, kept, of_kept);
    ElementField rest = kept;
    noise = of_kept;
    passes.correct(mesh, rest, noise);
    EXPECT_NEAR(sum(noise) / wanted, 1, 0.2) << pass;
  }
}

}  // namespace
}  // namespace halfshade
