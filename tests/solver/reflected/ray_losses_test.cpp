#include "solver/reflected/ray_losses.h"

#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace halfshade {
namespace {

/// Elements of a box with a lifted lid, all of them in one open system.
struct OpenBox {
  OpenBox(double gap, double rho)
      : sound(make_sound(test::box_with_a_lifted_lid(gap, rho))),
        reflecting(make_reflecting_scene(sound)),
        light(first_light(
            sound, reflecting.roots, [](int, const Vec3&) { return Rgb(Rgb::Zero()); }, false)),
        mesh(make_reflected_mesh(reflecting.roots, 0.4, 2, 10000)) {
    systems.of_element.assign(at(mesh.count()), 0);
    systems.closed = {false};
    systems.area = Eigen::ArrayXd::Constant(1, 6);
  }

  /// By nodes that see nothing of the slit.
  RayLosses losses(double enough) const {
    std::vector<Eigen::VectorXd> told;
    for (const int t : mesh.triangle) {
      told.push_back(Eigen::VectorXd::Zero(element_nodes_of(mesh.order[at(t)]).fit.rows()));
      told.back()[0] = 1;
    }
    return find_losses(reflecting, light, mesh, systems, told,
                       std::vector<double>(told.size(), 100), enough, {});
  }

  SoundScene sound;
  ReflectingScene reflecting;
  FirstLight light;
  ReflectedMesh mesh;
  LightSystems systems;
};

TEST(RayLosses, AreThoseOfASlit) {
  const double gap = 0.01;
  const OpenBox box(gap, 0.999);
  const RayLosses losses = box.losses(0.003);
  double missed = 0, marked = 0;
  for (int e = 0; e < box.mesh.count(); ++e) {
    missed += box.mesh.area(e) * (1 - losses.seen[at(e)][0]);
    ASSERT_TRUE(losses.shadow[at(e)]);
    marked -= box.mesh.area(e) * losses.shadow[at(e)]->share;
  }
  // To first order in the gap, of what leaves evenly a half gets out for each unit of the slit's
  // area from below. Of the lid, which sees less than all there, ∫ ω (1 − ω) = π / 8.
  const double expected = 4 * gap * (0.5 + M_PI / 8);
  EXPECT_NEAR(missed, expected, 2 * gap * expected + 6 * losses.unsure[0]);
  // What is marked is not noise, but may leave out what may be.
  EXPECT_NEAR(marked, expected, 0.1 * expected);
  EXPECT_LE(6 * losses.unsure[0], 0.01 * expected);
}

TEST(RayLosses, AreNotLookedForWhereLittleComesBack) {
  const OpenBox box(0.01, 0.5);
  const RayLosses losses = box.losses(0.003);
  EXPECT_EQ(losses.rays, 0u);
  for (int e = 0; e < box.mesh.count(); ++e) {
    EXPECT_FALSE(losses.shadow[at(e)]);
    EXPECT_EQ(losses.seen[at(e)][0], 1);
    // Of as many rays as all nodes have, three.
    EXPECT_DOUBLE_EQ(losses.unsure[at(e)], 3 / (100. * box.mesh.count()));
  }
}

TEST(RayLosses, TakeMoreRaysToKnowMore) {
  const OpenBox box(0.03, 0.99);
  const RayLosses rough = box.losses(0.02), fine = box.losses(0.002);
  EXPECT_GT(fine.rays, 4 * rough.rays);
  EXPECT_LT(fine.unsure[0], rough.unsure[0] / 2);
}

}  // namespace
}  // namespace halfshade
