#pragma once

#include "io/picture/value_picture.h"
#include "io/write/run_info.h"
#include "solver/pipeline/mesh_scene.h"

#include <filesystem>
#include <vector>

namespace halfshade {

/// Writes what a program may want to know of a run as one JSON object: version, command_line,
/// status, seconds, peak_memory_bytes, unit, units (what lengths, areas and powers are in where
/// keys do not say so), scene (counts and names), repairs, warnings (kind and
/// sentence), discontinuities (how they were found, kept and culled), mesh (elements, points,
/// min_angle_degrees and a histogram of the elements' minimum angles), stages, exchange, radiosity
/// (per channel), interrupted, estimated_relative_error (of what files hold), straight_triangles
/// (how many, and what they add to the error), if polynomials were cut, outputs, and groups (area,
/// mean radiosity and irradiance, emitted and absorbed power of each, powers in W/m² times the
/// square of the unit of length; the same in area_m2, emitted_power_w, absorbed_power_w if it is
/// known how many metres that is); bounces (mean irradiance after each number of reflections), if
/// told apart; where heat is given net_exchange (bands, unit_m, surroundings_temperature_k,
/// surroundings_net_power_w, and area_m2, net_flux_w_per_m2, net_power_w, temperature_k of each
/// group: SI units, what leaves net counts positive). Lists of channels have one entry where all
/// three are equal, and in net_exchange one for each band. Faces count from 1, as in sentences;
/// surfaces and elements from 0, as in the arrays of the result files. Throws Error(unwritable).
void write_report(const SolveResult& result, const RunInfo& run, const std::filesystem::path& path);

/// Writes the same of a mesh, with sources, curves (total, by kind and order, with lengths), search
/// (how they were found) and mesh (elements, points, angles, kept and culled curves, deviation, …;
/// area_quality: shares of the area by smallest angle, and which share of what is not at an input
/// angle has at least 20.7 (good) and 1 degree (tolerable); irradiance_tolerance_w_per_m2).
/// Throws Error(unwritable).
void write_report(const MeshResult& result, const RunInfo& run, const std::filesystem::path& path);

/// How a probe went.
struct ProbeReport {
  std::size_t points = 0, points_done = 0;  ///< fewer if interrupted
  bool direct_only = false;                 ///< no interreflection
};

/// Writes what every report begins with, points, points_done, direct_only, interrupted, outputs.
/// Throws Error(unwritable).
void write_report(const ProbeReport& report, const RunInfo& run, const std::filesystem::path& path);

/// How a study went.
struct StudyReport {
  std::size_t cases = 0;
  bool complete = true;
};

/// Writes what every report begins with, cases, interrupted, outputs. Throws Error(unwritable).
void write_report(const StudyReport& report, const RunInfo& run, const std::filesystem::path& path);

/// How a picture was drawn.
struct RenderReport {
  int width = 0, height = 0;  ///< pixels
  double exposure = 0;        ///< factor from W/m² to display values; 0: there is none
  Camera camera;
  Quantity quantity;                         ///< in false colours; without a name: none
  ValueRange range;                          ///< of it
  std::optional<SeenDifference> difference;  ///< of two results
  int samples = 0;            ///< of each pixel, by random rays; 0: it was drawn otherwise
  double standard_error = 0;  ///< of pixels, relative, in the mean square
};

/// Writes what every report begins with, width, height, camera, outputs; exposure; with false
/// colours quantity, range and difference; of random rays samples and relative_standard_error.
/// Throws Error(unwritable).
void write_report(const RenderReport& report, const RunInfo& run,
                  const std::filesystem::path& path);

}  // namespace halfshade
