#pragma once

#include "meshing/core/types.h"
#include "meshing/geometry/line.h"

#include <array>

namespace halfshade {

/// c[0] + c[1] t + c[2] t².
using Quadratic = std::array<double, 3>;

inline double value(const Quadratic& c, double t) { return c[0] + t * (c[1] + t * c[2]); }

/// Real roots of a quadratic.
struct QuadraticRoots {
  bool everywhere = false;     ///< all coefficients are zero
  int count = 0;               ///< a double root counts once
  std::array<double, 2> at{};  ///< ascending
};

/// Both roots to full relative precision, also where one is much smaller. A discriminant that is
/// negative by no more than rounding makes a double root. Leading zeros make it linear or constant.
QuadraticRoots roots(const Quadratic& c);

/// (a + b t)/(c + d t); infinite where the line is parallel to the one it should meet.
struct LinearRatio {
  double a = 0, b = 0, c = 1, d = 0;
};

inline double value(const LinearRatio& r, double t) { return (r.a + r.b * t) / (r.c + r.d * t); }

/// All lines that meet three given ones, one through each point x(t) = a₁ + t d₁ of the first:
/// where the plane of x and the second cuts that of x and the third. Their normals
/// nᵢ(t) = (aᵢ − x(t)) × dᵢ = constant[i] + t slope[i] are linear in t.
struct LineFamily {
  std::array<Line3, 3> lines;
  std::array<Vec3, 2> constant, slope;  ///< of n₂ and n₃
};

LineFamily line_family(const std::array<Line3, 3>& lines);

/// x(t).
Vec3 point(const LineFamily& family, double t);

/// n₂(t) × n₃(t): along the line through x(t). Zero where it is not unique: x(t) on the second or
/// third line, or in a plane with both.
Vec3 direction(const LineFamily& family, double t);

/// Its component along a vector m. Zeros: where the line is parallel to the planes normal to m, as
/// at the ends of the range in which edges of a face with normal m are silhouettes. If m is normal
/// to the second line these are: x(t) lies in the plane through that line; the line is parallel to
/// the second one.
Quadratic direction_along(const LineFamily& family, const Vec3& m);

/// Zeros: where the line through x(t) meets a fourth line f: det[n₂, n₃, n_f], whose cubic
/// coefficient −det[d₁×d₂, d₁×d₃, d₁×d_f] vanishes because all three are normal to d₁. All
/// coefficients are 0 if every line does to within rounding. Coefficients within their rounding
/// error are 0.
Quadratic meeting(const LineFamily& family, const Line3& f);

/// Where the line through x(t) meets the second (i = 1) or third line (i = 2) of the family: the
/// parameter s of aᵢ + s dᵢ.
LinearRatio parameter_on(const LineFamily& family, int i);

}  // namespace halfshade
