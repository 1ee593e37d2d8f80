#include "solver/direct/emitter_tree.h"

#include "meshing/repair/repair.h"
#include "solver/direct/ray_looks.h"
#include "tests/support/lamp_hall.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace halfshade {
namespace {

/// Lamps of two strengths over boxes that glow on all sides.
EmitterTree lamps() {
  Scene hall = test::lamp_hall(6);
  for (Face& face : hall.faces)
    if (hall.materials[at(face.material)].exitance.mean() == 0) face.material = test::white_light;
  const SoundScene scene = make_sound(hall);
  std::vector<RayEmitter> emitters;
  for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s) {
    const Material& material = scene.materials[at(scene.surfaces[at(s)].material)];
    if (material.exitance.mean() > 0) emitters.push_back(make_ray_emitter(scene, s));
  }
  return make_emitter_tree(std::move(emitters));
}

const EmitterTree& tree() {
  static const EmitterTree made = lamps();
  return made;
}

/// In and around the hall, looking anywhere.
std::vector<SurfacePoint> random_points(int count) {
  test::Random random(4);
  std::vector<SurfacePoint> points;
  while (static_cast<int>(points.size()) < count) {
    const Vec3 normal(random(-1, 1), random(-1, 1), random(-1, 1));
    if (normal.norm() < 0.1) continue;
    points.push_back({{random(-6, 18), random(-6, 18), random(-1, 5)}, normal.normalized()});
  }
  return points;
}

double light_of(const RayEmitter& emitter, const SurfacePoint& point) {
  return is_clearly_away(emitter.target, point)
             ? 0
             : exact_factor(point, emitter) * emitter.target.strength;
}

double light_below(int node, const SurfacePoint& point) {
  const FlatTree::Node& box = tree().tree.nodes[at(node)];
  double sum = 0;
  for (int i = box.first; i < box.first + box.count; ++i)
    sum += light_of(tree().emitters[at(tree().tree.items[at(i)])], point);
  return sum;
}

constexpr double rounding = 1 + 1e-9;

TEST(EmitterTree, BoundsWhatGroupsGive) {
  int told = 0;
  for (const SurfacePoint& point : random_points(100))
    for (int node = 0; node < static_cast<int>(tree().groups.size()); ++node) {
      const double most = most_light(tree(), node, point);
      EXPECT_GE(most * rounding + 1e-15, light_below(node, point));
      const int right = tree().tree.nodes[at(node)].right;
      if (right < 0 || std::isinf(most)) continue;
      EXPECT_GE(most * rounding,
                most_light(tree(), node + 1, point) + most_light(tree(), right, point));
      told += most < 2 * light_below(node, point);
    }
  EXPECT_GT(told, 100);  // bounds are of use
}

TEST(EmitterTree, DrawsThemRightInTheMean) {
  constexpr int draws = 4000;
  int told = 0;
  for (const SurfacePoint& point : random_points(300)) {
    const double most = most_light(tree(), 0, point), right = light_below(0, point);
    if (std::isinf(most) || !(right > 0.02 * most)) continue;
    ++told;
    double sum = 0, squares = 0;
    for (std::uint64_t k = 0; k < draws; ++k) {
      const DrawnEmitter drawn = draw_emitter(tree(), 0, point, k * 977);
      if (!drawn.emitter) continue;
      const double share = light_of(*drawn.emitter, point) / drawn.light;
      EXPECT_LE(share, rounding);  // a draw never counts for more than any other
      sum += share;
      squares += share * share;
    }
    const double mean = sum / draws, deviation = std::sqrt(squares) / draws;
    EXPECT_NEAR(mean * most, right, 5 * deviation * most);
  }
  EXPECT_GT(told, 10);
}

TEST(EmitterTree, VisitsEachEmitterOnceAndGroupsThatAreWeak) {
  for (const SurfacePoint& point : random_points(50)) {
    double all = 0, met = 0;
    for (const RayEmitter& emitter : tree().emitters) all += light_of(emitter, point);
    const double weak = 0.01 * all;
    std::set<const RayEmitter*> visited;
    std::size_t calls = 0;
    visit_emitters(
        tree(), point, weak,
        [&](const RayEmitter& emitter) {
          visited.insert(&emitter);
          met += light_of(emitter, point);
          ++calls;
        },
        [&](int node, double most) {
          EXPECT_LE(most, weak);
          met += light_below(node, point);
        });
    EXPECT_EQ(calls, visited.size());
    EXPECT_NEAR(met, all, 1e-9 * all);
  }
}

TEST(EmitterTree, FindsTheStrongest) {
  for (const SurfacePoint& point : random_points(200)) {
    double most = 0;
    for (const RayEmitter& emitter : tree().emitters)
      most = std::max(most, light_of(emitter, point));
    const RayEmitter* found = strongest_emitter(tree(), point);
    ASSERT_EQ(found != nullptr, most > 0);
    // Far ones are compared by rough form factors.
    if (found) {
      EXPECT_GE(light_of(*found, point), (1 - 2 * far_error) * most);
    }
  }
}

TEST(EmitterTree, OfNoneGivesNothing) {
  const EmitterTree none = make_emitter_tree({});
  EXPECT_EQ(strongest_emitter(none, {{0, 0, 0}, Vec3::UnitZ()}), nullptr);
}

}  // namespace
}  // namespace halfshade
