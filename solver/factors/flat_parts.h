#pragma once

#include "meshing/core/types.h"

#include <Eigen/Geometry>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// What of a surface is not hidden yet: convex parts in its plane, from which convex shadows are
/// cut off one after the other (Sutherland and Hodgman 1974).
class FlatParts {
 public:
  /// A corner of a part, and what its edge from there lies on.
  struct Corner {
    Vec2 at;
    std::uint32_t border;
  };
  /// Where a·x + b ≤ 0; what is nearer than `near` to 0 lies on its border.
  struct HalfPlane {
    Vec2 a;
    double b, near;
    std::uint32_t border;

    double height(const Vec2& p) const {
      const double h = a.dot(p) + b;
      return std::abs(h) < near ? 0 : h;
    }
  };
  using Box = Eigen::AlignedBox2d;
  static Box everywhere() { return {Vec2::Constant(-HUGE_VAL), Vec2::Constant(HUGE_VAL)}; }

  /// A convex part of the surface, counter-clockwise; its borders count from 0.
  void add(std::span<const Vec2> corners);
  std::span<const Corner> corners_of_all() const { return all_corners_; }
  std::size_t count_of_all() const { return all_parts_.size(); }
  std::span<const Corner> part_of_all(std::size_t k) const {
    return {all_corners_.data() + all_parts_[k].first, all_parts_[k].last - all_parts_[k].first};
  }
  bool is_nothing() const { return all_parts_.empty(); }

  /// As if nothing had been cut off.
  void take_all() {
    corners_ = all_corners_;
    parts_ = all_parts_;
  }
  std::size_t count() const { return parts_.size(); }
  std::span<const Corner> part(std::size_t k) const { return corners_of(parts_[k]); }

  /// Cuts off what lies in all of some half-planes, each of which crosses the surface as a whole;
  /// `use` gets each piece of it. Nothing of it lies outside of `reach`.
  template <class Use>
  void cut_off(std::span<const HalfPlane> shadow, const Box& reach, Use use) {
    const std::size_t count = parts_.size();
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Part part = parts_[k];
      if (!reach.intersects(part.box) || !cut_off(shadow, part))
        parts_[kept++] = part;
      else if (hidden_.size() > 2)
        use(std::span<const Corner>(hidden_));
    }
    parts_.erase(parts_.begin() + static_cast<std::ptrdiff_t>(kept),
                 parts_.begin() + static_cast<std::ptrdiff_t>(count));
  }

 private:
  /// Of `corners_`.
  struct Part {
    std::size_t first, last;
    Box box;
  };
  struct Heights {
    double least, most;
  };

  std::span<const Corner> corners_of(const Part& part) const {
    return {corners_.data() + part.first, part.last - part.first};
  }
  bool cut_off(std::span<const HalfPlane> shadow, const Part& part);
  Heights heights_over(const HalfPlane& plane, std::span<const Corner> corners);
  void split(const HalfPlane& plane);

  std::vector<Corner> all_corners_, corners_, hidden_, inside_;
  std::vector<Part> all_parts_, parts_;
  std::vector<const HalfPlane*> crossing_;  ///< of a shadow's sides, those that cross a part
  std::vector<double> heights_;
};

}  // namespace halfshade
