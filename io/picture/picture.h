#pragma once

#include "io/files/extension.h"
#include "meshing/core/progress.h"
#include "meshing/core/scene.h"
#include "solver/pipeline/solve.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace halfshade {

/// What multiplies the value of a triangle: a picture and a constant.
struct ShadedPaint {
  int paint = -1;  ///< into ShadedMesh::paints; −1: none
  Rgb gain = Rgb::Ones();
};

/// Triangles that carry radiosity in W/m², or another quantity, ready to be drawn.
struct ShadedMesh {
  std::vector<Vec3> points;
  std::vector<std::array<int, 3>> triangles;
  /// [k]: whether the edge from corner k to k+1 is one of an element; empty: all are.
  std::vector<std::array<bool, 3>> is_border;
  std::vector<Rgb> point_value;  ///< empty: each triangle has one value
  std::vector<Rgb> triangle_value;
  std::vector<ShadedPaint> painted;  ///< of each triangle; empty: none is
  std::vector<Paint> paints;
  std::vector<std::uint8_t> emits;  ///< 1 for triangles with exitance; the exposure ignores them
  std::vector<Camera> cameras;
  bool headlight =
      false;  ///< without light: "radiosity" is under a lamp at the camera, seen square
};

/// A solution, with values at points interpolated from the elements.
ShadedMesh shaded(const SolveResult& result);

/// A scene without light: its reflectances under a lamp at the camera; emitters shine in the colour
/// of their exitance.
ShadedMesh shaded(const SoundScene& scene, const std::vector<Camera>& cameras);

inline constexpr FileFormats shaded_formats = {"results to draw", {".vtu", ".vtp"}};

/// Reads the light of a .vtu or .vtp that write_result has written. Throws Error(invalid_input) for
/// anything else, whatever is in the file.
ShadedMesh read_shaded(const std::filesystem::path& path);

/// Limits of what is drawn.
inline constexpr int most_pixels = 16384;  ///< along either side
inline constexpr int most_samples = 1024;  ///< a pixel
/// Directions with a smaller sine between them count as parallel: a camera has no use for such a
/// pair.
inline constexpr double least_sine = 1e-9;

enum class Shading { smooth, flat };

/// A line in space, drawn over a picture where the surface it lies on is seen.
struct OverlaidCurve {
  std::vector<Vec3> points;
  std::array<std::uint8_t, 3> colour{};  ///< sRGB
};

struct PictureOptions {
  int width = 800, height = 800;  ///< pixels, 1…most_pixels
  int samples = 16;               ///< rays per pixel, 1…most_samples; rounded up to a square
  double exposure = 0;  ///< factor from W/m² to [0,1] display values; 0: from the picture
  Shading shading = Shading::smooth;
  bool mesh_lines = false;            ///< draw the element edges
  std::vector<OverlaidCurve> curves;  ///< the last ones on top
  double curve_width = 1.5;           ///< pixels, > 0
};

/// 8-bit sRGB pixels, three bytes each, top row first.
struct Picture {
  int width = 0, height = 0;
  double exposure = 0;  ///< as used
  std::vector<std::uint8_t> pixels;
  std::string comment;  ///< stands in the file, not in the picture; may be empty
};

/// A camera outside the scene's bounding box that shows all of it in a picture at least as wide as
/// high, slightly from above. The shortest side of the box is taken for its height, y of equally
/// short ones; of the sides to look from, the one that shows the most front side. Precondition: the
/// mesh has points.
Camera fitting_camera(const ShadedMesh& mesh);

/// What shows a mesh if nobody says where to stand: its first camera; else fitting_camera, unless
/// walls close the scene's lamp in and hide it from there. Then a camera in the room, at the end of
/// the longest line through it.
Camera default_camera(const ShadedMesh& mesh);

/// Draws by casting rays; needs no display. Back sides are not drawn, so that a room can be looked
/// into from outside. A pixel is the mean of its tone-mapped samples, so that the edges of bright
/// lamps are smooth, too. Image x runs along direction × up. If stopped, pixels not reached are
/// black. Throws Error(contract) for options out of range or a camera that cannot be used.
Picture draw(const ShadedMesh& mesh, const Camera& camera, const PictureOptions& options = {},
             const Progress& progress = {});

/// Pictures of the same height from left to right, with each one's title in its upper left corner;
/// the others' exposures and comments must be the first one's. Throws Error(contract) unless there
/// are as many titles as pictures, at least one.
Picture beside(std::span<const Picture> pictures, std::span<const std::string> titles);

inline constexpr FileFormats picture_formats = {"pictures", {".png"}};

/// Throws Error(unwritable), or Error(usage) if the extension is not .png.
void write_png(const Picture& picture, const std::filesystem::path& path);

}  // namespace halfshade
