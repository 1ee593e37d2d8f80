#include "io/picture/picture.h"

#include "io/picture/tone_map.h"
#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/rays/visibility.h"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace halfshade {
namespace {

const Rgb background = Rgb::Constant(0.015);  // linear: a dark grey that is not black
constexpr double line_opacity = 0.7;
/// On elements that come out darker than this, edges are drawn light.
constexpr double dark = 0.02, light_line = 0.1;
/// The part of the headlight that comes from everywhere: surfaces seen edge-on do not turn black.
constexpr double from_everywhere = 0.25;
/// Rays along each side of the picture that the exposure is chosen from.
constexpr int most_exposure_rays = 128;

/// Directions of rays: forward + x·right + y·down at pixel coordinates (x, y), top left (0, 0).
struct View {
  Vec3 origin, corner, right, down;

  Vec3 ray(double x, double y) const { return corner + x * right + y * down; }
};

View make_view(const Camera& camera, const PictureOptions& options) {
  const Vec3 forward = camera.direction.stableNormalized();
  const Vec3 right = forward.cross(camera.up.stableNormalized()).normalized();
  const Vec3 up = right.cross(forward);
  const double half = std::tan(camera.vertical_fov / 2 * std::numbers::pi / 180);
  const double pixel = 2 * half / options.height;
  View view;
  view.origin = camera.position;
  view.right = pixel * right;
  view.down = -pixel * up;
  view.corner = forward - options.width / 2.0 * view.right - options.height / 2.0 * view.down;
  return view;
}

void check(const Camera& camera, const PictureOptions& options) {
  const auto fail = [](const std::string& sentence) {
    throw Error(ErrorCode::contract, "draw", sentence);
  };
  if (options.width < 1 || options.height < 1 || options.width > most_pixels ||
      options.height > most_pixels)
    fail(fmt::format("a picture of {} x {} pixels; each must be in 1 to {}", options.width,
                     options.height, most_pixels));
  if (options.samples < 1 || options.samples > most_samples)
    fail(fmt::format("{} samples per pixel; they must be in 1 to {}", options.samples,
                     most_samples));
  if (!(options.exposure >= 0 && std::isfinite(options.exposure)))
    fail(fmt::format("an exposure of {}; it must be finite and not negative", options.exposure));
  const Vec3 right = camera.direction.stableNormalized().cross(camera.up.stableNormalized());
  if (!camera.position.allFinite() || !(right.norm() > least_sine) ||
      !(camera.vertical_fov > 0 && camera.vertical_fov < 180))
    fail(fmt::format("camera '{}' has no use for its vectors or its field of view of {} degrees",
                     camera.name, camera.vertical_fov));
}

void check(const ShadedMesh& mesh) {
  const std::size_t n = mesh.triangles.size();
  if (mesh.triangle_radiosity.size() != n || mesh.emits.size() != n ||
      mesh.point_radiosity.size() != mesh.points.size())
    throw Error(ErrorCode::contract, "draw", "the mesh has arrays of different lengths");
}

/// What one ray sees.
class Painter {
 public:
  Painter(const ShadedMesh& mesh, const View& view, const PictureOptions& options)
      : mesh_(mesh), view_(view), options_(options) {
    if (mesh.triangles.empty()) return;
    index_.emplace(TriangleSoup{mesh.points, mesh.triangles,
                                std::vector<int>(mesh.triangles.size(), 0),
                                std::vector<int>(mesh.triangles.size(), -1)});
  }

  /// Chooses the exposure from rays on a grid over the picture, unless it is given.
  double expose(const Progress& progress) {
    exposure_ = options_.exposure;
    if (exposure_ > 0) return exposure_;
    const int columns = std::min(options_.width, most_exposure_rays);
    const int rows = std::min(options_.height, most_exposure_rays);
    const auto count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    std::vector<Rgb> values(count, Rgb::Zero());
    std::vector<double> weights(count, 0);
    std::vector<std::uint8_t> emits(count, 0);
    parallel_for(
        count,
        [&](std::size_t i) {
          const int k = static_cast<int>(i), column = k % columns, row = k / columns;
          const Vec3 ray = view_.ray((column + 0.5) * options_.width / columns,
                                     (row + 0.5) * options_.height / rows);
          if (const auto hit = cast(ray)) {
            values[i] = radiosity(*hit, ray);
            weights[i] = 1;
            emits[i] = mesh_.emits[static_cast<std::size_t>(hit->triangle)];
          }
        },
        Progress{progress.stop, {}});
    return exposure_ = choose_exposure(values, weights, emits);
  }

  /// The mean of the linear display values of n × n samples.
  Rgb pixel(int column, int row, int n) const {
    Rgb sum = Rgb::Zero();
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        sum += sample(view_.ray(column + (j + 0.5) / n, row + (i + 0.5) / n));
    return sum / (n * n);
  }

 private:
  std::optional<Hit> cast(const Vec3& ray) const {
    return index_ ? index_->first_hit(view_.origin, ray, Sides::front_only) : std::nullopt;
  }

  std::array<Vec3, 3> corners(const Hit& hit) const {
    const auto& t = mesh_.triangles[static_cast<std::size_t>(hit.triangle)];
    return {mesh_.points[static_cast<std::size_t>(t[0])],
            mesh_.points[static_cast<std::size_t>(t[1])],
            mesh_.points[static_cast<std::size_t>(t[2])]};
  }

  Rgb radiosity(const Hit& hit, const Vec3& ray) const {
    const auto triangle = static_cast<std::size_t>(hit.triangle);
    Rgb value = mesh_.triangle_radiosity[triangle];
    if (options_.shading == Shading::smooth) {
      value = Rgb::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        value += std::clamp(hit.weights[k], 0.0, 1.0) *
                 mesh_.point_radiosity[static_cast<std::size_t>(mesh_.triangles[triangle][k])];
    }
    if (!mesh_.headlight || mesh_.emits[triangle] != 0) return value;
    const auto [a, b, c] = corners(hit);
    const Vec3 normal =
        (b - a).stableNormalized().cross((c - a).stableNormalized()).stableNormalized();
    return value *
           (from_everywhere + (1 - from_everywhere) * std::abs(normal.dot(ray.stableNormalized())));
  }

  /// Distance in pixels from where the ray hits to the nearest edge of the triangle, on the screen.
  /// A ray d meets the line of the edge from a to b where d·((a−o)×(b−o)) = 0, which is linear in
  /// pixel coordinates; dividing by the gradient gives the distance, corners behind the camera or
  /// not.
  double pixels_to_edge(const Hit& hit, const Vec3& ray) const {
    const auto p = corners(hit);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      if (!mesh_.is_border.empty() && !mesh_.is_border[static_cast<std::size_t>(hit.triangle)][k])
        continue;
      const Vec3 line = (p[k] - view_.origin)
                            .stableNormalized()
                            .cross((p[(k + 1) % 3] - view_.origin).stableNormalized());
      const double gradient = std::hypot(line.dot(view_.right), line.dot(view_.down));
      nearest = std::min(nearest, std::abs(line.dot(ray)) / gradient);
    }
    return nearest;
  }

  Rgb sample(const Vec3& ray) const {
    const auto hit = cast(ray);
    if (!hit) return background;
    Rgb value = tone_map(radiosity(*hit, ray), exposure_);
    // Each of two neighbours draws its half of the line between them.
    if (options_.mesh_lines && pixels_to_edge(*hit, ray) < 0.5) {
      // Light on dark elements; one colour an element, lest it changes along an edge.
      const Rgb element = mesh_.triangle_radiosity[static_cast<std::size_t>(hit->triangle)];
      const double line = tone_map(element, exposure_).maxCoeff() > dark ? 0.0 : light_line;
      value = (1 - line_opacity) * value + line_opacity * line;
    }
    return value;
  }

  const ShadedMesh& mesh_;
  View view_;
  PictureOptions options_;
  std::optional<VisibilityIndex> index_;
  double exposure_ = 0;
};

}  // namespace

Picture draw(const ShadedMesh& mesh, const Camera& camera, const PictureOptions& options,
             const Progress& progress) {
  check(camera, options);
  check(mesh);
  const int n = static_cast<int>(std::ceil(std::sqrt(options.samples)));
  Painter painter(mesh, make_view(camera, options), options);
  Picture picture;
  picture.width = options.width;
  picture.height = options.height;
  picture.exposure = painter.expose(progress);
  const auto row_bytes = static_cast<std::size_t>(options.width) * 3;
  picture.pixels.assign(row_bytes * static_cast<std::size_t>(options.height), 0);
  parallel_for(
      static_cast<std::size_t>(options.height),
      [&](std::size_t row) {
        auto out = picture.pixels.begin() + static_cast<std::ptrdiff_t>(row * row_bytes);
        for (int column = 0; column < options.width; ++column) {
          const auto bytes = encode_srgb(painter.pixel(column, static_cast<int>(row), n));
          out = std::copy(bytes.begin(), bytes.end(), out);
        }
      },
      progress, "drawing");
  return picture;
}

}  // namespace halfshade
