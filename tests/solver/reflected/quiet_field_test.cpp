#include "solver/reflected/quiet_field.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "tests/support/discontinuity_scenes.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace halfshade {
namespace {

/// Of orders 0 to 2, some elements much smaller than others.
ReflectedMesh mesh_of_a_cube() {
  const SoundScene scene = make_sound(test::room({1, 1, 1}, {}));
  ReflectedMesh mesh = make_reflected_mesh(PatchMesh(scene, {}).elements(), 0.2, 2, 100000);
  for (int round = 0; round < 4; ++round) refine(mesh, std::vector<int>{0, 5, 6}, {2, 2, 2});
  for (const int t : mesh.triangle)
    if (t % 5 == 0) mesh.order[at(t)] = t % 2;
  return mesh;
}

ElementField projected(const ReflectedMesh& mesh, double (*value)(const Vec3&)) {
  ElementField field = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e) {
    const ElementNodes& nodes = element_nodes_of(field.order[at(e)]);
    Eigen::MatrixXd values(static_cast<Eigen::Index>(nodes.places.size()), 3);
    for (std::size_t k = 0; k < nodes.places.size(); ++k)
      values.row(static_cast<Eigen::Index>(k))
          .setConstant(value(mesh.position(e, nodes.places[k])));
    field.of(e) = (nodes.fit * values).array();
  }
  return field;
}

double smooth(const Vec3& p) { return 1 + 0.3 * p.x() - 0.2 * p.y() * p.y() + 0.1 * p.z(); }
double step(const Vec3& p) { return p.x() + 0.3 * p.y() > 0.6 ? 2 : 1; }

/// A field with noise added to each coefficient, the same in all channels as that of rays nearly
/// is, and that noise as it is expected.
struct Noisy {
  ElementField field;
  FieldNoise noise;
};

Noisy with_noise(const ReflectedMesh& mesh, ElementField field, double deviation, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0, deviation);
  FieldNoise noise(at(mesh.count()));
  for (int e = 0; e < mesh.count(); ++e)
    for (int d = 0; d <= field.order[at(e)]; ++d)
      for (int k = basis_size(d - 1); k < basis_size(d); ++k) {
        field.of(e).row(k) += normal(engine);
        noise[at(e)][at(d)] += mesh.area(e) * 3 * deviation * deviation;
      }
  return {std::move(field), std::move(noise)};
}

double square_difference(const ReflectedMesh& mesh, const ElementField& a, const ElementField& b) {
  double sum = 0;
  for (int e = 0; e < mesh.count(); ++e) sum += mesh.area(e) * (a.of(e) - b.of(e)).square().sum();
  return sum;
}

double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.);
}

TEST(QuietField, WithoutNoiseNothingChanges) {
  const ReflectedMesh mesh = mesh_of_a_cube();
  const ElementField field = projected(mesh, step);
  const QuietField quiet =
      without_noise(mesh, noisy_forest(mesh, field, FieldNoise(at(mesh.count()))),
                    std::vector<double>(at(mesh.count()), 1));
  EXPECT_LT((quiet.field.coefficients - field.coefficients).abs().maxCoeff(), 1e-12);
  EXPECT_EQ(sum_of(quiet.noise), 0);
}

TEST(QuietField, WhatIsSmoothLosesMostOfItsNoiseAndTheRestIsKnown) {
  const ReflectedMesh mesh = mesh_of_a_cube();
  const ElementField right = projected(mesh, smooth);
  const std::vector<double> weight(at(mesh.count()), 1);
  double before = 0, after = 0, claimed = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Noisy found = with_noise(mesh, right, 0.05, seed);
    const QuietField quiet =
        without_noise(mesh, noisy_forest(mesh, found.field, found.noise), weight);
    before += square_difference(mesh, found.field, right);
    after += square_difference(mesh, quiet.field, right);
    claimed += sum_of(quiet.noise);
  }
  EXPECT_LT(after, 0.3 * before);
  EXPECT_GT(claimed, 0.8 * after);
  EXPECT_LT(claimed, 2 * after);
}

TEST(QuietField, WhatIsMoreThanNoiseStays) {
  const ReflectedMesh mesh = mesh_of_a_cube();
  const ElementField right = projected(mesh, step);
  const std::vector<double> weight(at(mesh.count()), 1);
  const Noisy found = with_noise(mesh, right, 0.05, 7);
  const QuietField quiet =
      without_noise(mesh, noisy_forest(mesh, found.field, found.noise), weight);
  const double after = square_difference(mesh, quiet.field, right);
  EXPECT_LT(after, square_difference(mesh, found.field, right));
  EXPECT_LT(after, 1.5 * sum_of(quiet.noise));
}

TEST(QuietField, MeansOverRootsStay) {
  const ReflectedMesh mesh = mesh_of_a_cube();
  const Noisy found = with_noise(mesh, projected(mesh, step), 0.3, 3);
  const QuietField quiet = without_noise(mesh, noisy_forest(mesh, found.field, found.noise),
                                         std::vector<double>(at(mesh.count()), 1));
  std::vector<double> change(at(mesh.forest.root_count()));
  for (int e = 0; e < mesh.count(); ++e)
    change[at(mesh.root(e))] += mesh.area(e) * (quiet.field.of(e)(0, 1) - found.field.of(e)(0, 1));
  for (const double x : change) EXPECT_NEAR(x, 0, 1e-12);
}

TEST(QuietField, MoreRaysAreAskedForWhereLessNoiseIsWanted) {
  const ReflectedMesh mesh = mesh_of_a_cube();
  const Noisy found = with_noise(mesh, projected(mesh, smooth), 0.05, 5);
  const std::vector<double> weight(at(mesh.count()), 2);
  const NoisyForest noisy = noisy_forest(mesh, found.field, found.noise);
  const double now = sum_of(without_noise(mesh, noisy, weight).noise);
  EXPECT_EQ(rays_for(mesh, noisy, weight, now * 1.01), 1);
  double before = 1;
  for (const double share : {0.5, 0.2, 0.05}) {
    const double rays = rays_for(mesh, noisy, weight, share * now);
    EXPECT_GT(rays, before);
    EXPECT_LT(rays, 4 / share) << "what is kept grows where noise falls, but less than that";
    before = rays;
  }
}

}  // namespace
}  // namespace halfshade
