#pragma once

#include "io/write/write_result.h"
#include "solver/pipeline/mesh_scene.h"

#include <filesystem>
#include <vector>

namespace halfshade {

/// Writes a mesh that was not solved by extension, as write_result does: .vtu, .vtp or .ply. VTK
/// cell data: region (0 lit, 1 penumbra, 2 umbra, 3 away; of the emitter that is strongest there),
/// regions (the same for each source, one component each, in the order of field data `sources`,
/// surface ids), exitance, reflectance, face, group, material, surface, level, quality (minimum
/// angle in degrees), edge_order (3 components: the lowest order of the curves along the edge from
/// corner k to k+1, −1 where there is none). Field data as write_result, and irradiance_tolerance.
/// PLY: vertices in double precision, triangles with surface
/// and region. Throws Error(usage) for another extension, Error(unwritable) if it cannot be
/// written, Error(contract) unless there is a label for each element.
void write_mesh(const MeshResult& result, const Provenance& provenance,
                const std::filesystem::path& path);

/// Writes as one JSON object: version, command_line, unit, interrupted, scene, repairs, sources,
/// curves (total, by kind and order, with lengths), search (how they were found), mesh (elements,
/// points, angles, kept and culled curves, deviation, …; area_quality: shares of the area by
/// smallest angle, and which share of what is not at an input angle has at least 20.7 (good) and 1
/// degree (tolerable)), stages, outputs. Throws
/// Error(unwritable).
void write_report(const MeshResult& result, const Provenance& provenance,
                  const std::vector<std::filesystem::path>& outputs,
                  const std::filesystem::path& path);

}  // namespace halfshade
