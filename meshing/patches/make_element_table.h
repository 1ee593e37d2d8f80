#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "meshing/patches/face_lookup.h"

#include <span>
#include <vector>

namespace halfshade {

struct ElementMesh;

/// What elements are labelled with.
struct SurfaceLabels {
  PlaneFrame frame;
  int group = 0, material = 0;
  FaceLookup faces;
};

/// One entry a surface.
std::vector<SurfaceLabels> surface_labels(const SoundScene& scene);

/// The elements in the order of ordered_faces, each starting at the corner that was made first.
ElementTable make_element_table(const ElementMesh& mesh, std::span<const SurfaceLabels> surfaces);

}  // namespace halfshade
