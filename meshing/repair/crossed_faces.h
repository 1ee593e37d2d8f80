#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/repair/face_piece.h"
#include "meshing/repair/weld.h"

#include <span>
#include <vector>

namespace halfshade {

/// Triangles in the place of a face that crosses itself. In one plane, they fill what its boundary
/// goes round, and each looks to the side from which that is gone round counter-clockwise: the two
/// parts of a bow tie look opposite ways. Else they are those between its corners that fold least,
/// or, of very many corners, the same as if it lay in one plane. May add points. Says in `repairs`
/// what became of the face.
std::vector<FacePiece> split_crossed_face(const FacePiece& face, WeldedVertices& vertices,
                                          std::vector<Repair>& repairs);

/// The same for all pieces of some faces, in their place. `crossed`: input faces, sorted.
std::vector<FacePiece> with_crossed_faces_split(std::vector<FacePiece> pieces,
                                                std::span<const int> crossed,
                                                WeldedVertices& vertices,
                                                std::vector<Repair>& repairs);

}  // namespace halfshade
