#include "meshing/events/quadric_events.h"

#include "meshing/events/margins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace halfshade {

namespace {

/// det[a, b, c].
double det(const Vec3& a, const Vec3& b, const Vec3& c) { return a.dot(b.cross(c)); }

/// A sum, or 0 if it is rounding of terms of this size.
double unless_rounding(double sum, double size) {
  return std::abs(sum) > margins::determinant_error * size ? sum : 0;
}

/// b² − 4 a c without cancellation beyond that of the exact difference (Kahan).
double discriminant(double a, double b, double c) {
  const double square = b * b, product = 4 * a * c;
  const double error = std::fma(b, b, -square) - std::fma(4 * a, c, -product);
  return (square - product) + error;
}

}  // namespace

QuadraticRoots roots(const Quadratic& coefficients) {
  double size = 0;
  for (const double c : coefficients) size = std::max(size, std::abs(c));
  if (!(size > 0)) return {true, 0, {}};
  // By a power of two, so that products neither overflow nor vanish and nothing is rounded.
  const auto scaled = [&](double x) { return std::ldexp(x, -std::ilogb(size)); };
  const double a = scaled(coefficients[2]), b = scaled(coefficients[1]);
  const double c = scaled(coefficients[0]);
  if (a == 0) {
    if (b == 0) return {};
    return {false, 1, {-c / b, 0}};
  }
  const double d = discriminant(a, b, c);
  if (d <= margins::discriminant_error * (b * b)) {
    if (d < -margins::discriminant_error * (b * b)) return {};
    return {false, 1, {-b / (2 * a), 0}};
  }
  const double sum = -(b + std::copysign(std::sqrt(d), b)) / 2;
  double first = sum / a, second = c / sum;
  if (first > second) std::swap(first, second);
  return {false, 2, {first, second}};
}

LineFamily line_family(const std::array<Line3, 3>& lines) {
  LineFamily family;
  family.lines = lines;
  for (std::size_t i = 0; i < 2; ++i) {
    const Line3& line = lines[i + 1];
    family.constant[i] = (line.point - lines[0].point).cross(line.direction);
    family.slope[i] = line.direction.cross(lines[0].direction);
  }
  return family;
}

Vec3 point(const LineFamily& family, double t) {
  return family.lines[0].point + t * family.lines[0].direction;
}

Vec3 direction(const LineFamily& family, double t) {
  return (family.constant[0] + t * family.slope[0]).cross(family.constant[1] + t * family.slope[1]);
}

Quadratic direction_along(const LineFamily& family, const Vec3& m) {
  const auto& [a2, a3] = family.constant;
  const auto& [b2, b3] = family.slope;
  return {det(a2, a3, m), det(b2, a3, m) + det(a2, b3, m), det(b2, b3, m)};
}

Quadratic meeting(const LineFamily& family, const Line3& f) {
  const Line3& first = family.lines[0];
  const Vec3 af = (f.point - first.point).cross(f.direction);
  const Vec3 bf = f.direction.cross(first.direction);
  const auto& [a2, a3] = family.constant;
  const auto& [b2, b3] = family.slope;
  const Quadratic c = {det(a2, a3, af), det(b2, a3, af) + det(a2, b3, af) + det(a2, a3, bf),
                       det(a2, b3, bf) + det(b2, a3, bf) + det(b2, b3, af)};
  // Sizes of the factors before their own cross products cancel.
  double product = f.direction.norm(), reach = (f.point - first.point).norm();
  for (std::size_t i = 1; i < 3; ++i) {
    product *= family.lines[i].direction.norm();
    reach = std::max(reach, (family.lines[i].point - first.point).norm());
  }
  const double speed = first.direction.norm();
  return {unless_rounding(c[0], product * reach * reach * reach),
          unless_rounding(c[1], 3 * product * reach * reach * speed),
          unless_rounding(c[2], 3 * product * reach * speed * speed)};
}

// The line lies in the plane of x and the other line, j, which cuts line i where
// nⱼ·(aᵢ + s dᵢ − x) = 0; and nⱼ·(aᵢ − x) = nⱼ·(aᵢ − aⱼ), because nⱼ is normal to aⱼ − x.
LinearRatio parameter_on(const LineFamily& family, int i) {
  const std::size_t other = i == 1 ? 1 : 0;  // in constant and slope
  const Line3& on = family.lines[at(i)];
  const Vec3 between = family.lines[other + 1].point - on.point;
  return {family.constant[other].dot(between), family.slope[other].dot(between),
          family.constant[other].dot(on.direction), family.slope[other].dot(on.direction)};
}

}  // namespace halfshade
