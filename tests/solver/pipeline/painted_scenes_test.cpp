#include "meshing/repair/repair.h"
#include "solver/pipeline/light_at_points.h"
#include "solver/pipeline/solve.h"
#include "solver/reference/reference_light.h"
#include "tests/support/mean_irradiance.h"
#include "tests/support/painted.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

std::vector<SurfacePoint> places() {
  std::vector<SurfacePoint> points;
  for (const double x : {0.15, 0.5, 0.9, 1.3, 1.75})
    for (const double t : {0.2, 0.55, 0.85}) {
      points.push_back({{x, t, 0}, Vec3::UnitZ()});
      points.push_back({{x, 0, t}, Vec3::UnitY()});
      points.push_back({{x, 1, t}, -Vec3::UnitY()});
      points.push_back({{0, t, x / 2}, Vec3::UnitX()});
    }
  return points;
}

/// Of values at places, all channels, in the L2 norm.
double difference(const std::vector<PointLight>& a, const std::vector<PointLight>& b) {
  double square = 0, all = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    square += (a[k].irradiance - b[k].irradiance).square().sum();
    all += b[k].irradiance.square().sum();
  }
  return std::sqrt(square / all);
}

SolveOptions options(ReflectedVisibility visibility, double tolerance) {
  SolveOptions options;
  options.visibility = visibility;
  options.tolerance = tolerance;
  return options;
}

TEST(PaintedScenes, APictureOfTwoColoursIsAsTwoFaces) {
  for (const auto& [visibility, tolerance] :
       {std::pair{ReflectedVisibility::exact, 5e-3}, {ReflectedVisibility::sampled, 2e-2}}) {
    const SolveResult faces = solve(test::two_coloured_room(false), options(visibility, tolerance));
    const SolveResult picture =
        solve(test::two_coloured_room(true), options(visibility, tolerance));
    EXPECT_EQ(picture.scene.surfaces.size() + 1, faces.scene.surfaces.size());
    EXPECT_EQ(picture.not_reached, "");
    EXPECT_LT(difference(light_at_points(picture, places()), light_at_points(faces, places())),
              1.5 * tolerance);
  }
}

TEST(PaintedScenes, MethodMatrixTakesTheMeansOfElements) {
  SolveOptions matrix;
  matrix.method = SolveMethod::matrix;
  matrix.elements = 600;
  const SolveResult faces = solve(test::two_coloured_room(false), matrix);
  const SolveResult picture = solve(test::two_coloured_room(true), matrix);
  EXPECT_LT((test::mean_irradiance(picture) / test::mean_irradiance(faces) - 1).abs().maxCoeff(),
            0.01);
}

TEST(PaintedScenes, RandomWalksSeeThePicture) {
  const SoundScene sound = make_sound(test::two_coloured_room(true));
  std::vector<ReferencePoint> points;
  for (const SurfacePoint& p : places()) points.push_back({p.position, p.normal});
  ReferenceOptions walks;
  walks.samples = 4096;
  const ReferenceLight right = reference_light(sound, points, walks);
  const SolveResult result =
      solve(test::two_coloured_room(true), options(ReflectedVisibility::exact, 2e-3));
  const std::vector<PointLight> light = light_at_points(result, places());
  int far = 0;
  for (std::size_t k = 0; k < light.size(); ++k) {
    const Rgb off = (light[k].irradiance - right.values[k].total).abs();
    const Rgb slack = 3.5 * right.standard_errors[k].total + 6e-3 * right.values[k].total;
    far += (off > slack).any();
  }
  EXPECT_LE(far, 1);
}

TEST(PaintedScenes, OneColourIsThatOfAMaterial) {
  const Rgb red(0.75, 0.25, 0.125);
  Scene painted = test::two_coloured_room(true), plain = test::two_coloured_room(true);
  painted.paints[0].texture = test::two_coloured(red, red, 4);
  plain.paints.clear();
  plain.faces.back().paint = -1;
  plain.materials.back().rho = red;
  for (const ReflectedVisibility visibility :
       {ReflectedVisibility::exact, ReflectedVisibility::sampled}) {
    const SolveResult a = solve(painted, options(visibility, 3e-2));
    const SolveResult b = solve(plain, options(visibility, 3e-2));
    ASSERT_EQ(a.elements.count(), b.elements.count());
    EXPECT_LT((a.solution.irradiance / b.solution.irradiance - 1).abs().maxCoeff(), 1e-9);
    EXPECT_LT((a.solution.rho - b.solution.rho).abs().maxCoeff(), 1e-9);
  }
}

TEST(PaintedScenes, RadiosityIsTheMeanOfWhatIsReflected) {
  const double tolerance = 1e-2;
  const SolveResult result =
      solve(test::two_coloured_room(true), options(ReflectedVisibility::exact, tolerance));
  const Solution& s = result.solution;
  const Eigen::Map<const Eigen::ArrayXd> areas(result.elements.area.data(),
                                               result.elements.count());
  // What is emitted is absorbed, up to what the light is off.
  for (int c = 0; c < 3; ++c) {
    const double emitted = (areas * s.exitance.col(c)).sum();
    const double absorbed = (areas * (1 - s.rho.col(c)) * s.irradiance.col(c)).sum();
    EXPECT_NEAR(absorbed / emitted, 1, tolerance);
  }
}

}  // namespace
}  // namespace halfshade
