#pragma once

#include "io/write/write_result.h"
#include "solver/pipeline/mesh_scene.h"

#include <filesystem>
#include <vector>

namespace halfshade {

/// Writes what a program may want to know of a run as one JSON object: version, command_line, unit,
/// scene (counts), repairs, warnings (kind and sentence), discontinuities (how they were found,
/// kept and culled), mesh (elements, points, min_angle and a histogram of the elements' minimum
/// angles), stages, exchange, radiosity (per channel), interrupted, estimated_relative_error,
/// outputs, and groups (area, mean radiosity and irradiance, emitted and absorbed power of each).
/// Faces, materials and groups count from 0, as in the arrays of the result files. Throws
/// Error(unwritable).
void write_report(const SolveResult& result, const Provenance& provenance,
                  const std::vector<std::filesystem::path>& outputs,
                  const std::filesystem::path& path);

/// Writes as one JSON object: version, command_line, unit, interrupted, scene, repairs, warnings,
/// sources, curves (total, by kind and order, with lengths), search (how they were found), mesh
/// (elements, points, angles, kept and culled curves, deviation, …; area_quality: shares of the
/// area by smallest angle, and which share of what is not at an input angle has at least 20.7
/// (good) and 1 degree (tolerable); irradiance_tolerance in W/m²), stages, outputs. Throws
/// Error(unwritable).
void write_report(const MeshResult& result, const Provenance& provenance,
                  const std::vector<std::filesystem::path>& outputs,
                  const std::filesystem::path& path);

/// How a probe went.
struct ProbeReport {
  std::size_t points = 0, points_done = 0;  ///< fewer if interrupted
  bool direct_only = false;                 ///< no interreflection
  double seconds = 0;
};

/// Writes version, command_line, points, points_done, direct_only, seconds, interrupted, outputs.
/// Throws Error(unwritable).
void write_report(const ProbeReport& report, const Provenance& provenance,
                  const std::vector<std::filesystem::path>& outputs,
                  const std::filesystem::path& path);

}  // namespace halfshade
