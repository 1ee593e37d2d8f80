#pragma once

#include "meshing/arrangement/arrangement.h"
#include "meshing/core/plane_frame.h"
#include "meshing/core/sound_scene.h"
#include "meshing/core/tolerance.h"

#include <array>
#include <vector>

namespace halfshade {

/// A polygon of points as it looks in its plane's frame, counter-clockwise.
struct CoplanarFace {
  int face = 0;
  int material = 0;
  int group = 0;
  int paint = -1;
  bool back = false;   ///< the back of a two-sided face
  bool emits = false;  ///< has exitance
  double area = 0;
  LocalScale scale;
  std::vector<int> loop;
};

/// A surface whose coordinates are still points of the scene.
struct SurfaceDraft {
  int plane = 0;
  PlaneFrame frame;
  int material = 0;
  int group = 0;
  int paint = -1;
  bool back = false;
  LocalScale scale;                     ///< of its outer ring
  std::vector<std::vector<int>> rings;  ///< as in Surface
  std::vector<int> faces;
  std::vector<std::vector<int>> face_rings;
  std::vector<std::array<int, 2>> contacts;
};

/// Two faces that cover each other: the first keeps the common part.
struct CoveredPair {
  int keeper = 0, loser = 0;  ///< input faces
  bool backs = false;         ///< seen between backs of two-sided faces only
  double area = 0;            ///< squared scene units
};

struct CoplanarResult {
  std::vector<SurfaceDraft> drafts;
  std::vector<CoveredPair> covered;
  std::vector<int> crossed;  ///< input faces that cross themselves
};

/// Joins faces that lie in one plane and look the same way into surfaces, and gives what several
/// cover to one of them: to an emitter before others, to a smaller face before a larger. May add
/// points where boundaries cross. What counts as touching follows from the scale of the faces.
CoplanarResult resolve_coplanar(std::vector<Vec3>& points, const PlaneFrame& frame,
                                const std::vector<CoplanarFace>& faces);

}  // namespace halfshade
