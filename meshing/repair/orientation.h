#pragma once

#include "meshing/core/scene.h"

namespace halfshade {

/// Which way the faces of a scene are to look, before anything else is done with it.
struct SceneOptions {
  bool flip = false;    ///< reverse all faces
  bool orient = false;  ///< turn the faces of closed shells; see oriented. Before flip.
};

/// The scene with faces reversed as asked for.
///
/// Orienting: faces hang together where exactly two meet at an edge. They are made to look the same
/// way along these edges. Shells without any other edge are closed; one looks inwards if it
/// contains a light: if an emitting face of something else lies inside, or if some, but not all, of
/// its own faces emit. If there is no such shell, the largest looks inwards. All others look
/// outwards. What is not closed stays as it is. Cost: n log n for n faces, and a walk over the
/// closed shells' faces for each emitting face.
Scene oriented(Scene scene, const SceneOptions& options);

}  // namespace halfshade
