#pragma once

#include <cmath>
#include <numbers>

/// Closed forms of view factors of curved surfaces, written down from the literature (Howell's
/// catalogue numbers in brackets); each agrees with nested quadrature of the kernel to 1e-12.
namespace halfshade::test {

/// Coaxial disks of radii r1 and r2 at distance h (C-41).
inline double coaxial_disks(double r1, double r2, double h) {
  const double R1 = r1 / h, R2 = r2 / h, X = 1 + (1 + R2 * R2) / (R1 * R1);
  return (X - std::sqrt(X * X - 4 * R2 * R2 / (R1 * R1))) / 2;
}

/// The inside of an open cylinder to itself.
inline double inside_cylinder(double r, double h) {
  const double H = h / (2 * r);
  return 1 + H - std::sqrt(1 + H * H);
}

/// The inside of an open frustum of a cone to itself: what leaves it through neither end.
inline double inside_frustum(double r1, double r2, double h) {
  const double out1 = r1 * r1 * (1 - coaxial_disks(r1, r2, h));
  const double out2 = r2 * r2 - r1 * r1 * coaxial_disks(r1, r2, h);
  return 1 - (out1 + out2) / ((r1 + r2) * std::hypot(r2 - r1, h));
}

/// A sphere to a disk of radius r whose axis passes its centre at distance h.
inline double sphere_to_disk(double r, double h) { return (1 - 1 / std::hypot(1, r / h)) / 2; }

/// A sphere to an l1 × l2 rectangle at distance d, its centre over a corner.
inline double sphere_to_rectangle(double l1, double l2, double d) {
  const double D1 = d / l1, D2 = d / l2;
  return std::atan(1 / std::sqrt(D1 * D1 + D2 * D2 + D1 * D1 * D2 * D2)) / (4 * std::numbers::pi);
}

/// The inside of a cylinder of radius r2 to the outside of one of radius r1 in it, both as long as
/// h and open.
inline double outer_to_inner_cylinder(double r1, double r2, double h) {
  const double R = r2 / r1, H = h / r1, A = H * H + R * R - 1, B = H * H - R * R + 1;
  const double ends = std::sqrt((A + 2) * (A + 2) - 4 * R * R) * std::acos(B / (R * A)) +
                      B * std::asin(1 / R) - std::numbers::pi * A / 2;
  return (1 - (std::acos(B / A) - ends / (2 * H)) / std::numbers::pi) / R;
}

/// The same to itself.
inline double outer_cylinder_to_itself(double r1, double r2, double h) {
  const double R = r2 / r1, H = h / r1, R2 = R * R, H2 = H * H, pi = std::numbers::pi;
  const double q = std::sqrt(4 * R2 + H2) / H;
  const double long_one = std::asin((4 * (R2 - 1) + H2 / R2 * (R2 - 2)) / (H2 + 4 * (R2 - 1)));
  const double ends = q * long_one - std::asin((R2 - 2) / R2) + pi / 2 * (q - 1);
  return 1 - 1 / R + 2 / (pi * R) * std::atan(2 * std::sqrt(R2 - 1) / H) - H / (2 * pi * R) * ends;
}

/// Point to a disk of radius r in a parallel plane at distance h, a off its axis (B-13).
inline double point_to_parallel_disk(double a, double r, double h) {
  const double H = h / a, R = r / a, Z = 1 + H * H + R * R;
  return (1 - (Z - 2 * R * R) / std::sqrt(Z * Z - 4 * R * R)) / 2;
}

/// The same if the point looks at the axis, at right angles (B-14).
inline double point_to_perpendicular_disk(double a, double r, double h) {
  const double H = h / a, R = r / a, Z = 1 + H * H + R * R;
  return H / 2 * (Z / std::sqrt(Z * Z - 4 * R * R) - 1);
}

/// Point to a sphere whose centre is H radii away, the angle theta off the normal.
inline double point_to_sphere(double H, double theta) {
  const double s = std::sqrt(H * H - 1), c = std::cos(theta), H2 = H * H;
  if (theta <= std::acos(1 / H)) return c / H2;
  return 0.5 - std::asin(s / (H * std::sin(theta))) / std::numbers::pi +
         (c * std::acos(-s / std::tan(theta)) - s * std::sqrt(1 - H2 * c * c)) /
             (std::numbers::pi * H2);
}

}  // namespace halfshade::test
