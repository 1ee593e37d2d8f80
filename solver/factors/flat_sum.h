#pragma once

#include "meshing/core/types.h"

#include <cmath>
#include <numbers>

namespace halfshade {

/// θ/sin θ for an angle whose cosine is given; exact to rounding up to where sin θ gets lost, from
/// 90° on by `cross`, the length of the cross product, and `dot` of any vectors that make it.
inline double angle_over_sine(double cosine, double cross, double dot) {
  if (!(cosine > 0)) return std::atan2(cross, dot) / (cross / std::hypot(cross, dot));
  // Chebyshev's fit of arcsin √x / √(x (1 − x)) on [0, 1/16], x = sin² θ/2, to 5e-17.
  constexpr double most = 1. / 16;
  double x = 0.5 * (1 - cosine), factor = 1;
  while (x > most) {
    // θ/sin θ = (θ/2)/sin(θ/2) / cos(θ/2)
    const double half = std::sqrt(1 - x);
    factor /= half;
    x = 0.5 * (1 - half);
  }
  const double x2 = x * x, x4 = x2 * x2;
  const double low =
      1 + 0.6666666666665592784 * x + x2 * (0.53333333337906679134 + 0.45714284965716127028 * x);
  const double high = 0.40634981876573498242 + 0.36938031616196655495 * x +
                      x2 * (0.34174313656705135512 + 0.30667133979364776254 * x);
  return factor * (low + x4 * (high + 0.39348549697643638552 * x4));
}

/// Lambert's edge sum over polygons in one plane, from a point before it, all in the plane's frame:
/// without the care of EdgeSum for what lies at the horizon, for absolute errors.
class FlatSum {
 public:
  /// `point` and unit `normal` in the frame of the plane.
  FlatSum(const Vec3& point, const Vec3& normal)
      : point_(point), normal_(normal), height2_(point.z() * point.z()) {}

  /// Next corner of a polygon, counter-clockwise; the first one comes last again.
  void start(const Vec2& corner) {
    from_ = corner - point_.head<2>();
    length2_ = from_.squaredNorm() + height2_;
  }
  void add(const Vec2& corner) {
    const Vec2 to = corner - point_.head<2>(), along = to - from_;
    const double length2 = to.squaredNorm() + height2_;
    const double both = length2_ * length2;
    // n · (a × b), with the third coordinate of both − height.
    const double turn = from_.x() * along.y() - from_.y() * along.x();
    const double moment =
        point_.z() * (normal_.x() * along.y() - normal_.y() * along.x()) + normal_.z() * turn;
    if (both > 0) {
      const double scale = 1 / std::sqrt(both), dot = from_.dot(to) + height2_;
      const double cosine = dot * scale;
      const double cross = cosine > 0 ? 0 : std::sqrt(height2_ * along.squaredNorm() + turn * turn);
      if (cosine > 0 || cross > 0) sum_ += angle_over_sine(cosine, cross, dot) * scale * moment;
    }
    from_ = to;
    length2_ = length2;
  }

  /// Form factor to the polygons.
  double form_factor() const { return -sum_ / (2 * std::numbers::pi); }

 private:
  Vec3 point_, normal_;
  double height2_, length2_ = 0, sum_ = 0;
  Vec2 from_ = Vec2::Zero();
};

}  // namespace halfshade
