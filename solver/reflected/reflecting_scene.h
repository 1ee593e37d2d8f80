#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/rays/visibility.h"
#include "solver/exchange/cells.h"
#include "solver/reflected/triangle_forest.h"

#include <cstdint>
#include <vector>

namespace halfshade {

/// A scene as few triangles, with what rays need to know of it: the roots of forests.
struct ReflectingScene {
  ElementTable roots;
  SpaceCells cells;
  std::vector<bool> two_sided;  ///< root → another surface lies back to back with it
  VisibilityIndex visibility;   ///< of the roots; owner = root
};

/// Cost: that of a mesh without a length, and n log n for n roots.
ReflectingScene make_reflecting_scene(const SoundScene& scene, const Progress& progress = {});

/// Where a ray meets the front of a triangle.
struct RayEnd {
  int triangle;
  float s, t;  ///< TrianglePlace

  TrianglePlace place() const { return {s, t}; }
};

/// Where rays start.
struct RayOrigin {
  Vec3 position, normal;
  int cell = -1;           ///< rays end in this cell only; −1: anywhere
  bool is_closed = false;  ///< no light leaves the cell
  int plane = -1;          ///< of the soup, that it lies in; −1: none
};

/// Rays over the hemisphere above a point, one in each of strata² parts of equal form factor:
/// points of a square, each alone in its cell and in its strata²-th of rows and of columns (Kensler
/// 2013), taken to the disc below the hemisphere (Shirley and Chiu 1997). Holds its buffers; one a
/// thread.
class HemisphereRays {
 public:
  explicit HemisphereRays(const ReflectingScene& scene) : scene_(&scene) {}

  /// Adds the ends on fronts of roots to `ends`, and returns the number of rays that an end is one
  /// of: backs and the open swallow. In a closed cell that is the number of ends, so that what
  /// rounding loses is made up for. The same for equal arguments.
  int cast(const RayOrigin& from, int strata, std::uint64_t seed, std::vector<RayEnd>& ends);

 private:
  bool find_other_side(const RayOrigin& from, std::size_t ray, Hit& hit) const;

  const ReflectingScene* scene_;
  std::vector<Vec3> directions_;
  std::vector<Hit> hits_;
};

/// A number in [0, 1) for each seed and place in its sequence.
double random_number(std::uint64_t seed, std::uint64_t place);

}  // namespace halfshade
