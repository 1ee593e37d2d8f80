#pragma once

#include "meshing/box_tree.h"
#include "meshing/repair.h"

namespace halfshade {

/// Finds the input face that a place on a receiver belongs to.
class FaceLookup {
 public:
  explicit FaceLookup(const Receiver& receiver);

  /// The first face of the receiver that holds the point; the nearest one if rounding puts the
  /// point outside of all.
  int face_at(const Vec2& point) const;

 private:
  std::vector<int> faces_;
  std::vector<Ring> rings_;
  BoxTree tree_;
};

}  // namespace halfshade
