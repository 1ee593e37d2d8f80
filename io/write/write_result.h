#pragma once

#include "io/files/extension.h"
#include "solver/pipeline/solve.h"

#include <filesystem>
#include <string>
#include <vector>

namespace halfshade {

/// What the files say about how they came about.
struct Provenance {
  std::string version;
  std::string command_line;
};

struct ResultOptions {
  bool linear = false;  ///< straight triangles also where .vtu could hold polynomials
};

inline constexpr FileFormats result_formats = {"results", {".vtu", ".vtp", ".ply"}};

/// Whether a file of that name holds straight triangles in place of polynomials.
bool holds_straight(const std::filesystem::path& path, const ResultOptions& options);

/// Writes a solved scene by extension: .vtu, .vtp (VTK XML, inline binary, compressed) or .ply.
/// Elements of order 2 and more are VTK's quadratic and Lagrange triangles in .vtu, with points of
/// their own, so that readers draw the polynomials themselves; in other files they are cut into
/// straight triangles (linear_result), whose errors are theirs: also with what they miss of the
/// polynomials.
/// VTK cell data: radiosity, irradiance, direct_irradiance, exitance, reflectance (3 components);
/// error_estimate, order, region (0 lit, 1 penumbra, 2 umbra, 3 no emitter above the horizon; left
/// out where direct light was not exact), regions (the same for each emitter, if asked for, in the
/// order of field data sources, surfaces' ids), face, group, material, surface, level, quality
/// (minimum angle in degrees); in .vtu with polynomials edge_order as in write_mesh (0 where light
/// may jump); where heat is given net_flux (radiosity − irradiance) and, where some are known,
/// temperature (K; NaN elsewhere). Point data: radiosity, irradiance. Light and reflectance have
/// components R, G, B. Field data, numbers only and the same for the same input: interrupted (0 or
/// 1), tolerance (of discontinuities), achieved_error (relative, in the L2 norm of the irradiance),
/// cameras (position, direction, up, vertical field of view in degrees) and camera_names (bytes,
/// each name ended by 0). Names and times are in the report. PLY: vertices with tone-mapped colours
/// and float radiosity_r/g/b; the exposure is in a comment. Throws Error(usage) for another
/// extension, Error(unwritable) if it cannot be written.
void write_result(const SolveResult& result, const Provenance& provenance,
                  const std::filesystem::path& path, const ResultOptions& options = {});

}  // namespace halfshade
