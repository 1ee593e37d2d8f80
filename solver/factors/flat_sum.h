#pragma once

#include "meshing/core/types.h"

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace halfshade {

/// sin² θ/2 of angles for which a polynomial tells θ/sin θ, at most.
constexpr double small_angle = 1. / 16;

/// θ/sin θ by x = sin² θ/2 of one angle, or of several: Chebyshev's fit of
/// arcsin √x / √(x (1 − x)) on [0, 1/16], to 5e-17.
template <class Number>
inline Number small_angle_over_sine(const Number& x) {
  const Number x2 = x * x, x4 = x2 * x2;
  const Number low =
      1 + 0.6666666666665592784 * x + x2 * (0.53333333337906679134 + 0.45714284965716127028 * x);
  const Number high = 0.40634981876573498242 + 0.36938031616196655495 * x +
                      x2 * (0.34174313656705135512 + 0.30667133979364776254 * x);
  return low + x4 * (high + 0.39348549697643638552 * x4);
}

/// θ/sin θ for an angle whose cosine is given; exact to rounding up to where sin θ gets lost, from
/// 90° on by `cross`, the length of the cross product, and `dot` of any vectors that make it.
inline double angle_over_sine(double cosine, double cross, double dot) {
  if (!(cosine > 0)) return std::atan2(cross, dot) / (cross / std::hypot(cross, dot));
  double x = 0.5 * (1 - cosine), factor = 1;
  while (x > small_angle) {
    // θ/sin θ = (θ/2)/sin(θ/2) / cos(θ/2)
    const double half = std::sqrt(1 - x);
    factor /= half;
    x = 0.5 * (1 - half);
  }
  return factor * small_angle_over_sine(x);
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

/// The same over edges of any polygons in a plane, two at once.
class FlatEdges {
 public:
  void clear() { count_ = 0; }

  /// Of a polygon, counter-clockwise.
  void add(const double* x, const double* y, std::size_t count) {
    if (count == 0) return;
    reserve(count_ + count);
    for (std::size_t from = count - 1, to = 0; to < count; from = to++)
      append(x[from], y[from], x[to], y[to]);
  }

  /// Of one that does not count.
  void subtract(const double* x, const double* y, std::size_t count) {
    if (count == 0) return;
    reserve(count_ + count);
    for (std::size_t from = count - 1, to = 0; to < count; from = to++)
      append(x[to], y[to], x[from], y[from]);
  }

  /// From a point, with a unit normal, in the frame of the plane.
  double form_factor(const Vec3& point, const Vec3& normal) {
    if (count_ == 0) return 0;
    // One of no length makes their number even.
    reserve(count_ + 1);
    if (count_ % 2 == 1)
      append(from_x_[count_ - 1], from_y_[count_ - 1], from_x_[count_ - 1], from_y_[count_ - 1]);
    const double height2 = point.z() * point.z();
    Two sum = Two::Zero();
    for (std::size_t k = 0; k < count_; k += 2) {
      const Two from_x = two(from_x_, k) - point.x(), from_y = two(from_y_, k) - point.y();
      const Two to_x = two(to_x_, k) - point.x(), to_y = two(to_y_, k) - point.y();
      const Two along_x = to_x - from_x, along_y = to_y - from_y;
      const Two turn = from_x * along_y - from_y * along_x;
      const Two moment =
          point.z() * (normal.x() * along_y - normal.y() * along_x) + normal.z() * turn;
      const Two both =
          (from_x * from_x + from_y * from_y + height2) * (to_x * to_x + to_y * to_y + height2);
      const Two scale = both.sqrt().inverse();
      const Two dot = from_x * to_x + from_y * to_y + height2, cosine = dot * scale;
      const Two half = 0.5 * (1 - cosine);
      if (half[0] <= small_angle && half[1] <= small_angle) {
        sum += small_angle_over_sine(half) * scale * moment;
        continue;
      }
      const Two cross = (height2 * (along_x * along_x + along_y * along_y) + turn * turn).sqrt();
      for (const Eigen::Index i : {0, 1})
        if (both[i] > 0 && (cosine[i] > 0 || cross[i] > 0))
          sum[i] += angle_over_sine(cosine[i], cross[i], dot[i]) * scale[i] * moment[i];
    }
    return -(sum[0] + sum[1]) / (2 * std::numbers::pi);
  }

 private:
  using Two = Eigen::Array2d;

  static Two two(const std::vector<double>& values, std::size_t k) {
    return Eigen::Map<const Two>(values.data() + k);
  }
  void reserve(std::size_t count) {
    if (from_x_.size() < count)
      for (std::vector<double>* values : {&from_x_, &from_y_, &to_x_, &to_y_})
        values->resize(2 * count);
  }
  void append(double from_x, double from_y, double to_x, double to_y) {
    from_x_[count_] = from_x;
    from_y_[count_] = from_y;
    to_x_[count_] = to_x;
    to_y_[count_++] = to_y;
  }

  std::size_t count_ = 0;
  std::vector<double> from_x_, from_y_, to_x_, to_y_;
};

}  // namespace halfshade
