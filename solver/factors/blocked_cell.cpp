#include "solver/factors/blocked_cell.h"

#include "solver/elements/quadrature.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Rules that a cell goes through: the first three on any, the others on smooth ones.
constexpr std::array<int, 5> degrees = {2, 4, 6, 10, 16};
constexpr int highest_symmetric = 6;  // triangle_rule
/// Of what could hide something from points between those looked at, this share is the error where
/// none of them found anything.
constexpr double share_of_unseen = 0.5;
/// What less than this of the most that a thing may hide was found of has been missed.
constexpr double hardly_found = 0.03;
/// Things wider than this, in radii of the cell, do not pass between its points, but a corner of
/// what lies closer above the cell than its radius does; and what is farther away than `near_by`
/// looks alike from all of them.
constexpr double wide = 2;
constexpr double near_by = 1;
/// Things that hide no more than this share of what is allowed are not asked.
constexpr double negligible_share = 0.05;
/// The same of what might be seen through gaps, where nothing is seen; by how often it was looked.
constexpr std::array<double, 6> share_of_gaps = {0.1, 0.01, 1e-3, 1e-4, 1e-5, 0};
constexpr int surely_dark = 100;  ///< instead of such a number: nothing can be seen
/// Of the spread of values, what a first cell may be off by, though two rules agree by chance; half
/// of it after each halving. Less only of smooth cells that three rules have looked at.
constexpr double share_of_spread = 0.1;

/// Where some point sees all or nothing but for this share, most may come from between the points
/// and a corner.
constexpr double nearly_nothing = 0.02;
/// How much of a cell lies outside of the outermost points of its rules, about.
constexpr double share_of_rim = 0.1;
/// Corners are looked at this far in, relative to the cell: at the edges of surfaces, what touches
/// them hides all or nothing. Less far in where a rim so wide is more than this share of what the
/// cell may be off by; but farther than rounding reaches, relative to the surface.
constexpr double most_inset = 1e-4, share_of_inset = 0.1, least_inset = 1e-9;

/// Of what a pair may be off by: what closed forms of dark cells are.
constexpr double share_of_closed_forms = 0.01;

/// Where the least that points find is a larger share of the most, there is no layer before an
/// edge, and cells are halved across the longest. (With a tenth instead, floor and ceiling of a
/// room with a box and a lamp were not done after 300,000 points at 3e-7.)
constexpr double layer = 1e-3;

double area_of(const Triangle3& t) { return 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm(); }

Vec3 place_in(const Triangle3& t, double u, double v) {
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

double length_of(const Triangle3& t) {
  return std::sqrt(std::max(
      {(t[1] - t[0]).squaredNorm(), (t[2] - t[1]).squaredNorm(), (t[0] - t[2]).squaredNorm()}));
}

/// With corners so far in, relative to the cell.
Triangle3 inset(const Triangle3& cell, double depth) {
  const Vec3 centre = (cell[0] + cell[1] + cell[2]) / 3;
  Triangle3 corners = cell;
  for (Vec3& corner : corners) corner += depth * (centre - corner);
  return corners;
}

int next_degree(int degree) { return *std::upper_bound(degrees.begin(), degrees.end(), degree); }

template <class Use>
void for_each_node(int degree, Use use) {
  if (degree <= highest_symmetric) {
    for (const TriangleNode& node : triangle_rule(degree)) use(node.u, node.v, node.weight);
    return;
  }
  const TriangleRule& rule = gauss_rule(degree);
  for (std::size_t k = 0; k < rule.places.size(); ++k)
    use(rule.places[k].x(), rule.places[k].y(), rule.weights[static_cast<Eigen::Index>(k)]);
}

}  // namespace

/// Means over a cell.
struct BlockedCells::Sum {
  double hidden = 0, unobstructed = 0;
  Vec2 hidden_moments = Vec2::Zero(), visible_moments = Vec2::Zero();  ///< about the centre
  Range hidden_range, visible_range;
  bool is_lit = true, is_dark = true, is_smooth = true;
  std::uint64_t signature = 0;

  void join(const Sum& other) {
    hidden_range.add(other.hidden_range);
    visible_range.add(other.visible_range);
    is_lit = is_lit && other.is_lit;
    is_dark = is_dark && other.is_dark;
    is_smooth = is_smooth && other.is_smooth && signature == other.signature;
  }
};

BlockedCells::BlockedCells(const SightScene& scene, PointLooks& looks, int a, int b,
                           const SightTolerance& tolerance, const std::stop_token& stop)
    : scene_(scene), looks_(looks), a_(a), b_(b), tolerance_(tolerance), stop_(stop) {
  for (const Vec3& p : scene.surfaces[at(a)].outline)
    size_ = std::max(size_, (p - scene.surfaces[at(a)].outline.front()).norm());
  few_.emplace(scene, a, b);
  if (!few_->is_applicable()) few_.reset();
  for (std::size_t thing = 0; few_ && thing < few_->things(); ++thing) {
    heights_.push_back(HUGE_VAL);
    for (const Blocker* side : few_->sides(thing))
      for (const Vec3& p : side->corners)
        heights_.back() =
            std::min(heights_.back(), std::abs(scene.surfaces[at(a)].frame.height(p)));
  }
}

HiddenFactor BlockedCells::factor_at(const Vec3& position) {
  ++points_;
  HiddenFactor factor;
  if (few_ && few_->factor(position, factor)) return factor;
  const PointFactor seen = looks_.factor({position, scene_.surfaces[at(a_)].frame.normal}, b_);
  return {seen.unobstructed, seen.unobstructed - seen.visible, seen.visible == 0, seen.signature};
}

BlockedCells::Sum BlockedCells::sum_over(const Triangle3& corners, int degree) {
  if (few_) few_->forget_found();
  Sum sum;
  bool is_first = true;
  for_each_node(degree, [&](double u, double v, double weight) {
    const HiddenFactor factor = factor_at(place_in(corners, u, v));
    sum.hidden += weight * factor.hidden;
    sum.unobstructed += weight * factor.unobstructed;
    const Vec2 from_centre = weight * Vec2(u - 1. / 3, v - 1. / 3);
    sum.hidden_moments += factor.hidden * from_centre;
    sum.visible_moments += factor.visible() * from_centre;
    sum.hidden_range.add(factor.hidden);
    sum.visible_range.add(factor.visible());
    sum.is_lit = sum.is_lit && factor.hidden == 0;
    sum.is_dark = sum.is_dark && factor.is_dark;
    if (is_first) sum.signature = factor.signature;
    sum.is_smooth = sum.is_smooth && factor.signature == sum.signature;
    is_first = false;
  });
  return sum;
}

/// Fills in all but corners, degree, and a first estimate: the difference of two rules.
void BlockedCells::estimate(const Sum& sum, BlockedCell& cell) {
  cell.is_steep = false;
  const double area = area_of(cell.corners);
  cell.hidden = sum.hidden_range;
  cell.visible = sum.visible_range;
  cell.is_lit = sum.is_lit;
  cell.is_dark = sum.is_dark && !sum.is_lit;
  cell.is_smooth = sum.is_smooth;
  cell.signature = sum.signature;
  const bool is_mostly_seen = 2 * sum.hidden < sum.unobstructed;
  const Range& range = is_mostly_seen ? cell.hidden : cell.visible;
  cell.change = {};
  if (range.least < layer * range.most)
    cell.change = change_along_edges(is_mostly_seen ? sum.hidden_moments : sum.visible_moments);
  if (cell.degree < degrees[2] || !cell.is_smooth)
    cell.error = std::max(cell.error,
                          std::ldexp(share_of_spread, -cell.halvings) * area * cell.hidden.size());
  const double all = area * sum.unobstructed;
  // What may hide things is asked only where that could tell more than the rules do.
  if (sum.is_lit ||
      (cell.degree == degrees[0] && share_of_unseen * all - cell.value > cell.error)) {
    const double most = hidden_at_most(scene_, cell.corners, a_, b_, all);
    const double missed = share_of_unseen * std::min(most, all) - cell.value;
    cell.error = sum.is_lit ? missed : std::max(cell.error, missed);
  }
  // The same of what may be seen.
  const double seen = all - cell.value;
  if (few_ && few_->has_only_solids() && !cell.is_dark && cell.degree == degrees[0] &&
      share_of_unseen * all - seen > cell.error) {
    const double most = few_->seen_at_most(inset_corners(cell.corners)) * area;
    cell.error = std::max(cell.error, share_of_unseen * std::min(most, all) - seen);
  }
  if (few_ && !cell.is_dark && !cell.is_lit && cell.may_miss) {
    const double unseen = missed(cell, all);
    cell.may_miss = unseen > 0;
    cell.error = std::max(cell.error, unseen);
  }
  const double little = nearly_nothing * sum.unobstructed;
  if (cell.is_dark)
    estimate_dark(all, cell);
  else if (!cell.is_lit &&
           (cell.is_smooth || cell.hidden.least < little || cell.visible.least < little))
    look_at_corners(cell);
}

/// Where points find something hidden, a strip that lies close before a surface may still hide more
/// from between them: half of the most that each thing may hide that they hardly found. To be
/// called when the points of the cell's last rule have been looked at.
double BlockedCells::missed(const BlockedCell& cell, double whole) {
  const double area = area_of(cell.corners);
  const SightSurface& own = scene_.surfaces[at(a_)];
  const double negligible = negligible_share * tolerance_.absolute * area / own.area;
  const Ball round = ball_round(cell.corners);
  const auto is_beyond = [&](const Blocker* side) {
    const double reach = near_by * round.radius + side->ball.radius;
    return (side->ball.centre - round.centre).squaredNorm() > reach * reach;
  };
  std::optional<Shaft> shaft;
  double sum = 0;
  for (std::size_t thing = 0; thing < few_->things(); ++thing) {
    const double found = few_->found(thing) * area;
    const auto sides = few_->sides(thing);
    const bool is_wide = few_->width(thing) > wide * round.radius;
    if ((is_wide && heights_[thing] > round.radius) ||
        std::all_of(sides.begin(), sides.end(), is_beyond))
      continue;
    double most = 0;
    for (const Blocker* side : sides) most += side->area;
    most = std::min(most, whole);
    if (found >= hardly_found * most || most <= negligible) continue;
    if (!shaft) shaft = make_shaft(cell.corners, few_->target_corners(), 0);
    most = 0;
    for (const Blocker* side : sides)
      most += is_wide ? hidden_from_above(*shaft, cell.corners, own.frame.normal, *side)
                      : hidden_at_most(*shaft, cell.corners, own.frame.normal, *side);
    most = std::min(most, whole);
    if (found >= hardly_found * most || most <= negligible) continue;
    // Others may have hidden it.
    double alone = 0;
    for_each_node(cell.degree, [&](double u, double v, double weight) {
      alone += weight * few_->hidden_by(thing, place_in(cell.corners, u, v));
    });
    if (alone * area < hardly_found * most) sum += share_of_unseen * most;
  }
  return std::min(sum, whole);
}

/// What all points see alike may still rise steeply towards an edge, as in a narrow gap between
/// two surfaces, or be seen otherwise along it: less of that than lies before the outermost points.
/// So may what few of them see a little of.
void BlockedCells::look_at_corners(BlockedCell& cell) {
  const bool was_smooth = cell.is_smooth;
  if (cell.hidden_at_corners.size() < 0) {
    const Triangle3 near = inset_corners(cell.corners);
    const Triangle3 far = inset(cell.corners, most_inset);
    std::array<double, 3> hidden, visible;
    for (std::size_t k = 0; k < 3; ++k) {
      // Kinks that the cell was cut along may pass nearer.
      cell.is_smooth = cell.is_smooth && factor_at(far[k]).signature == cell.signature;
      const HiddenFactor factor = factor_at(near[k]);
      hidden[k] = factor.hidden;
      visible[k] = factor.visible();
      cell.hidden_at_corners.add(hidden[k]);
      cell.visible_at_corners.add(visible[k]);
    }
    cell.change_at_corners = changes(cell.hidden.most < cell.visible.most ? hidden : visible);
  }
  const auto note = [&](const Range& range, const Range& at_corners) {
    const double beyond = range.beyond(at_corners);
    const bool is_steep = beyond > range.size();
    if (!is_steep && !(was_smooth && !cell.is_smooth)) return;
    const double error = share_of_rim * beyond * area_of(cell.corners);
    if (error <= cell.error) return;
    cell.error = error;
    cell.is_steep = is_steep;
    cell.change = cell.change_at_corners;
  };
  note(cell.hidden, cell.hidden_at_corners);
  note(cell.visible, cell.visible_at_corners);
}

/// Where one convex thing hides all of `b` from the corners it hides it from all between them.
/// Where several do, there may be gaps between them.
void BlockedCells::estimate_dark(double whole, BlockedCell& cell) {
  const Triangle3 corners = inset_corners(cell.corners);
  const double bound = few_ ? few_->seen_at_most(corners) * area_of(cell.corners) : HUGE_VAL;
  if (!(bound > 0)) {
    cell.dark_levels = surely_dark;
    return;
  }
  const bool is_bounded = few_ && few_->has_only_solids();
  double seen = 0;
  std::array<double, 3> at_corners;
  for (std::size_t k = 0; k < 3; ++k) {
    at_corners[k] = factor_at(corners[k]).visible();
    seen = std::max(seen, at_corners[k]);
  }
  if (seen > 0) {
    cell.is_dark = cell.is_smooth = false;
    cell.change = changes(at_corners);
    cell.error = std::max(cell.error, share_of_unseen * seen * area_of(cell.corners));
    return;
  }
  // Where faces of one thing meet their common shadows leave gaps that are none.
  if (is_bounded) {
    cell.unsure = share_of_unseen * bound;
    cell.error = std::max(cell.error, cell.unsure);
    return;
  }
  const auto level = std::min(at(cell.dark_levels), share_of_gaps.size() - 1);
  cell.error += share_of_gaps[level] * whole;
  cell.dark_levels = level + 1 < share_of_gaps.size() ? cell.dark_levels + 1 : surely_dark;
}

BlockedCell BlockedCells::evaluate(const BlockedCell& from, int degree) {
  BlockedCell cell = from;
  cell.degree = degree;
  cell.hidden_at_corners = cell.visible_at_corners = {};
  const Sum low = sum_over(cell.corners, degree / 2);
  Sum sum = sum_over(cell.corners, degree);
  cell.value = area_of(cell.corners) * sum.hidden;
  cell.error = area_of(cell.corners) * std::abs(sum.hidden - low.hidden);
  sum.join(low);
  estimate(sum, cell);
  return cell;
}

BlockedCell BlockedCells::raise(const BlockedCell& old) {
  BlockedCell cell = old;
  cell.degree = next_degree(old.degree);
  Sum sum = sum_over(cell.corners, cell.degree);
  cell.value = area_of(cell.corners) * sum.hidden;
  cell.error = std::abs(cell.value - old.value);
  sum.hidden_range.add(old.hidden);
  sum.visible_range.add(old.visible);
  sum.is_smooth = sum.is_smooth && old.is_smooth && sum.signature == old.signature;
  sum.is_lit = sum.is_lit && old.is_lit;
  sum.is_dark = sum.is_dark && old.is_dark;
  estimate(sum, cell);
  return cell;
}

BlockedCell BlockedCells::closed_form(const BlockedCell& dark) const {
  // Many of them must not add up to anything.
  const double share = area_of(dark.corners) / scene_.surfaces[at(a_)].area;
  SightTolerance fine = tolerance_;
  fine.absolute *= share_of_closed_forms * share;
  fine.relative *= share_of_closed_forms;
  const MutualSight all = clear_sight(scene_, dark.corners, b_, fine, stop_);
  BlockedCell cell = dark;
  cell.is_exact = true;
  cell.value = all.value;
  cell.error = all.error;
  return cell;
}

BlockedCell BlockedCells::look(const Triangle3& corners) {
  BlockedCell cell;
  cell.corners = corners;
  return evaluate(cell, degrees[0]);
}

Triangle3 BlockedCells::inset_corners(const Triangle3& cell) const {
  const double allowed = share_of_inset * tolerance_.absolute / area_of(cell);
  const double least = least_inset * size_ / length_of(cell);
  return inset(cell, std::min(most_inset, std::max(allowed, least)));
}

void BlockedCells::add_halves(const BlockedCell& cell, std::vector<BlockedCell>& next) {
  const std::size_t edge = edge_to_halve(cell);
  const Vec3 &p = cell.corners[edge], &q = cell.corners[(edge + 1) % 3],
             &r = cell.corners[(edge + 2) % 3];
  const Vec3 middle = 0.5 * (p + q);
  BlockedCell half = cell;
  half.is_exact = false;
  half.may_miss = true;
  ++half.halvings;
  const bool is_unsure = cell.is_dark && cell.unsure > 0;
  const int degree = cell.is_lit || is_unsure ? degrees[0] : degrees[1];
  for (const Triangle3& corners : {Triangle3{p, middle, r}, Triangle3{middle, q, r}}) {
    half.corners = corners;
    next.push_back(evaluate(half, degree));
  }
}

void BlockedCells::refine(const BlockedCell& cell, bool along_kinks,
                          std::vector<BlockedCell>& next) {
  next.clear();
  if (cell.is_dark && !cell.is_exact && cell.dark_levels == surely_dark)
    return next.push_back(closed_form(cell));
  const bool is_unsure = cell.is_dark && cell.unsure > 0 && cell.unsure >= cell.error;
  const bool can_rise =
      cell.is_smooth || cell.is_dark ? cell.degree < degrees.back() : cell.degree < degrees[1];
  if (!cell.is_lit && !cell.is_exact && !is_unsure && !cell.is_steep && can_rise)
    return next.push_back(raise(cell));
  if (along_kinks && !cell.is_lit && !cell.is_smooth && add_sides_of_kink(cell, next)) return;
  add_halves(cell, next);
}

}  // namespace halfshade
