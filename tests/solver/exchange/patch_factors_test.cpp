#include "solver/exchange/patch_factors.h"

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/exchange/form_factor.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <stop_token>

namespace halfshade {
namespace {

/// A cube as patches, and as elements that each patch has four of.
struct DividedCube {
  SoundScene scene =
      make_sound(test::room({1, 1, 1}, {{{.5, 1}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}, {.5, 0}}}));
  VisibilityIndex visibility = VisibilityIndex(occluders(scene));
  ElementTable patches, elements;

  DividedCube() {
    PatchMesh mesh(scene, {.max_length = 0.8});
    patches = mesh.elements();
    std::vector<int> all(patches.corners.size());
    for (std::size_t k = 0; k < all.size(); ++k) all[k] = static_cast<int>(k);
    mesh.split_in_four(all);
    elements = mesh.elements();
  }
  PatchFactors factors(FactorsBy by, const Progress& progress = {}) const {
    return patch_factors(scene, patches, elements, visibility,
                         {.factors = by, .hemicube_pixels = 100}, progress);
  }
};

TEST(PatchFactors, AreTheClosedFormsAtCentroidsInACube) {
  const DividedCube cube;
  const PatchFactors factors = cube.factors(FactorsBy::exact);
  ASSERT_EQ(factors.rows(), cube.elements.count());
  ASSERT_EQ(factors.cols(), cube.patches.count());
  for (int e = 0; e < cube.elements.count(); ++e) {
    const auto [a, b, c] = cube.elements.triangle(e);
    double sum = 0;
    for (int p = 0; p < cube.patches.count(); ++p) {
      const double expected =
          point_to_polygon((a + b + c) / 3, cube.elements.normal[at(e)], cube.patches.triangle(p));
      EXPECT_NEAR(factors.coeff(e, p), expected, 1e-12);
      sum += factors.coeff(e, p);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
  }
}

TEST(PatchFactors, ByHemicubesAreNearThem) {
  const DividedCube cube;
  const PatchFactors exact = cube.factors(FactorsBy::exact);
  const PatchFactors cubes = cube.factors(FactorsBy::hemicube);
  EXPECT_LT(PatchFactors(cubes - exact).norm(), 0.02 * exact.norm());
  EXPECT_GT(PatchFactors(cubes - exact).norm(), 1e-4 * exact.norm());
}

TEST(PatchFactors, AreNoneIfStopped) {
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(DividedCube().factors(FactorsBy::exact, {source.get_token(), {}}).rows(), 0);
}

}  // namespace
}  // namespace halfshade
