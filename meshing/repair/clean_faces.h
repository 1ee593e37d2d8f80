#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/repair/face_piece.h"
#include "meshing/repair/weld.h"

#include <vector>

namespace halfshade {

/// The faces as planar polygons of welded points, by face: without repeated corners, spikes, faces
/// of no area and repeated faces. May add points. Says in `repairs` what it changed. Of faces that
/// cross themselves, those in one plane whose parts do not cancel are left as they are.
std::vector<FacePiece> clean_faces(const Scene& scene, WeldedVertices& vertices,
                                   std::vector<Repair>& repairs);

}  // namespace halfshade
