#pragma once

#include "meshing/geometry/flat_tree.h"

#include <span>
#include <vector>

namespace halfshade {

struct SightShaft;

/// What may come between an emitter and any of a few points.
struct SightCandidates {
  std::vector<int> nodes;  ///< of OpaqueScene::face_tree; all faces below them
};

/// Narrows candidates down to those in a shaft, as far as that is worth it. Keeps its buffers.
class CandidateSearch {
 public:
  void narrow(const FlatTree& faces, const SightShaft& shaft, const SightCandidates& from,
              SightCandidates& to);

 private:
  struct Open {
    int node;
    bool is_inside;  ///< known to reach into the shaft
  };
  std::vector<Open> open_, next_;
};

/// The whole tree.
SightCandidates all_candidates(const FlatTree& faces);

}  // namespace halfshade
