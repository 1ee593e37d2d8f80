#include "io/picture/view.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade::detail {
namespace {

/// Rays along each side of the picture that exposures and ranges are chosen from.
constexpr int most_survey_rays = 128;

void check_view(const Camera& camera, const PictureOptions& options) {
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

}  // namespace

View make_view(const Camera& camera, const PictureOptions& options) {
  check_view(camera, options);
  View view;
  view.forward = camera.direction.stableNormalized();
  const Vec3 right = view.forward.cross(camera.up.stableNormalized()).normalized();
  const Vec3 up = right.cross(view.forward);
  const double half = std::tan(camera.vertical_fov / 2 * std::numbers::pi / 180);
  const double pixel = 2 * half / options.height;
  view.origin = camera.position;
  view.right = pixel * right;
  view.down = -pixel * up;
  view.corner = view.forward - options.width / 2.0 * view.right - options.height / 2.0 * view.down;
  view.width = options.width;
  view.height = options.height;
  return view;
}

std::optional<Vec2> to_picture(const View& view, const Vec3& point) {
  const Vec3 way = point - view.origin;
  const double depth = view.forward.dot(way);
  if (!(depth > least_sine * way.norm())) return std::nullopt;
  const Vec3 ray = way / depth - view.corner;
  return Vec2(ray.dot(view.right) / view.right.squaredNorm(),
              ray.dot(view.down) / view.down.squaredNorm());
}

std::vector<Vec3> survey(const View& view) {
  const int columns = std::min(view.width, most_survey_rays);
  const int rows = std::min(view.height, most_survey_rays);
  std::vector<Vec3> rays;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column)
      rays.push_back(
          view.ray((column + 0.5) * view.width / columns, (row + 0.5) * view.height / rows));
  return rays;
}

bool for_each_pixel(const View& view, int samples,
                    const std::function<void(std::size_t pixel, std::span<const Vec3> rays)>& look,
                    const Progress& progress) {
  const int n = static_cast<int>(std::ceil(std::sqrt(samples)));
  const auto draw_row = [&](std::size_t row) {
    std::vector<Vec3> rays(at(n) * at(n));
    for (int column = 0; column < view.width; ++column) {
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          rays[at(i) * at(n) + at(j)] =
              view.ray(column + (j + 0.5) / n, static_cast<int>(row) + (i + 0.5) / n);
      look(row * at(view.width) + at(column), rays);
    }
  };
  return parallel_for(at(view.height), draw_row, progress, "drawing");
}

}  // namespace halfshade::detail
