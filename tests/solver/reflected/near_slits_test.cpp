#include "solver/reflected/near_slits.h"

#include "meshing/repair/repair.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

// A long ceiling between two upright walls whose tops are a gap below its edges. At a distance x
// from an edge (1 − x / √(x² + g²)) / 2 of the hemisphere is seen through the slit.

namespace halfshade {
namespace {

constexpr double far = 30;

/// Two walls, `far` long and high, and the ceiling.
Scene box_below_a_ceiling(double gap) {
  Scene scene;
  const int white = test::add_material(scene, 0.99, 0);
  const auto wall = [&](const Vec3& a, const Vec3& b) {
    const Vec3 down(0, 0, -far);
    test::add_polygon(scene, {a, b, b + down, a + down}, white);
  };
  test::add_polygon(scene, {{-far, 0, 0}, {-far, 1, 0}, {far, 1, 0}, {far, 0, 0}}, white);
  wall({-far, 0, -gap}, {far, 0, -gap});
  wall({far, 1, -gap}, {-far, 1, -gap});
  return scene;
}

/// ∫ ω (ω − ω₀) over a strip from the edge inwards, for each unit of length and of the gap, where
/// ω₀ is seen without a gap, all but the open bottom, and ω = ω₀ − d, d = (1 − t / √(1 + t²)) / 2:
/// ∫ d dt is ½, and ∫ d² dt is ½ − π / 8.
constexpr double missed_of_gap = -((1 - 0.5 / far) * 0.5 - (0.5 - M_PI / 8));

/// ω. Of a scene without a gap: what is missed beside that is all that a slit takes.
Eigen::VectorXd seen_at_nodes(const ExactSight& sight, const ReflectedMesh& mesh, int element,
                              const Vec3& normal, const std::vector<Sighted>& targets) {
  const auto& places = element_nodes_of(mesh.order[at(mesh.triangle[at(element)])]).places;
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(places.size()));
  SeenPart part;
  for (std::size_t n = 0; n < places.size(); ++n)
    for (const Sighted& target : targets) {
      sight.see({mesh.position(element, places[n]), normal}, target, part);
      sums[static_cast<Eigen::Index>(n)] += part.factor;
    }
  return sums;
}

TEST(NearSlits, WhatIsMissedAlongAnEdgeIsKnown) {
  for (const double gap : {1e-4, 5e-5}) {
    const SoundScene scene = make_sound(box_below_a_ceiling(gap));
    const ReflectingScene reflecting = make_reflecting_scene(scene);
    const ExactSight sight(scene, reflecting);
    const SoundScene tight = make_sound(box_below_a_ceiling(0));
    const ReflectingScene tight_reflecting = make_reflecting_scene(tight);
    const ExactSight without_gap(tight, tight_reflecting);
    const ReflectedMesh mesh = make_reflected_mesh(reflecting.roots, 0.5, 2, 100000);
    double missed = 0, length = 0;
    for (int e = 0; e < mesh.count(); ++e) {
      const int root = mesh.root(e);
      const auto& corners = mesh.forest.corners(mesh.triangle[at(e)]);
      const auto is_middle = [](const Vec3& p) { return std::abs(p.x()) < 6; };
      if (!is_middle(corners[0]) || corners[0].z() != 0 || corners[1].z() != 0) continue;
      const std::vector<Sighted> targets = sight.may_see(corners, root);
      const Vec3& normal = reflecting.roots.normal[at(root)];
      const BackShadow shadow = slit_shadow({sight, mesh, e, normal, targets},
                                            seen_at_nodes(without_gap, mesh, e, normal, targets));
      missed += mesh.area(e) * shadow.share;
      for (std::size_t k = 0; k < 3; ++k)
        if (const Vec3& a = corners[k], &b = corners[(k + 1) % 3];
            a.y() == b.y() && (a.y() == 0 || a.y() == 1))
          length += (b - a).norm();
    }
    ASSERT_GT(length, 10);
    EXPECT_NEAR(missed / (length * gap), missed_of_gap, 0.02 * std::abs(missed_of_gap)) << gap;
  }
}

}  // namespace
}  // namespace halfshade
