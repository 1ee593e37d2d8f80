#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// A ring edge or contact line of a surface.
struct Wall {
  int surface = 0;
  Segment2 ends;              ///< in the surface's frame
  int line = -1;              ///< the shared line it is a part of; −1: it lies on no other wall
  double begin = 0, end = 0;  ///< where along the line its ends are
};

/// A straight line in space along which walls of several surfaces lie on each other.
struct SharedLine {
  Vec3 origin = Vec3::Zero(), direction = Vec3::UnitX();  ///< of unit length
  std::vector<int> walls;                                 ///< sorted
};

struct SharedLines {
  std::vector<Wall> walls;      ///< by surface: ring edges in their order, then contact lines
  std::vector<int> first_wall;  ///< surface → its first wall; one more at the end
  std::vector<SharedLine> lines;
};

/// Finds where walls of different surfaces lie on each other. Two do where they run along each
/// other for more than the tolerance's length and no farther apart than by what their surfaces'
/// planes may be off their corners. Walls that do so directly or through others are of one line,
/// but where that would bring together walls of one surface, those that lie closer go first.
SharedLines find_shared_lines(const SoundScene& scene);

/// Where a point of a surface's frame lies along a line.
double along(const SharedLine& line, const PlaneFrame& frame, const Vec2& point);

}  // namespace halfshade
