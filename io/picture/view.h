#pragma once

#include "io/picture/picture.h"

#include <functional>
#include <optional>

namespace halfshade::detail {

/// Directions of rays: forward + x·right + y·down at pixel coordinates (x, y), top left (0, 0).
struct View {
  Vec3 origin, forward, corner, right, down;
  int width = 0, height = 0;  ///< pixels

  Vec3 ray(double x, double y) const { return corner + x * right + y * down; }
};

/// Throws Error(contract) for options out of range or a camera that cannot be used.
View make_view(const Camera& camera, const PictureOptions& options);

/// Where a point of the scene lies in the picture, in pixels; nothing if not in front of the
/// camera.
std::optional<Vec2> to_picture(const View& view, const Vec3& point);

/// Directions on a grid over the picture, at most 128 along each side: enough to learn what is
/// seen.
std::vector<Vec3> survey(const View& view);

/// Calls `look` for every pixel with n × n directions spread over it, shared among threads row by
/// row; false if stopped.
bool for_each_pixel(const View& view, int samples,
                    const std::function<void(std::size_t pixel, std::span<const Vec3> rays)>& look,
                    const Progress& progress);

}  // namespace halfshade::detail
