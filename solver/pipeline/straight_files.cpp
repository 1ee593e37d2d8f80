#include "solver/pipeline/straight_files.h"

#include "solver/elements/linear_pieces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Of the tolerance: polynomials. Their unknowns grow slowly with what is asked of them, and
/// squares add, for what lines miss of a polynomial has nothing to do with what it misses itself.
/// The number of triangles goes with the inverse of what this leaves.
constexpr double share_of_polynomials = 0.8;
/// Of the polynomials' true error: what is claimed of it at least. Lines take all they are left, so
/// that nothing else makes up for that.
constexpr double claimed_at_least = 0.9;
/// Of the polynomials' error: it adds an eighth to that.
constexpr double little_beside = 0.5;
/// Of the tolerance: less than this does not pay, and polynomials that keep to their share leave
/// more.
constexpr double least_left = 0.1;
/// Rounding must not make it more than the tolerance.
constexpr double just_below = 1 - 1e-6;

/// Of the tolerance, where polynomials are off by that ratio of it: what straight triangles may be.
double share_left(double ratio) {
  double left = 0;
  for (const double beside : {ratio / claimed_at_least, ratio})
    if (left <= least_left && beside < 1) left = std::sqrt(1 - beside * beside);
  return just_below * (left > least_left ? left : little_beside * ratio);
}

/// Of the irradiance.
double left_to_triangles(const SolveOptions& options, const SolveResult& result) {
  const double tolerance = options.tolerance;
  if (result.goal) return share_left(share_of_polynomials) * tolerance;
  const double left = share_left(result.relative_error / tolerance) * tolerance;
  // Elements that were asked for may be more exact than anybody said.
  return options.refine == Refinement::uniform ? std::min(left, little_error(result)) : left;
}

}  // namespace

double tolerance_of_polynomials(const SolveOptions& options) {
  const bool leaves_some = options.straight && options.goal.empty();
  return leaves_some ? share_of_polynomials * options.tolerance : options.tolerance;
}

double little_error(const SolveResult& result) {
  return little_beside * std::max(result.relative_error, invisible_share);
}

StraightCut cut_to(const SolveResult& result, double allowed) {
  return straight_cut(result.irradiance, result.elements.area, allowed, most_straight_triangles);
}

void cut_for_files(const SolveOptions& options, SolveResult& result) {
  const bool has_none = result.irradiance.count() == 0 || options.method == SolveMethod::matrix;
  if (has_none || result.interrupted) return;
  const double left = left_to_triangles(options, result);
  result.straight = cut_to(result, left);
  const bool is_promised = options.refine == Refinement::adaptive;
  const bool is_kept =
      result.goal ? !result.straight.is_limited : error_of_files(result) <= options.tolerance;
  if (!is_promised || is_kept || !result.not_reached.empty()) return;
  result.not_reached = fmt::format(
      "straight triangles (--linear, .vtp, .ply) are off by about {:.2g} of the irradiance instead "
      "of {:.2g}; {}.vtu without --linear holds the polynomials, which are better",
      result.goal ? result.straight.relative_error : error_of_files(result),
      result.goal ? left : options.tolerance,
      result.straight.is_limited
          ? fmt::format("less would take more than {} of them; ", most_straight_triangles)
          : "");
}

bool is_cut(const SolveResult& result) {
  return result.irradiance.count() > 0 &&
         result.straight.along_edge.size() == at(result.irradiance.count());
}

double error_of_triangles(const SolveResult& result, const StraightCut& cut) {
  return result.goal ? result.relative_error
                     : std::hypot(result.relative_error, cut.relative_error);
}

double error_of_files(const SolveResult& result) {
  return is_cut(result) ? error_of_triangles(result, result.straight) : result.relative_error;
}

}  // namespace halfshade
