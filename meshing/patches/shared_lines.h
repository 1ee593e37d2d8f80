#pragma once

#include "meshing/core/sound_scene.h"

#include <vector>

namespace halfshade {

/// A ring edge or contact line of a surface.
struct BorderLine {
  int surface = 0;
  Segment2 ends;              ///< in the surface's frame
  int line = -1;              ///< the shared line it is a part of; −1: it lies on no other border
  double begin = 0, end = 0;  ///< where along the line its ends are
};

/// A straight line in space along which borders of several surfaces lie on each other.
struct SharedLine {
  Vec3 origin = Vec3::Zero(), direction = Vec3::UnitX();  ///< of unit length
  std::vector<int> borders;                               ///< sorted
  double length = 0;  ///< points closer than this along it are the same; as its surfaces have it
  double gap = 0;     ///< how far off it ends of its borders lie at most
  double extent = 0;  ///< from the first end of a border along it to the last
};

struct SharedLines {
  std::vector<BorderLine> borders;  ///< by surface: ring edges in their order, then contact lines
  std::vector<int> first_border;    ///< surface → its first border; one more at the end
  std::vector<SharedLine> lines;
};

/// Finds where borders of different surfaces lie on each other. Two do where they run along each
/// other for more than their tolerance's length and no farther apart than by what their surfaces'
/// planes may be off their corners. Those that do so directly or through others are of one line,
/// but where that would bring together borders of one surface, those that lie closer go first.
SharedLines find_shared_lines(const SoundScene& scene);

/// Where a point of a surface's frame lies along a line.
double along(const SharedLine& line, const PlaneFrame& frame, const Vec2& point);

}  // namespace halfshade
