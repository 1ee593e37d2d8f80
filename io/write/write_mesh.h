#pragma once

#include "io/write/write_result.h"
#include "solver/pipeline/mesh_scene.h"

#include <filesystem>

namespace halfshade {

inline constexpr FileFormats mesh_formats = {"meshes", {".vtu", ".vtp", ".ply"}};

/// Writes a mesh that was not solved by extension, as write_result does: .vtu, .vtp or .ply. VTK
/// cell data: region (0 lit, 1 penumbra, 2 umbra, 3 away; of the emitter that is strongest there),
/// regions (the same for each source, one component each, in the order of field data `sources`,
/// surfaces' ids), exitance, reflectance, face, group, material, surface, level, quality (minimum
/// angle in degrees), edge_order (3 components: the lowest order of the curves along the edge from
/// corner k to k+1, −1 where there is none). Field data: interrupted, cameras and camera_names as
/// in write_result; sources, source_exitance (W/m²) and irradiance_tolerance (W/m²). PLY: vertices
/// in double precision, triangles with surface and region. Throws Error(usage) for another
/// extension, Error(unwritable) if it cannot be written, Error(contract) unless each element has a
/// label.
void write_mesh(const MeshResult& result, const Provenance& provenance,
                const std::filesystem::path& path);

}  // namespace halfshade
