#include "solver/pipeline/blockers.h"

#include "meshing/core/light_source.h"
#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

/// Of bodies that are looked at: it takes the square of it.
constexpr std::size_t most_faces_of_body = 1000;
/// Of the square of the light that all surfaces could get.
constexpr double unnoticed = 1e-14;

std::vector<Vec3> outline(const Surface& surface) {
  std::vector<Vec3> corners;
  for (const Vec2& p : surface.rings.front()) corners.push_back(surface.frame.to_space(p));
  return corners;
}

bool is_convex_polygon(const Surface& surface, double margin) {
  if (surface.rings.size() > 1) return false;
  const Ring& ring = surface.rings.front();
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 ahead = (ring[(k + 1) % ring.size()] - ring[k]).normalized();
    for (const Vec2& p : ring)
      if (cross_2d(ahead, p - ring[k]) < -margin) return false;
  }
  return true;
}

/// Whether another surface has an edge with the same ends.
bool is_shared(const SoundScene& scene, const std::vector<int>& surfaces, int own, const Vec3& a,
               const Vec3& b) {
  return std::any_of(surfaces.begin(), surfaces.end(), [&](int s) {
    const std::vector<Vec3> corners = outline(scene.surfaces[at(s)]);
    const double margin = tolerance_of(scene.surfaces[at(own)], scene.surfaces[at(s)]).length;
    const auto same = [&](const Vec3& p, const Vec3& q) { return (p - q).norm() <= margin; };
    for (std::size_t k = 0; s != own && k < corners.size(); ++k)
      if (same(corners[k], b) && same(corners[(k + 1) % corners.size()], a)) return true;
    return false;
  });
}

/// Whether there is some of `others` before a surface and some behind it. Most tell after a few
/// looks; only walls take all of them.
bool lies_between(const SoundScene& scene, const Surface& surface, const std::vector<int>& others) {
  bool has_before = false, has_behind = false;
  for (const int id : others) {
    const Surface& other = scene.surfaces[at(id)];
    const double margin = tolerance_of(surface, other).length;
    for (const Vec2& p : other.rings.front()) {
      const double height = surface.frame.height(other.frame.to_space(p));
      has_before = has_before || height > margin;
      has_behind = has_behind || height < -margin;
    }
    if (has_before && has_behind) return true;
  }
  return false;
}

std::vector<int> blocking_among(const SoundScene& scene, const std::vector<int>& ids) {
  std::vector<int> blocking;
  for (const int id : ids) {
    const Surface& surface = scene.surfaces[at(id)];
    if (!surface.back && lies_between(scene, surface, ids)) blocking.push_back(id);
  }
  return blocking;
}

/// Around a surface.
struct Ball {
  Vec3 centre = Vec3::Zero();
  double radius = 0;
};

Ball ball_around(const Surface& surface) {
  Ball ball;
  const std::vector<Vec3> corners = outline(surface);
  for (const Vec3& p : corners) ball.centre += p / static_cast<double>(corners.size());
  for (const Vec3& p : corners) ball.radius = std::max(ball.radius, (p - ball.centre).norm());
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
      const double share = area(scene.surfaces[at(source.surface)]) / (M_PI * distance * distance);
      here = std::max(here, source.exitance * (distance > 0 ? std::min(share, 1.) : 1.));
    }
    most.push_back(here);
  }
  return most;
}

}  // namespace

std::vector<int> blocking_surfaces(const SoundScene& scene) {
  std::vector<int> all(scene.surfaces.size());
  std::iota(all.begin(), all.end(), 0);
  return blocking_among(scene, all);
}

std::vector<int> blocking_in_the_light(const SoundScene& scene) {
  const std::vector<double> light = most_light(scene);
  const double brightest = *std::max_element(light.begin(), light.end());
  if (!(brightest > 0)) return blocking_surfaces(scene);
  const auto square = [&](std::size_t s) {
    return area(scene.surfaces[s]) * std::pow(light[s] / brightest, 2);
  };
  double all = 0;
  for (std::size_t s = 0; s < light.size(); ++s) all += square(s);
  std::vector<int> ids;
  for (std::size_t s = 0; s < light.size(); ++s)
    if (square(s) > unnoticed * all) ids.push_back(static_cast<int>(s));
  return blocking_among(scene, ids);
}

bool is_one_convex_body(const SoundScene& scene, const std::vector<int>& surfaces) {
  const auto is_convex = [&](int r) {
    const Surface& surface = scene.surfaces[at(r)];
    return is_convex_polygon(surface, tolerance_of(surface).length);
  };
  if (!std::all_of(surfaces.begin(), surfaces.end(), is_convex)) return false;
  if (surfaces.size() <= 1) return true;
  if (surfaces.size() > most_faces_of_body) return false;
  for (const int r : surfaces) {
    const std::vector<Vec3> corners = outline(scene.surfaces[at(r)]);
    for (std::size_t k = 0; k < corners.size(); ++k)
      if (!is_shared(scene, surfaces, r, corners[k], corners[(k + 1) % corners.size()]))
        return false;
    for (const int s : surfaces) {
      const double margin = tolerance_of(scene.surfaces[at(r)], scene.surfaces[at(s)]).length;
      for (const Vec3& p : outline(scene.surfaces[at(s)]))
        if (scene.surfaces[at(r)].frame.height(p) > margin) return false;
    }
  }
  return true;
}

}  // namespace halfshade
