#include "solver/pipeline/surface_grid.h"

#include "meshing/core/error.h"
#include "meshing/core/planar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr double max_points = 1e8;

void add_grid(const Surface& surface, double spacing, std::vector<SurfacePoint>& points) {
  Eigen::AlignedBox2d box;
  for (const Vec2& p : surface.rings.front()) box.extend(p);
  const Eigen::Array2d cells = (box.sizes().array() / spacing).floor().max(1);
  if (static_cast<double>(points.size()) + cells.prod() > max_points)
    throw Error(ErrorCode::too_large, {},
                fmt::format("a spacing of {} makes more than {} points", spacing, max_points));
  const Vec2 first = box.center() - 0.5 * spacing * (cells - 1).matrix();
  for (int j = 0; j < static_cast<int>(cells.y()); ++j)
    for (int i = 0; i < static_cast<int>(cells.x()); ++i)
      if (const Vec2 p = first + spacing * Vec2(i, j); is_inside(surface.rings, p))
        points.push_back({surface.frame.to_space(p), surface.frame.normal});
}

}  // namespace

std::vector<SurfacePoint> surface_grid(const SoundScene& scene, std::string_view name,
                                       double spacing) {
  if (!(spacing > 0 && std::isfinite(spacing)))
    throw Error(ErrorCode::contract, "grid",
                fmt::format("the spacing ({}) must be positive", spacing));
  const auto group = std::find(scene.groups.begin(), scene.groups.end(), name);
  if (group == scene.groups.end())
    throw Error(ErrorCode::usage, "grid",
                fmt::format("there is no group '{}'; the scene has {}", name,
                            fmt::join(scene.groups, ", ")));
  std::vector<SurfacePoint> points;
  for (const Surface& surface : scene.surfaces)
    if (surface.group == static_cast<int>(group - scene.groups.begin()) && !surface.back)
      add_grid(surface, spacing, points);
  if (points.empty())
    throw Error(ErrorCode::usage, "grid",
                fmt::format("a spacing of {} puts no point on the group '{}'", spacing, name));
  return points;
}

}  // namespace halfshade
