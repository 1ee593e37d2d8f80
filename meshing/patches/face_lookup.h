#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/geometry/flat_tree.h"

namespace halfshade {

/// Finds the input face that a place on a surface belongs to.
class FaceLookup {
 public:
  explicit FaceLookup(const Surface& surface);

  /// The first face of the surface that holds the point; the nearest one if rounding puts the
  /// point outside of all.
  int face_at(const Vec2& point) const;

 private:
  std::vector<int> faces_;
  std::vector<Ring> rings_;
  FlatTree tree_;
};

}  // namespace halfshade
