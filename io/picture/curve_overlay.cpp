#include "io/picture/curve_overlay.h"

#include <algorithm>
#include <cmath>

namespace halfshade::detail {
namespace {

/// Whether a line is seen is asked at so many pixels' distance.
constexpr double step_pixels = 2;
/// And at no more places of one straight piece, however long it is on the screen.
constexpr double most_steps = 20000;

/// The parts of a straight piece that are seen, in pixels; adjacent ones are joined.
void add_seen(const SeenMesh& seen, const Vec3& a, const Vec3& b,
              std::vector<std::vector<Vec2>>& lines) {
  const auto from = to_picture(seen.view(), a), to = to_picture(seen.view(), b);
  // A piece that passes the camera's own plane is long on the screen.
  const double length = from && to ? (*to - *from).norm() : most_steps;
  const int steps = static_cast<int>(std::clamp(std::ceil(length / step_pixels), 1., most_steps));
  bool is_open = false;
  for (int k = 0; k < steps; ++k) {
    const auto place = [&](double s) -> Vec3 { return a + s / steps * (b - a); };
    const auto start = to_picture(seen.view(), place(k));
    const auto end = to_picture(seen.view(), place(k + 1.));
    const bool is_seen = start && end && seen.shows(place(k + 0.5));
    if (is_seen && !is_open) lines.push_back({*start});
    if (is_seen) lines.back().push_back(*end);
    is_open = is_seen;
  }
}

}  // namespace

void overlay(LineCanvas& canvas, std::span<const OverlaidCurve> curves, const SeenMesh& seen,
             double width) {
  for (const OverlaidCurve& curve : curves) {
    std::vector<std::vector<Vec2>> lines;
    for (std::size_t k = 0; k + 1 < curve.points.size(); ++k)
      add_seen(seen, curve.points[k], curve.points[k + 1], lines);
    for (const std::vector<Vec2>& line : lines) canvas.line(line, width, decode_srgb(curve.colour));
  }
}

}  // namespace halfshade::detail
