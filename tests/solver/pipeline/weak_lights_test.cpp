#include "solver/pipeline/weak_lights.h"

#include "solver/pipeline/solve.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr double rho = 0.7;

/// Two closed cubes beside each other, each with a ceiling that emits and reflects as the rest do.
Scene two_rooms(double dim, double bright) {
  Scene scene;
  scene.groups = {"dim", "bright"};
  const int wall = test::add_material(scene, rho, 0);
  for (int room = 0; room < 2; ++room) {
    const int light = test::add_material(scene, rho, room == 0 ? dim : bright);
    const double x = 1.5 * room;
    int face = 0;
    for (const auto& corners : test::box_faces({x, 0, 0}, {x + 1, 1, 1}, true)) {
      test::add_polygon(scene, corners, face++ == 0 ? light : wall);
      scene.faces.back().group = room;
    }
  }
  return scene;
}

double mean_irradiance(const SolveResult& result, int group) {
  double power = 0, area = 0;
  for (int e = 0; e < result.elements.count(); ++e) {
    if (result.elements.group[at(e)] != group) continue;
    power += result.elements.area[at(e)] * result.solution.irradiance(e, 0);
    area += result.elements.area[at(e)];
  }
  return power / area;
}

bool is_called_dark(const SolveResult& result) {
  return std::any_of(result.warnings.begin(), result.warnings.end(), [](const Warning& warning) {
    return warning.kind == Warning::Kind::dark_groups;
  });
}

TEST(WeakLights, AreRightOrSaidToBeLost) {
  // A sixth of the surfaces emits; what is put in is absorbed.
  const double right = 1 / (6 * (1 - rho));
  for (const double dim : {1e-50, 1e-70, 1e-80, 1e-100, 1e-170}) {
    SolveOptions options;
    options.tolerance = 0.05;
    const SolveResult result = solve(two_rooms(dim, 1 / dim > 1e155 ? 1e155 : 1 / dim), options);
    EXPECT_FALSE(is_called_dark(result));
    const bool is_said = result.not_reached.find("light of dim is so weak") != std::string::npos;
    const double error = mean_irradiance(result, 0) / dim / right - 1;
    EXPECT_TRUE(is_said || std::abs(error) < 0.02) << dim << " " << error;
    EXPECT_EQ(result.not_reached.empty(), dim > 1e-72) << result.not_reached;
  }
}

TEST(WeakLights, AreFoundByTheMatrix) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 300;
  const SolveResult result = solve(two_rooms(1e-170, 1e155), options);
  EXPECT_NEAR(mean_irradiance(result, 0) / 1e-170, 1 / (6 * (1 - rho)), 0.02);
  EXPECT_EQ(result.not_reached, "");
}

TEST(WeakLights, InStrongerLightDoNotMatter) {
  Scene scene = two_rooms(1, 1);
  scene.materials[at(scene.faces.front().material)].exitance.setConstant(1e-180);
  const int strong = test::add_material(scene, rho, 1);
  scene.faces[1].material = strong;
  EXPECT_EQ(solve(scene).not_reached, "");
}

}  // namespace
}  // namespace halfshade
