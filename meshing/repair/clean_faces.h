#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/core/tolerance.h"
#include "meshing/repair/weld.h"

#include <vector>

namespace halfshade {

/// A planar polygon with an area: a face or, where that is not planar, a triangle of it.
struct FacePiece {
  int face = 0;
  std::vector<int> loop;  ///< points, counter-clockwise seen from the front
  LocalScale scale;       ///< its magnitude is that of all it hangs together with
};

/// The faces as planar polygons of welded points, by face: without repeated corners, spikes, faces
/// of no area and repeated faces. May add points. Says in `repairs` what it changed. Throws
/// Error(invalid_input) for a face without a sound interior.
std::vector<FacePiece> clean_faces(const Scene& scene, WeldedVertices& vertices,
                                   std::vector<Repair>& repairs);

/// Throws the Error for a face that crosses itself.
[[noreturn]] void reject_crossed_face(const Scene& scene, int face);

}  // namespace halfshade
