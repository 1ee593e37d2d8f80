#pragma once

#include "tests/support/sound_scenes.h"

#include <array>
#include <vector>

/// Scenes here are of a few units, with floors in z = 0 whose limits are uneven, so that no line is
/// where a regular mesh has one.
namespace halfshade::test {

/// Materials of all scenes here.
enum : int { grey = 0, white_light = 1, bright_light = 2, two_sided_grey = 3 };

/// Collects polygons.
class SceneMaker {
 public:
  SceneMaker();

  SceneMaker& polygon(const std::vector<Vec3>& corners, int material = grey);
  /// x0…x1 × y0…y1 at height z, looking up or down.
  SceneMaker& up(const Vec2& low, const Vec2& high, double z, int material = grey);
  SceneMaker& down(const Vec2& low, const Vec2& high, double z, int material = grey);
  SceneMaker& box(const Vec3& low, const Vec3& high);
  /// The same without its bottom, to stand on something.
  SceneMaker& standing_box(const Vec3& low, const Vec3& high);
  /// Turned about the vertical through its middle.
  SceneMaker& turned_box(const Vec3& low, const Vec3& high, double angle);
  SceneMaker& tetrahedron(const std::array<Vec3, 4>& p);
  SceneMaker& square_light(double z = 2, int material = white_light);
  SceneMaker& floor();
  SceneMaker& move(const Vec3& by);
  /// What the repair makes of it.
  SoundScene sound() const;

  Scene scene;
};

}  // namespace halfshade::test
