#pragma once

#include "meshing/backprojection/visible_part.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

/// What a point sees of a convex light, by cutting what convex polygons hide away from it: another
/// way than the program's, which takes nothing from it.
namespace halfshade::test {

using Corners = std::vector<Vec3>;

/// A convex polygon of a thing that hides nothing from points in itself.
struct ClippedPiece {
  Corners corners;
  int thing = 0;
};

/// The part of a convex polygon with n·p > least.
inline Corners cut_off(const Corners& polygon, const Vec3& n, double least) {
  Corners rest;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const double a = n.dot(p) - least, b = n.dot(q) - least;
    if (a > 0) rest.push_back(p);
    if ((a > 0) != (b > 0)) rest.push_back(p + a / (a - b) * (q - p));
  }
  return rest.size() < 3 ? Corners() : rest;
}

/// Twice the area, along the normal.
inline Vec3 newell(const Corners& polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 0; k < polygon.size(); ++k)
    sum += polygon[k].cross(polygon[(k + 1) % polygon.size()]);
  return sum;
}

/// Inward unit normals of the planes of the origin and a polygon's sides; none if it is seen
/// edge-on.
inline Corners cone_of(const Corners& polygon) {
  const Vec3 normal = newell(polygon);
  const double side = normal.dot(polygon[0]);
  Corners planes;
  if (!(std::abs(side) > 1e-13 * normal.norm())) return planes;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3 plane = polygon[k].cross(polygon[(k + 1) % polygon.size()]);
    // Sides that clipping has made from a corner span none.
    if (plane.norm() > 1e-14 * polygon[k].squaredNorm())
      planes.push_back((side > 0 ? 1. : -1.) * plane.normalized());
  }
  return planes;
}

inline bool parts_from(const Corners& planes, const Corners& polygon) {
  return std::any_of(planes.begin(), planes.end(), [&](const Vec3& plane) {
    return std::all_of(polygon.begin(), polygon.end(),
                       [&](const Vec3& p) { return plane.dot(p) <= 1e-14 * p.norm(); });
  });
}

struct ClippedView {
  Region region = Region::away;
  double share = 0;  ///< of the part above the horizon that is seen
};

/// What a point of a thing with a normal sees of a light. Rounding may leave slits where something
/// cuts the light's plane: a share of up to 1e-9 may be none. Nothing else may lie in the plane of
/// the thing or of the light.
inline ClippedView clipped_view(std::span<const ClippedPiece> pieces, const ClippedPiece& light,
                                const Vec3& point, const Vec3& normal, int thing) {
  const auto seen_from = [&](Corners corners) {
    for (Vec3& p : corners) p -= point;
    return cut_off(corners, normal, 0);
  };
  const Vec3 light_normal = newell(light.corners).normalized();
  const double height = light_normal.dot(light.corners[0] - point);
  const Corners whole = seen_from(light.corners);
  if (height >= 0 || whole.empty()) return {};
  const Corners light_cone = cone_of(whole);
  std::vector<Corners> parts = {whole};
  bool is_touched = false;
  for (const ClippedPiece& piece : pieces) {
    if (piece.thing == thing || piece.thing == light.thing) continue;
    const Corners before = cut_off(seen_from(piece.corners), light_normal, height);
    if (before.empty()) continue;
    const Corners cone = cone_of(before);
    if (cone.empty() || parts_from(cone, whole) || parts_from(light_cone, before)) continue;
    is_touched = true;
    std::vector<Corners> rest;
    for (Corners part : parts)
      for (const Vec3& plane : cone) {
        if (const Corners outside = cut_off(part, -plane, 0); !outside.empty())
          rest.push_back(outside);
        part = cut_off(part, plane, 0);
        if (part.empty()) break;
      }
    parts = std::move(rest);
  }
  double left = 0;
  for (const Corners& part : parts) left += newell(part).norm();
  const double share = left / newell(whole).norm();
  return {!is_touched ? Region::lit : parts.empty() ? Region::umbra : Region::penumbra, share};
}

}  // namespace halfshade::test
