#include "solver/pipeline/surface_finder.h"

#include "meshing/backprojection/opaque_scene.h"
#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// How far a point is from a surface, as a share of the surface's size, and how far its normal is
/// turned from the surface's, in radians, by what six digits of a table leave.
constexpr double off_surface = 1e-6, turned = 1e-3;
/// Elements are turned by more where corners of small faces lie off their plane.
constexpr double most_turned = 0.05;

/// At least what digits of the scene's file leave: of small faces that is more. A corner that two
/// surfaces share may be off the plane of either by that.
double reach_of(const Surface& surface) {
  return std::max(off_surface * size_of(surface), 2 * tolerance_of(surface).planarity);
}

}  // namespace

Bounds outline_bounds(const Surface& surface) {
  Bounds box;
  for (const Vec2& q : surface.rings.front()) box.include(surface.frame.to_space(q));
  return box;
}

SurfaceFinder::SurfaceFinder(const SoundScene& scene) : scene_(scene) {
  std::vector<Bounds> boxes;
  for (const Surface& surface : scene.surfaces)
    boxes.push_back(outline_bounds(surface).grown(2 * reach_of(surface)));
  boxes_ = make_flat_tree(boxes);
}

int SurfaceFinder::at_point(const SurfacePoint& point) const {
  Bounds here;
  here.include(point.position);
  int nearest = -1;
  double least = 0;
  visit_overlaps(boxes_, here, [&](int s) {
    const Surface& surface = scene_.surfaces[at(s)];
    const double turn = (surface.frame.normal - point.normal).norm();
    if (turn > most_turned) return;
    const double reach = reach_of(surface), height = surface.frame.height(point.position);
    if (std::abs(height) > reach) return;
    const Vec2 q = surface.frame.to_plane(point.position);
    const double beside = is_inside(surface.rings, q) ? 0 : distance_to_rings(surface.rings, q);
    if (beside > reach) return;
    const double off = std::hypot(height, beside) + reach * turn / turned;
    if (nearest >= 0 && (off > least || (off == least && s > nearest))) return;
    nearest = s;
    least = off;
  });
  return nearest;
}

std::vector<FieldPoint> on_surfaces(const PreparedScene& prepared,
                                    std::span<const SurfacePoint> points) {
  const SoundScene& scene = prepared.scene();
  const SurfaceFinder finder(scene);
  std::vector<double> off;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s)
    off.push_back(prepared.opaque().off_plane(static_cast<int>(s)));
  std::vector<FieldPoint> result;
  result.reserve(points.size());
  for (const SurfacePoint& point : points) {
    FieldPoint placed{point, finder.at_point(point)};
    if (placed.surface >= 0) {
      const PlaneFrame& frame = scene.surfaces[at(placed.surface)].frame;
      if (frame.height(point.position) < 2 * off[at(placed.surface)])
        placed.point.position = frame.foot(point.position);
    }
    result.push_back(placed);
  }
  return result;
}

}  // namespace halfshade
