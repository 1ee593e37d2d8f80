#pragma once

#include "meshing/geometry/shaft.h"
#include "solver/factors/few_blockers.h"
#include "solver/factors/mutual_sight.h"
#include "solver/factors/point_looks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace halfshade {

/// Of numbers; empty at first.
struct Range {
  double least = HUGE_VAL, most = -HUGE_VAL;

  double size() const { return most - least; }
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
  }
  void add(const Range& other) {
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
  /// How far another one reaches out of it.
  double beyond(const Range& other) const {
    return std::max({0., other.most - most, least - other.least});
  }
};

/// A triangle of surface `a` over which is integrated what is hidden of surface `b`.
struct BlockedCell {
  Triangle3 corners;
  int halvings = 0;             ///< of a first cell
  int degree = 0;               ///< of the rule that `value` comes from
  double value = 0;             ///< ∫ hidden part of the point factor, squared scene units
  double error = 0;             ///< estimate of its absolute error
  bool is_lit = false;          ///< its points see all of `b`
  bool is_dark = false;         ///< its points see nothing
  bool is_smooth = false;       ///< the same edges bound what all of its points see
  bool is_exact = false;        ///< `value` is a closed form
  double unsure = 0;            ///< of `error`, what may be seen through gaps if it is dark
  bool may_miss = true;         ///< its points tell little of something that may hide much
  int dark_levels = 0;          ///< times that it or what it is a part of was found dark
  std::uint64_t signature = 0;  ///< of one of its points
  /// Of its points, and of its corners once they were looked at.
  Range hidden, visible, hidden_at_corners, visible_at_corners;
  bool is_steep = false;  ///< what rises before its corners is most that it may be off by
  /// By how much what is hidden, or seen where that is less, changes along its edges, about: from
  /// each corner to the next.
  std::array<double, 3> change = {}, change_at_corners = {};
};

/// Along the edges, of what is linear but for a mean: from its moments over the unit triangle.
std::array<double, 3> change_along_edges(const Vec2& moments);

/// The same of what is known at the corners.
std::array<double, 3> changes(const std::array<double, 3>& at_corners);

/// The edge to halve a cell across, from corner k to the next: the longest of those along which
/// what is seen changes most.
std::size_t edge_to_halve(const BlockedCell& cell);

/// Evaluates cells of one pair of surfaces. All that it is made of must outlive it.
class BlockedCells {
 public:
  BlockedCells(const SightScene& scene, PointLooks& looks, int a, int b,
               const SightTolerance& tolerance, const std::stop_token& stop);

  /// A first look, by the rules of degree 1 and 2.
  BlockedCell look(const Triangle3& corners);

  /// Puts into `next` what is better than the cell alone: itself by a better rule, or parts of it.
  /// With `along_kinks`, it is cut where what is seen of `b` changes, if that is one line.
  void refine(const BlockedCell& cell, bool along_kinks, std::vector<BlockedCell>& next);

  /// At which visible parts were found.
  std::size_t points() const { return points_; }

 private:
  struct Sum;

  HiddenFactor factor_at(const Vec3& point);
  Sum sum_over(const Triangle3& corners, int degree);
  BlockedCell evaluate(const BlockedCell& from, int degree);
  BlockedCell raise(const BlockedCell& cell);
  void estimate(const Sum& sum, BlockedCell& cell);
  void estimate_dark(double whole, BlockedCell& cell);
  double missed(const BlockedCell& cell, double whole);
  void look_at_corners(BlockedCell& cell);
  BlockedCell closed_form(const BlockedCell& dark) const;
  Triangle3 inset_corners(const Triangle3& cell) const;
  void add_halves(const BlockedCell& cell, std::vector<BlockedCell>& next);
  bool add_sides_of_kink(const BlockedCell& cell, std::vector<BlockedCell>& next);
  Vec3 where_sight_changes(Vec3 from, Vec3 to, std::uint64_t signature);

  const SightScene& scene_;
  PointLooks& looks_;
  int a_, b_;
  SightTolerance tolerance_;
  const std::stop_token& stop_;
  std::optional<FewBlockers> few_;
  std::vector<double> heights_;  ///< of things in between: the lowest corner's above `a`
  double size_ = 0;              ///< of `a`
  std::size_t points_ = 0;
};

/// At most what may hide surface `b` from a triangle of surface `a`, as a mutual area: 0 if nothing
/// comes between, else what the two see of all that reaches into their hull. Not a bound to the
/// letter, for it is found from few points. More than `enough` is not summed up.
double hidden_at_most(const SightScene& scene, const Triangle3& part, int a, int b, double enough);

/// The same of one thing, from a triangle with this normal; `shaft` is that to surface `b`.
double hidden_at_most(const Shaft& shaft, const Triangle3& part, const Vec3& normal,
                      const Blocker& blocker);

/// The same of that part of a thing alone that lies over or under the triangle.
double hidden_from_above(const Shaft& shaft, const Triangle3& part, const Vec3& normal,
                         const Blocker& blocker);

}  // namespace halfshade
