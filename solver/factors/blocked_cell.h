#pragma once

#include "solver/factors/mutual_sight.h"

namespace halfshade {

/// A triangle of surface `a` over which is integrated what is hidden of surface `b`.
struct BlockedCell {
  Triangle3 corners;
  int degree = 0;          ///< of the rule that `value` comes from; exact_degree: closed form
  double value = 0;        ///< ∫ hidden part of the point factor, squared scene units
  double error = 0;        ///< estimate of its absolute error
  bool is_smooth = false;  ///< the same edges bound what all of its points see
  bool is_dark = false;    ///< its points see nothing
  int halvings = 0;        ///< of a first cell
  int dark_levels = 0;     ///< times that it or what it is a part of was found dark
};

/// Evaluates cells of one pair of surfaces.
class BlockedCells {
 public:
  BlockedCells(const SightScene& scene, int a, int b, const SightTolerance& tolerance)
      : scene_(scene), a_(a), b_(b), tolerance_(tolerance) {}

  /// A first look, by the rules of degree 1 and 2.
  BlockedCell look(const Triangle3& corners);

  /// Puts into `next` what is better than the cell alone: itself with a better rule, or two halves.
  void refine(const BlockedCell& cell, std::vector<BlockedCell>& next);

  std::size_t points() const { return points_; }

 private:
  struct Sum;

  Sum sum_over(const Triangle3& corners, int degree);
  BlockedCell evaluate(const BlockedCell& from, int degree);
  double unseen(const Triangle3& corners, double seen) const;
  BlockedCell closed_form(const BlockedCell& dark) const;

  const SightScene& scene_;
  int a_, b_;
  SightTolerance tolerance_;
  std::size_t points_ = 0;
};

}  // namespace halfshade
