#pragma once

#include "meshing/core/types.h"

#include <array>
#include <span>
#include <stop_token>

namespace halfshade {

/// Form factor from a surface element at `point` with unit normal `normal` to the front of an
/// unobstructed planar polygon: the fraction of what leaves the point that reaches it (Lambert
/// 1760). The polygon may be non-convex; the part below the point's horizon is clipped away. 0 if
/// the point is not in front of the polygon. Exact to rounding: the relative error is about 1e-16
/// times distance over size. The point must not lie on the polygon's boundary.
double point_to_polygon(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon);

/// Lambert's edge sum without any clipping: the polygon must lie above the horizon. Negative when
/// the point is behind the polygon.
double lambert_sum(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon);

/// A F by Lambert's sum integrated over the outer triangle with a rule that is exact for
/// polynomials of `degree`. Both must lie on each other's front. The relative error is about
/// ratio^−(degree + 1), with ratio the distance of the two over the radius of the outer one.
double mutual_area_by_rule(const std::array<Vec3, 3>& outer, const Vec3& outer_normal,
                           std::span<const Vec3> inner, int degree);

/// The lowest degree whose error is below `tolerance` at a ratio of distance to size; −1 if there
/// is none and mutual_area has to be used.
int sufficient_degree(double ratio, double tolerance);

struct FormFactorOptions {
  double tolerance = 1e-9;  ///< relative error aimed at, in (0, 1)
  double floor = 0;  ///< absolute error of A F that is good enough, in squared scene units, ≥ 0
  int max_points = 1000000;  ///< outer quadrature points at which refinement stops, ≥ 1
};

struct MutualArea {
  double value = 0;  ///< A_p F(p,q) = A_q F(q,p), in squared scene units
  double error = 0;  ///< estimate of its absolute error
  int points = 0;    ///< outer quadrature points used
};

/// Mutual exchange area of two unobstructed planar polygons. Both are first clipped to each other's
/// front. Then the double contour integral of ln r (Sparrow 1963) is evaluated with the inner
/// contour in closed form and adaptive Gauss–Kronrod quadrature along the outer one, whose nodes
/// gather where a vertex of q comes near: polygons that touch in a vertex, share an edge or part of
/// it, or are separated by a tiny gap converge like distant ones. (Area quadrature with collapsed
/// coordinates, Duffy 1982, does as well on shared edges but needs 1/gap points for gaps.) Far
/// apart, it is Lambert's closed form integrated over p. Either may be non-convex. Both
/// counter-clockwise seen from their fronts, of at least 3 vertices, planar. If stopped, the error
/// is what it is by then. Where one is far larger, rounding does less if p is the smaller.
MutualArea mutual_area(std::span<const Vec3> p, std::span<const Vec3> q,
                       const FormFactorOptions& options = {}, const std::stop_token& stop = {});

/// F(p,q) of two unobstructed planar polygons; see mutual_area.
double form_factor(std::span<const Vec3> p, std::span<const Vec3> q,
                   const FormFactorOptions& options = {});

}  // namespace halfshade
