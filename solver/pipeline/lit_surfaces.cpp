#include "solver/pipeline/lit_surfaces.h"

#include "meshing/core/light_source.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/ball.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace halfshade {
namespace {

/// Times the area of all that light reaches: emitters that light themselves only, and are larger,
/// are suns.
constexpr double far_larger = 30;

Ball ball_around(const Surface& surface) {
  Ball ball;
  const Ring& ring = surface.rings.front();
  for (const Vec2& q : ring)
    ball.centre += surface.frame.to_space(q) / static_cast<double>(ring.size());
  for (const Vec2& q : ring)
    ball.radius = std::max(ball.radius, (surface.frame.to_space(q) - ball.centre).norm());
  return ball;
}

/// Whether some of the outline lies before a plane.
bool reaches_before(const Surface& surface, const Surface& plane) {
  const Ring& ring = surface.rings.front();
  const double least = tolerance_of(surface, plane).length;
  return std::any_of(ring.begin(), ring.end(), [&](const Vec2& q) {
    return plane.frame.height(surface.frame.to_space(q)) > least;
  });
}

/// ∫ H² that the emitter which gives most can make on each surface, for the strongest exitance 1.
/// Emitters have to see others for that; all else gets light that was reflected, too.
std::vector<double> most_light(const SoundScene& scene, std::span<const LightSource> sources) {
  std::vector<bool> emits(scene.surfaces.size(), false);
  double strongest = 0;
  for (const LightSource& source : sources) {
    emits[at(source.surface)] = true;
    strongest = std::max(strongest, source.exitance);
  }
  std::vector<Ball> balls;
  for (const Surface& surface : scene.surfaces) balls.push_back(ball_around(surface));
  std::vector<double> most;
  for (std::size_t s = 0; s < balls.size(); ++s) {
    const Surface& surface = scene.surfaces[s];
    const double own = area(surface);
    double here = 0;
    for (const LightSource& source : sources) {
      const Surface& emitter = scene.surfaces[at(source.surface)];
      const Ball& lamp = balls[at(source.surface)];
      const double distance =
          (balls[s].centre - lamp.centre).norm() - balls[s].radius - lamp.radius;
      const double lamp_area = area(emitter), exitance = source.exitance / strongest;
      const double factor = lamp_area / (std::numbers::pi * distance * distance);
      const double light = exitance * (distance > 0 ? std::min(factor, 1.) : 1.);
      // No more power arrives than is sent out.
      const double square = light * std::min(own * light, lamp_area * exitance);
      if (square > here &&
          (!emits[s] || (reaches_before(surface, emitter) && reaches_before(emitter, surface))))
        here = square;
    }
    most.push_back(here);
  }
  return most;
}

}  // namespace

std::vector<int> lit_surfaces(const SoundScene& scene, double share) {
  const std::vector<LightSource> sources = light_sources(scene);
  const std::vector<double> squares = most_light(scene, sources);
  const double all = std::accumulate(squares.begin(), squares.end(), 0.);
  std::vector<int> ids(squares.size());
  std::iota(ids.begin(), ids.end(), 0);
  if (!(all > 0)) return ids;
  std::erase_if(ids, [&](int s) { return squares[at(s)] <= share * share * all; });
  double lit_area = 0;
  for (const int s : ids) lit_area += area(scene.surfaces[at(s)]);
  for (const LightSource& source : sources)
    if (squares[at(source.surface)] == 0 &&
        area(scene.surfaces[at(source.surface)]) < far_larger * lit_area)
      ids.push_back(source.surface);
  std::sort(ids.begin(), ids.end());
  return ids;
}

std::vector<bool> mark_surfaces(const SoundScene& scene, std::span<const int> ids) {
  std::vector<bool> marks(scene.surfaces.size(), false);
  for (const int id : ids) marks[at(id)] = true;
  return marks;
}

}  // namespace halfshade
