#pragma once

#include "tests/support/fitted_functions.h"
#include "tests/support/sound_scenes.h"

#include <cmath>

/// A square with functions on it that are smooth, singular at a corner, or broken along a line.
namespace halfshade::test {

/// The unit square in z = 0.
inline SoundScene square() {
  SoundScene scene = empty_sound_scene(std::sqrt(2.));
  add_surface(scene, {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}, 0);
  return scene;
}

/// A line across the square that no regular mesh follows.
inline const Vec3 line_start(0.313, 0, 0), line_end(0.647, 1, 0);
inline double distance_from_line(const Vec3& p) {
  const Vec3 along = (line_end - line_start).normalized();
  return along.cross(p - line_start).z();
}

/// The same square with elements along the line.
inline SoundScene square_with_line() {
  SoundScene scene = square();
  Surface& surface = scene.surfaces[0];
  surface.contacts.push_back(
      {surface.frame.to_plane(line_start), surface.frame.to_plane(line_end)});
  return scene;
}

inline double smooth(const Vec3& p) {
  return 1 + std::exp(p.x() - 0.7 * p.y()) * std::sin(2 * p.y());
}

/// Whose k-th derivative jumps at the line.
inline Function broken(int k) {
  return [k](const Vec3& p) {
    const double d = distance_from_line(p);
    return 2 + 0.3 * smooth(p) + (d > 0 ? std::pow(4 * d, k) : 0);
  };
}

inline double kinked(const Vec3& p) {
  return 0.5 + std::abs(distance_from_line(p)) + 0.2 * smooth(p);
}
inline double near_singular(const Vec3& p) { return std::sqrt(p.norm()) + 0.1; }
inline double jumping(const Vec3& p) { return broken(0)(p); }

/// Elements that stay as they are, all of that order.
inline AdaptiveFieldOptions fixed(int order) {
  AdaptiveFieldOptions options;
  options.tolerance = 1e6;
  options.order = order;
  options.split = false;
  return options;
}

}  // namespace halfshade::test
