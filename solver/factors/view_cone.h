#pragma once

#include "meshing/geometry/ball.h"

#include <Eigen/Geometry>

#include <cmath>

namespace halfshade {

/// The cone of rays from a point that meet a ball.
class ViewCone {
 public:
  ViewCone() = default;
  ViewCone(const Vec3& point, const Ball& ball) : point_(point), towards_(ball.centre - point) {
    const double distance = towards_.norm(), sine = ball.radius / distance;
    if (!(sine < nearly_all_round)) return;
    secant_ = 1 / std::sqrt(1 - sine * sine);
    tangent_ = sine * secant_;
    towards_ /= distance;
  }

  /// Whether a ball lies outside of it. Balls that fill nearly all of the view leave nothing aside.
  bool is_beside(const Ball& ball) const {
    if (tangent_ == HUGE_VAL) return false;
    const Vec3 to = ball.centre - point_;
    const double along = towards_.dot(to);
    const double reach = along * (tangent_ + of_distance) + ball.radius * secant_ * slightly_more;
    return reach < 0 || (to - along * towards_).squaredNorm() > reach * reach;
  }

 private:
  /// As the sine of half the angle; and balls count as larger by what rounding is.
  static constexpr double nearly_all_round = 0.99, slightly_more = 1 + 1e-9, of_distance = 1e-15;

  Vec3 point_ = Vec3::Zero(), towards_ = Vec3::Zero();  // unit length, if it has a tangent
  double tangent_ = HUGE_VAL, secant_ = 0;              // of half the angle
};

}  // namespace halfshade
