#include "solver/elements/material_arrays.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

TEST(MaterialArrays, HaveARowForEachElement) {
  SoundScene scene;
  scene.materials = {{"grey", Rgb(0.5, 0.4, 0.3), Rgb::Zero(), false},
                     {"lamp", Rgb(0.1, 0.2, 0.3), Rgb(9, 8, 7), false}};
  ElementTable elements;
  elements.corners.resize(3);
  elements.material = {1, 0, 1};
  const MaterialArrays arrays = material_arrays(scene, elements);
  ASSERT_EQ(arrays.rho.rows(), 3);
  for (int e = 0; e < 3; ++e) {
    const Material& material = scene.materials[at(elements.material[at(e)])];
    EXPECT_TRUE((arrays.rho.row(e).transpose() == material.rho).all());
    EXPECT_TRUE((arrays.exitance.row(e).transpose() == material.exitance).all());
  }
}

}  // namespace
}  // namespace halfshade
