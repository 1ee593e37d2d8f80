#pragma once

#include "meshing/core/plane_frame.h"
#include "meshing/core/types.h"

#include <array>
#include <span>

namespace halfshade {

/// A point with a normal above a plane, in the plane's coordinates.
struct PointAbovePlane {
  Vec2 foot;      ///< below it
  double height;  ///< > 0
  Vec3 normal;    ///< unit; the third coordinate is along the plane's normal
};

PointAbovePlane above_plane(const Vec3& position, const Vec3& normal, const PlaneFrame& plane);

/// The irradiance there per unit of radiosity and area at a point of the plane: cos θ cos θ' /
/// (π r²); negative below the horizon of the normal.
inline double irradiance_kernel(const PointAbovePlane& from, const Vec2& y) {
  const Vec2 d = y - from.foot;
  const double square = d.squaredNorm() + from.height * from.height;
  const double cosine =
      from.normal.x() * d.x() + from.normal.y() * d.y() - from.normal.z() * from.height;
  return cosine * from.height / (M_PI * square * square);
}

/// x to the power of n ≥ 0, in a fraction of std::pow's time.
inline double whole_power(double x, int n) {
  double result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1) result *= x;
  return result;
}

/// Most monomials of a moment: 1, s, t, s², st, t², s³, s²t, st², t³, as in QuickField.
inline constexpr int most_moments = 10;

/// ∫ kernel · s^a t^b over polygons, s and t the coordinates in a triangle (see TrianglePlace).
/// By rules whose degree follows from size and distance, on parts of the polygon where it is close.
class KernelMoments {
 public:
  /// `order` ≤ 3 is that of the highest monomials; `tolerance` is for each part, absolute, times a
  /// small constant. `cell` are corners in the plane's coordinates.
  KernelMoments(const PointAbovePlane& from, const std::array<Vec2, 3>& cell, int order,
                double tolerance);

  /// Over the inside of a ring: what runs clockwise counts negative.
  void add(std::span<const Vec2> ring);

  /// Over a triangle.
  void add(const Vec2& a, const Vec2& b, const Vec2& c);

  std::span<const double> values() const { return {values_.data(), count_}; }

 private:
  void add_part(const Vec2& a, const Vec2& b, const Vec2& c, double area, int depth);

  PointAbovePlane from_;
  Vec2 origin_;
  Eigen::Matrix2d to_place_;
  int order_;
  std::size_t count_;
  double tolerance_;
  std::array<double, most_moments> values_{};
};

}  // namespace halfshade
