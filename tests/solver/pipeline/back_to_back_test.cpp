#include "meshing/core/plane_frame.h"
#include "meshing/repair/repair.h"
#include "solver/pipeline/solve.h"
#include "solver/pipeline/warnings.h"
#include "tests/support/own_corners.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

// Walls between rooms, modelled by a face for each room, in one place but for the last digits.

namespace halfshade {
namespace {

/// Two cubes side by side, in each of which all light is 1.
Scene two_furnaces() {
  Scene scene = test::lit_cube({.5, .5, .5, .5, .5, .5});
  for (Material& material : scene.materials) material.exitance = 1 - material.rho;
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Vec3& p : scene.vertices) low = std::min(low, p.x()), high = std::max(high, p.x());
  const auto vertices = static_cast<int>(scene.vertices.size());
  const std::size_t faces = scene.faces.size();
  for (int v = 0; v < vertices; ++v)
    scene.vertices.emplace_back(scene.vertices[at(v)] + (high - low) * Vec3::UnitX());
  for (std::size_t f = 0; f < faces; ++f) {
    Face face = scene.faces[f];
    for (int& v : face.vertices) v += vertices;
    scene.faces.push_back(face);
  }
  return scene;
}

/// The faces of the wall between them.
std::array<int, 2> wall_faces(const Scene& scene) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const Vec3& p : scene.vertices) low = std::min(low, p.x()), high = std::max(high, p.x());
  std::vector<int> faces;
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f) {
    const std::vector<Vec3> corners = face_corners(scene, f);
    if (std::all_of(corners.begin(), corners.end(),
                    [&](const Vec3& p) { return p.x() == (low + high) / 2; }))
      faces.push_back(f);
  }
  return {faces.at(0), faces.at(1)};
}

/// Whether all of one lies before the other: they look at each other then.
bool is_inverted(const Scene& scene, const std::array<int, 2>& faces) {
  const auto lies_before = [&](int face, int other) {
    const PlaneFrame plane = fit_plane(face_corners(scene, other));
    const std::vector<Vec3> corners = face_corners(scene, face);
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Vec3& p) { return plane.height(p) > 0; });
  };
  return lies_before(faces[0], faces[1]) || lies_before(faces[1], faces[0]);
}

bool is_told(const std::vector<Warning>& warnings) {
  return std::any_of(warnings.begin(), warnings.end(), [](const Warning& warning) {
    return warning.kind == Warning::Kind::narrow_gaps;
  });
}

bool share_a_plane(const SoundScene& sound, int face, int other) {
  const auto plane_of = [&](int of) {
    const auto surface =
        std::find_if(sound.surfaces.begin(), sound.surfaces.end(), [&](const Surface& s) {
          return std::find(s.faces.begin(), s.faces.end(), of) != s.faces.end();
        });
    return surface == sound.surfaces.end() ? -1 : surface->plane;
  };
  return plane_of(face) == plane_of(other);
}

TEST(BackToBack, WallsThatAreInsideOutAreOnePlaneOrTold) {
  const Scene exact = two_furnaces();
  const std::array<int, 2> faces = wall_faces(exact);
  int told = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Scene rounded = test::with_own_corners(exact, 1e-7, seed);
    const SoundScene sound = make_sound(rounded);
    const bool is_one = share_a_plane(sound, faces[0], faces[1]);
    EXPECT_EQ(is_told(repair_warnings(rounded, sound)), is_inverted(rounded, faces) && !is_one)
        << seed;
    told += is_told(repair_warnings(rounded, sound));
  }
  EXPECT_GT(told, 0);
  EXPECT_LT(told, 20);
}

TEST(BackToBack, WallsThatCutThroughEachOtherLoseNoLight) {
  const Scene exact = two_furnaces();
  SolveOptions options;
  options.tolerance = 1e-2;
  for (std::uint64_t seed = 0; seed < 7; ++seed) {
    const Scene rounded = test::with_own_corners(exact, 1e-7, seed);
    ASSERT_FALSE(is_inverted(rounded, wall_faces(exact))) << seed;
    const SolveResult result = solve(rounded, options);
    EXPECT_EQ(result.not_reached, "") << seed;
    double square = 0, area = 0;
    for (int e = 0; e < result.elements.count(); ++e) {
      area += result.elements.area[at(e)];
      square += result.elements.area[at(e)] * std::pow(result.solution.irradiance(e, 0) - 1, 2);
    }
    EXPECT_LT(std::sqrt(square / area), 1e-2) << seed;
  }
}

}  // namespace
}  // namespace halfshade
