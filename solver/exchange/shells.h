#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"

#include <array>
#include <vector>

namespace halfshade {

/// Sets of things numbered from 0, which may be joined.
class JoinedSets {
 public:
  explicit JoinedSets(int count);
  void join(int a, int b);
  /// Thing → its set, numbered in the order of their first things.
  std::vector<int> numbered();

 private:
  int root(int a);
  std::vector<int> parent_;
};

/// Sides of elements that hang together without any gap: one goes from a side to the next round the
/// edges, never through a surface.
struct Shells {
  std::vector<std::array<int, 2>> of_side;  ///< element → shell of its front, of its back
  int count = 0;
};

/// Elements meet where edges have the same ends, bit for bit. Round an edge they follow each other
/// by angle. Of those that cover each other in one plane, each looks away from the other, for that
/// is what sees past each other.
Shells find_shells(const SoundScene& scene, const ElementTable& elements);

}  // namespace halfshade
