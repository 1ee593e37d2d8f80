#pragma once

#include "meshing/arrangement.h"
#include "meshing/core/plane_frame.h"
#include "meshing/repair.h"

#include <array>
#include <vector>

namespace halfshade {

/// A polygon of points as it looks in its plane's frame, counter-clockwise.
struct CoplanarFace {
  int face = 0;
  int material = 0;
  int group = 0;
  bool back = false;   ///< the back of a two-sided face
  bool emits = false;  ///< has exitance
  double area = 0;
  std::vector<int> loop;
};

/// A receiver whose coordinates are still points of the scene.
struct ReceiverDraft {
  int plane = 0;
  PlaneFrame frame;
  int material = 0;
  int group = 0;
  bool back = false;
  std::vector<std::vector<int>> rings;  ///< as in Receiver
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
  std::vector<ReceiverDraft> drafts;
  std::vector<CoveredPair> covered;
  std::vector<int> crossed;  ///< input faces that cross themselves
};

/// Joins faces that lie in one plane and look the same way into receivers, and gives what several
/// cover to one of them: to an emitter before others, to a smaller face before a larger. May add
/// points where boundaries cross.
CoplanarResult resolve_coplanar(std::vector<Vec3>& points, const PlaneFrame& frame,
                                const std::vector<CoplanarFace>& faces, const SnapRadii& snap);

}  // namespace halfshade
