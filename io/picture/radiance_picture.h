#pragma once

#include "io/picture/picture.h"

#include <filesystem>
#include <vector>

namespace halfshade {

/// Light as it is, before any exposure.
struct RadiancePicture {
  int width = 0, height = 0;
  std::vector<Rgb> radiance;  ///< W/(m² sr), top row first; 0 where nothing is seen
};

/// Draws a mesh that carries radiosity B: its radiance is B/π, each pixel the mean of its samples.
/// Exposure, lines and curves of `options` are of no use here. If stopped, pixels not reached are
/// black. Throws Error(contract) as draw, and for a mesh without light.
RadiancePicture draw_radiance(const ShadedMesh& mesh, const Camera& camera,
                              const PictureOptions& options = {}, const Progress& progress = {});

/// The same tone-mapped as draw does. `emits` has 1 for pixels that the exposure ignores; exposure
/// 0: from the picture. Throws Error(contract) unless there is one for each pixel.
Picture tone_mapped(const RadiancePicture& picture, std::span<const std::uint8_t> emits,
                    double exposure);

inline constexpr FileFormats radiance_formats = {"radiances", {".hdr"}};

/// Writes Radiance's RGBE (Ward 1991), rows packed by run lengths: 8 bits of the brightest channel
/// and an exponent for all three, good to 0.4 % of the brightest. Throws Error(unwritable), or
/// Error(usage) if the extension is not .hdr.
void write_hdr(const RadiancePicture& picture, const std::filesystem::path& path);

}  // namespace halfshade
