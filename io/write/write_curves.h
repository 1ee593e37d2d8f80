#pragma once

#include "io/write/write_result.h"
#include "meshing/discontinuity/discontinuity.h"

#include <filesystem>
#include <string>

namespace halfshade {

inline constexpr FileFormats curve_formats = {"curves", {".vtp"}};

struct CurveFileOptions {
  /// Largest distance of a polyline from its conic, as a share of the surface's size; > 0.
  double deviation = 1e-4;
};

/// Writes discontinuity curves as polylines in space (.vtp: VTK XML, inline binary, compressed),
/// one cell a curve, in the order of `found`, each seen from the front of its surface.
/// Cell data: kind (0 contact, 1 face, 2 ev, 3 eee, 4 horizon), order, emitter and receiver
/// (surfaces' ids as in the result files), emitter_group and group, jump (in the middle, of the
/// order-th derivative from right to left, W/m² per length^order), length, source_count, and of the
/// first source feature_kinds (0 emitter vertex, 1 emitter edge, 2 vertex, 3 edge, 4 face; 3
/// components, −1 where there is none) and feature_ids. Point data: jump. Field data: interrupted
/// (0 or 1). Jumps beyond the range of floats are cut off there. Throws Error(usage) for another
/// extension, Error(unwritable), and Error(contract) if a curve names a surface that does not
/// exist.
void write_curves(const SoundScene& scene, const Discontinuities& found,
                  const std::filesystem::path& path, const CurveFileOptions& options = {});

/// "contact", "face", "ev", "eee" or "horizon".
const char* name_of(CurveKind kind);

/// Jump at parameter s of the arc, from the parabola through the three samples; a sample's sign
/// holds up to the ends.
double jump_at(const DiscontinuityCurve& curve, double s);

}  // namespace halfshade
