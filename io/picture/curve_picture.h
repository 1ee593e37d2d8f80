#pragma once

#include "io/picture/picture.h"
#include "meshing/discontinuity/discontinuity.h"
#include "solver/direct/direct_light.h"

#include <span>
#include <string_view>
#include <vector>

namespace halfshade {

/// What the colour of a curve says. Order: D0 red, D1 blue, D2 pink, D2 of three edges yellow, as
/// the literature draws them. Kind: contact red, face green, ev pink, eee yellow, horizon teal.
enum class CurveColour { order, kind };

inline constexpr int least_curve_pixels = 16;

struct CurvePictureOptions {
  int pixels = 500;         ///< of the longer side, least_curve_pixels…most_pixels
  double line_width = 1.5;  ///< pixels, > 0
  CurveColour colour = CurveColour::order;
  Vec3 up = Vec3::Zero();  ///< roughly upwards in the picture; zero: chosen from the plane
};

/// The surfaces to draw under a name: all of the group of that name, or the one whose number it
/// is, with those of the group in its plane; empty: those in the plane with most curves. Throws
/// Error(usage) if there is no such group, if the group lies in several planes, or if the name is
/// empty and there are no curves.
std::vector<int> picture_surfaces(const SoundScene& scene, const Discontinuities& found,
                                  std::string_view name);

/// A map of surfaces in one plane, seen square from their front: in grey the exact direct light at
/// the centre of each pixel, over it the discontinuity curves of all emitters, the lowest order on
/// top. If stopped, pixels not reached are dark. `exposure` of the result is what makes W/m² linear
/// display values. `light` must be of `scene`. Throws Error(contract) for options out of range, no
/// surfaces, or surfaces in different planes.
Picture draw_curves(const SoundScene& scene, const DirectLightIndex& light,
                    const Discontinuities& found, std::span<const int> surfaces,
                    const CurvePictureOptions& options = {}, const Progress& progress = {});

inline constexpr FileFormats overlay_formats = {"curves to draw", {".vtp"}};

/// Reads curves that write_curves has written, in the colours of their order, the lowest order
/// last. Throws Error(invalid_input) for anything else, whatever is in the file.
std::vector<OverlaidCurve> read_curves(const std::filesystem::path& path);

/// Colours as bytes of sRGB.
std::array<std::uint8_t, 3> curve_colour(const DiscontinuityCurve& curve, CurveColour by);

}  // namespace halfshade
