#pragma once

#include "meshing/core/sound_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

/// Exact direct light by re-clipping in long double: an independent check of everything between
/// OpaqueScene and DirectLightIndex. Slow, and only for convex occluders without holes.
namespace halfshade::test {

using Real = long double;
using Real3 = Eigen::Matrix<Real, 3, 1>;
using RealPolygon = std::vector<Real3>;  ///< relative to the point that looks

/// The part of a convex polygon with plane·p ≥ offset.
inline RealPolygon clip(const RealPolygon& polygon, const Real3& plane, Real offset = 0) {
  RealPolygon kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Real3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const Real fa = plane.dot(a) - offset, fb = plane.dot(b) - offset;
    if (fa >= 0) kept.push_back(a);
    if ((fa > 0 && fb < 0) || (fa < 0 && fb > 0)) kept.push_back(a + fa / (fa - fb) * (b - a));
  }
  return kept.size() < 3 ? RealPolygon() : kept;
}

/// Lambert's sum, positive for polygons that run counter-clockwise seen from the point.
inline Real lambert(const RealPolygon& polygon, const Real3& normal) {
  Real sum = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Real3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
    const Real3 cross = a.cross(b);
    const Real sine = cross.norm();
    if (sine > 0) sum -= std::atan2(sine, a.dot(b)) / sine * normal.dot(cross);
  }
  return sum / (2 * std::numbers::pi_v<Real>);
}

/// The sides of the cone from the point over a convex polygon; `sign`·side·p > 0 inside.
struct Cone {
  std::vector<Real3> sides;
  Real sign;
};

/// Takes the cone out of the pieces, which stay convex.
inline void subtract(std::vector<RealPolygon>& pieces, const Cone& cone) {
  std::vector<RealPolygon> left;
  for (RealPolygon& piece : pieces) {
    const auto is_outside = [&](const Real3& side) {
      for (const Real3& p : piece)
        if (cone.sign * side.dot(p) > 0) return false;
      return true;
    };
    if (std::any_of(cone.sides.begin(), cone.sides.end(), is_outside)) {
      left.push_back(std::move(piece));
      continue;
    }
    for (const Real3& side : cone.sides) {
      const Real3 inwards = cone.sign * side;
      if (RealPolygon outside = clip(piece, -inwards); !outside.empty())
        left.push_back(std::move(outside));
      piece = clip(piece, inwards);
      if (piece.empty()) break;
    }
  }
  pieces = std::move(left);
}

struct OracleAnswer {
  Real visible = 0, unobstructed = 0;
};

class VisibilityOracle {
 public:
  explicit VisibilityOracle(const SoundScene& scene) : scene_(scene) {}

  OracleAnswer form_factor(const Vec3& point, const Vec3& normal, int emitter) const {
    const Surface& source = scene_.surfaces[static_cast<std::size_t>(emitter)];
    const Real3 x = point.cast<Real>(), n = normal.cast<Real>();
    const Real3 towards = -source.frame.normal.cast<Real>();
    const Real distance = towards.dot(source.frame.origin.cast<Real>() - x);
    OracleAnswer answer;
    if (distance <= 0) return answer;
    const std::vector<Cone> cones = occluding_cones(source, x, towards, distance);
    // Signed triangles make up any polygon, for what hides the emitter's plane hides all of it.
    const Real3 apex = corner(source, source.rings[0][0]) - x;
    for (const Ring& ring : source.rings)
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Real3 a = corner(source, ring[k]) - x;
        const Real3 b = corner(source, ring[(k + 1) % ring.size()]) - x;
        const RealPolygon triangle = clip({apex, a, b}, n);
        if (triangle.empty()) continue;
        answer.unobstructed += lambert(triangle, n);
        std::vector<RealPolygon> pieces = {triangle};
        for (const Cone& cone : cones) subtract(pieces, cone);
        for (const RealPolygon& piece : pieces) answer.visible += lambert(piece, n);
      }
    return answer;
  }

 private:
  static Real3 corner(const Surface& surface, const Vec2& p) {
    return surface.frame.to_space(p).cast<Real>();
  }

  /// Cones over what of the other polygons lies strictly between the point and the emitter's plane.
  /// Polygons that the point lies in the plane of are seen edge-on, or only touched.
  std::vector<Cone> occluding_cones(const Surface& source, const Real3& x, const Real3& towards,
                                    Real distance) const {
    std::vector<Cone> cones;
    for (const Surface& surface : scene_.surfaces) {
      if (surface.plane == source.plane || surface.back) continue;
      const Real height =
          surface.frame.normal.cast<Real>().dot(x - surface.frame.origin.cast<Real>());
      if (std::abs(height) < 1e-14L * static_cast<Real>(scene_.diagonal)) continue;
      RealPolygon polygon;
      for (const Vec2& p : surface.rings[0]) polygon.push_back(corner(surface, p) - x);
      polygon = clip(clip(polygon, towards), -towards, -distance);
      if (polygon.empty()) continue;
      Cone cone{{}, height > 0 ? Real(-1) : Real(1)};
      for (std::size_t k = 0; k < polygon.size(); ++k)
        cone.sides.push_back(polygon[k].cross(polygon[(k + 1) % polygon.size()]));
      cones.push_back(std::move(cone));
    }
    return cones;
  }

  const SoundScene& scene_;
};

}  // namespace halfshade::test
