#include "solver/pipeline/lit_surfaces.h"

#include "meshing/core/light_source.h"
#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace halfshade {
namespace {

/// Around a surface.
struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

Ball ball_around(const Surface& surface) {
  Ball ball;
  const Ring& ring = surface.rings.front();
  for (const Vec2& q : ring)
    ball.centre += surface.frame.to_space(q) / static_cast<double>(ring.size());
  for (const Vec2& q : ring)
    ball.radius = std::max(ball.radius, (surface.frame.to_space(q) - ball.centre).norm());
  return ball;
}

/// What the emitter that gives most can give to each surface, W/m².
std::vector<double> most_light(const SoundScene& scene) {
  const std::vector<LightSource> sources = light_sources(scene);
  std::vector<Ball> balls;
  for (const Surface& surface : scene.surfaces) balls.push_back(ball_around(surface));
  std::vector<double> most;
  for (const Ball& ball : balls) {
    double here = 0;
    for (const LightSource& source : sources) {
      const Ball& lamp = balls[at(source.surface)];
      const double distance = (ball.centre - lamp.centre).norm() - ball.radius - lamp.radius;
      const double factor =
          area(scene.surfaces[at(source.surface)]) / (std::numbers::pi * distance * distance);
      here = std::max(here, source.exitance * (distance > 0 ? std::min(factor, 1.) : 1.));
    }
    most.push_back(here);
  }
  return most;
}

}  // namespace

std::vector<int> lit_surfaces(const SoundScene& scene, double share) {
  const std::vector<double> light = most_light(scene);
  const double brightest = *std::max_element(light.begin(), light.end());
  std::vector<int> ids(light.size());
  std::iota(ids.begin(), ids.end(), 0);
  if (!(brightest > 0)) return ids;
  const auto square = [&](int s) {
    return area(scene.surfaces[at(s)]) * std::pow(light[at(s)] / brightest, 2);
  };
  double all = 0;
  for (const int s : ids) all += square(s);
  std::erase_if(ids, [&](int s) { return square(s) <= share * share * all; });
  return ids;
}

std::vector<bool> mark_surfaces(const SoundScene& scene, std::span<const int> ids) {
  std::vector<bool> marks(scene.surfaces.size(), false);
  for (const int id : ids) marks[at(id)] = true;
  return marks;
}

}  // namespace halfshade
