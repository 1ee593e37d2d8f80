#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

/// Closed forms of view factors, written down from the literature (Howell's catalogue numbers in
/// brackets) and independent of the code under test.
namespace halfshade::test {

/// Point to a parallel a × b rectangle at distance c, normal through a corner (B-3).
inline double point_parallel_rectangle(double a, double b, double c) {
  const double X = a / c, Y = b / c, p = std::sqrt(1 + X * X), q = std::sqrt(1 + Y * Y);
  return (X / p * std::atan(Y / p) + Y / q * std::atan(X / q)) / (2 * std::numbers::pi);
}

/// Point to any parallel rectangle [x0, x1] × [y0, y1] at distance c, all relative to it: the
/// corners' rectangles added up.
inline double point_parallel_rectangle(double x0, double x1, double y0, double y1, double c) {
  const auto corner = [&](double a, double b) {
    const double f = point_parallel_rectangle(std::abs(a), std::abs(b), c);
    return a * b < 0 ? -f : f;
  };
  return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

/// Point at the origin with normal z to the rectangle 0 ≤ y ≤ b, 0 ≤ z ≤ a in the plane x = c
/// (B-4).
inline double point_perpendicular_rectangle(double a, double b, double c) {
  const double X = a / b, Y = c / b, r = std::sqrt(X * X + Y * Y);
  return (std::atan(1 / Y) - Y / r * std::atan(1 / r)) / (2 * std::numbers::pi);
}

/// Directly opposed a × b rectangles at distance c (C-11).
inline double opposed_rectangles(double a, double b, double c) {
  const double X = a / c, Y = b / c, p = std::sqrt(1 + X * X), q = std::sqrt(1 + Y * Y);
  return 2 / (std::numbers::pi * X * Y) *
         (0.5 * std::log((1 + X * X) * (1 + Y * Y) / (1 + X * X + Y * Y)) +
          X * q * std::atan(X / q) + Y * p * std::atan(Y / p) - X * std::atan(X) -
          Y * std::atan(Y));
}

/// Perpendicular rectangles with a common edge l; the first is w wide, the second h high (C-14).
inline double perpendicular_rectangles(double l, double w, double h) {
  const double W = w / l, H = h / l, W2 = W * W, H2 = H * H, r = std::sqrt(H2 + W2);
  const double logs = std::log((1 + W2) * (1 + H2) / (1 + W2 + H2)) +
                      W2 * std::log(W2 * (1 + W2 + H2) / ((1 + W2) * (W2 + H2))) +
                      H2 * std::log(H2 * (1 + H2 + W2) / ((1 + H2) * (H2 + W2)));
  return (W * std::atan(1 / W) + H * std::atan(1 / H) - r * std::atan(1 / r) + 0.25 * logs) /
         (std::numbers::pi * W);
}

/// Parallel rectangles [x0,x1]×[y0,y1] and [ξ0,ξ1]×[η0,η1] at distance z (C-13).
inline double offset_parallel_rectangles(std::array<double, 2> x, std::array<double, 2> y,
                                         std::array<double, 2> xi, std::array<double, 2> eta,
                                         double z) {
  const auto G = [z](double u, double v) {  // u = x − ξ, v = y − η
    const double s = std::sqrt(u * u + z * z), t = std::sqrt(v * v + z * z);
    return (v * s * std::atan(v / s) + u * t * std::atan(u / t) -
            z * z / 2 * std::log(u * u + v * v + z * z)) /
           (2 * std::numbers::pi);
  };
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t l = 0; l < 2; ++l)
          sum += ((i + j + k + l) % 2 ? -1 : 1) * G(x[i] - xi[l], y[j] - eta[k]);
  return sum / ((x[1] - x[0]) * (y[1] - y[0]));
}

/// Perpendicular rectangles: the first at distances [x0,x1] from the line where the planes meet,
/// over [y0,y1] along it; the second at heights [ξ0,ξ1], over [η0,η1] (C-15).
inline double offset_perpendicular_rectangles(std::array<double, 2> x, std::array<double, 2> y,
                                              std::array<double, 2> xi, std::array<double, 2> eta) {
  const auto G = [](double u, double v, double w) {  // u = x, v = y − η, w = ξ
    const double c = std::sqrt(u * u + w * w), r2 = c * c + v * v;
    const double log_part = r2 > 0 ? (c * c - v * v) / 4 * std::log(r2) : 0;
    return ((c > 0 ? v * c * std::atan(v / c) : 0) - log_part) / (2 * std::numbers::pi);
  };
  double sum = 0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j)
      for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t l = 0; l < 2; ++l)
          sum += ((i + j + k + l) % 2 ? -1 : 1) * G(x[i], y[j] - eta[k], xi[l]);
  return sum / ((x[1] - x[0]) * (y[1] - y[0]));
}

/// Composite Simpson rule, for the one-dimensional integral below.
template <class F>
double simpson(F f, double a, double b, int intervals) {
  const double h = (b - a) / intervals;
  double sum = f(a) + f(b);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 ? 4 : 2) * f(a + i * h);
  return sum * h / 3;
}

/// Rectangles with a common edge c at the angle phi (radians); the first is b wide, the second a
/// (C-16).
inline double inclined_rectangles(double a, double b, double c, double phi) {
  const double A = a / c, B = b / c, co = std::cos(phi), si = std::sin(phi);
  const double C = A * A + B * B - 2 * A * B * co, D = std::sqrt(1 + A * A * si * si);
  const double A2 = A * A, B2 = B * B, cos2 = std::cos(2 * phi), sin2 = std::sin(2 * phi);
  double v = -0.25 * sin2 *
             (A * B * si + (std::numbers::pi / 2 - phi) * (A2 + B2) +
              B2 * std::atan((A - B * co) / (B * si)) + A2 * std::atan((B - A * co) / (A * si)));
  v += 0.25 * si * si *
       ((2 / (si * si) - 1) * std::log((1 + A2) * (1 + B2) / (1 + C)) +
        B2 * std::log(B2 * (1 + C) / (C * (1 + B2))) +
        A2 * std::log(A2 * std::pow(1 + A2, cos2) / (C * std::pow(1 + C, cos2))));
  v += B * std::atan(1 / B) + A * std::atan(1 / A) - std::sqrt(C) * std::atan(1 / std::sqrt(C));
  v += 0.5 * si * sin2 * A * D * (std::atan(A * co / D) + std::atan((B - A * co) / D));
  v += co * simpson(
                [&](double z) {
                  const double s = std::sqrt(1 + z * z * si * si);
                  return s * (std::atan(z * co / s) + std::atan((A - z * co) / s));
                },
                0, B, 2000);
  return v / (std::numbers::pi * B);
}

}  // namespace halfshade::test
