#include "solver/pipeline/require_limits.h"

#include "solver/pipeline/solve.h"
#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// A lit cube of perfect reflectors, each face a group of its own, beside others in the open.
Scene white_cube() {
  Scene scene = test::lit_cube({1, 1, 1, 1, 1, 1});
  scene.groups.clear();
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    scene.groups.push_back(fmt::format("w{}", f));
    scene.faces[f].group = static_cast<int>(f);
  }
  return scene;
}

TEST(RequireLimits, NamesTheGroupsOfASpaceThatReflectsEverything) {
  for (const SolveMethod method : {SolveMethod::fields, SolveMethod::matrix}) {
    SolveOptions options;
    options.method = method;
    options.elements = 100;
    options.tolerance = 0.1;
    test::expect_error([&] { solve(white_cube(), options); }, ErrorCode::invalid_input,
                       {"the groups w0, w1, w2, w3, w4, w5 close in a space that reflects"});
    options.radiosity.bounces = 2;
    EXPECT_NO_THROW(solve(white_cube(), options));
  }
}

TEST(RequireLimits, OfVeryManyGroupsNamesTheFirst) {
  Scene scene = white_cube();
  // The first face in stripes.
  const Face whole = scene.faces[0];
  const std::vector<Vec3> corners = face_corners(scene, 0);
  for (int k = 0; k < 8; ++k) {
    const auto along = [&](int from, int to, double share) {
      return Vec3(corners[at(from)] + share * (corners[at(to)] - corners[at(from)]));
    };
    const double low = k / 8., high = (k + 1) / 8.;
    test::add_polygon(scene,
                      {along(0, 1, low), along(0, 1, high), along(3, 2, high), along(3, 2, low)},
                      whole.material);
    scene.groups.push_back(fmt::format("stripe{}", k));
    scene.faces.back().group = static_cast<int>(scene.groups.size()) - 1;
  }
  scene.faces.erase(scene.faces.begin());
  test::expect_error([&] { solve(scene); }, ErrorCode::invalid_input, {"w1, w2", "and 5 more"});
}

TEST(RequireLimits, LetsPassWhatAbsorbsOrIsOpen) {
  SolveOptions options;
  options.tolerance = 0.1;
  EXPECT_NO_THROW(solve(test::lit_cube({1, 1, 1, .9, 1, 1}), options));
  Scene open = white_cube();
  open.faces.erase(open.faces.begin());
  EXPECT_NO_THROW(solve(open, options));
}

}  // namespace
}  // namespace halfshade
