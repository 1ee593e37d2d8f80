#include "solver/factors/pair_on_lattices.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
namespace {

/// Of what a pair may be off by: what closed forms take little for.
constexpr double share_of_unhidden = 0.1;

/// The estimate is at least this share of what Σ d² tells, for lattices are better than points that
/// know nothing of each other,
constexpr double least_share = 0.75;
/// and all of it where no more points than this find something hidden, or something seen: twice as
/// much where half as many do. What few points find may rise steeply between them.
constexpr double few_points = 30;

/// What is off by more than this share of the range of values lies at a jump.
constexpr double share_of_jump = 0.25;

/// Fewer than this say nothing.
constexpr std::size_t too_few_points = 4;

/// Nor is the estimate less than what the lattices before differ by, from the last one on, times
/// this: more than a lattice gains on the one before, for what they differ by may be little by
/// chance.
constexpr std::array<double, 3> share_of_change = {1.6, 0.8, 0.4};

/// Points of a trial.
constexpr std::size_t few_to_try = 64;

/// The estimate shrinks with this power of the number of points, at least.
constexpr double decay = 1.25;

/// A place in a quadrilateral, bilinear in (u, v), and the area of the square's image there.
struct Place {
  Vec3 position;
  double weight;
};

Place place_in(const Quad& q, const Vec2& at) {
  const double u = at.x(), v = at.y();
  const Vec3 low = q[1] - q[0], left = q[3] - q[0], twist = q[2] - q[3] - low;
  return {q[0] + u * low + v * left + u * v * twist,
          (low + v * twist).cross(left + u * twist).norm()};
}

}  // namespace

void add_quads(const Polygon3& polygon, std::vector<Quad>& quads) {
  for (std::size_t k = 1; k + 1 < polygon.size(); k += 2) {
    if (k + 2 < polygon.size())
      quads.push_back({polygon[0], polygon[k], polygon[k + 1], polygon[k + 2]});
    else
      quads.push_back({polygon[0], polygon[0], polygon[k], polygon[k + 1]});
  }
}

PairOnLattices::PairOnLattices(LatticeTarget target, std::size_t quads, const LatticeLimits& limits)
    : target_(std::move(target)),
      hidden_allowed_(limits.tolerance),
      to_the_end_(limits.to_the_end) {
  sight_.is_reached = false;
  SightTolerance unhidden = limits.tolerance;
  unhidden.relative *= share_of_unhidden;
  unhidden.absolute *= share_of_unhidden;
  hidden_allowed_.relative -= unhidden.relative;
  hidden_allowed_.absolute -= unhidden.absolute;
  const auto limit = static_cast<std::size_t>(limits.tolerance.max_points);
  const std::size_t of_all = limit / std::max<std::size_t>(quads, 1);
  most_ = std::min({limits.most_places, limit, std::max(few_lattice_places, of_all)});
  if (limits.tolerance.is_trial) most_ = std::min(most_, few_to_try);
  goes_on_ = target_.points_across <= static_cast<double>(most_) && places_of_lattice(0) <= most_;
  if (!goes_on_) return;
  fewest_ = static_cast<std::size_t>(target_.points_across);
  whole_ = target_.unhidden(unhidden);
}

void PairOnLattices::look(double weight, std::size_t quad, bool is_corner) {
  HiddenFactor factor;
  goes_on_ = target_.hidden_factor(factor) && goes_on_;
  if (factor.hidden > 0) ++not_lit_;
  if (!factor.is_dark) ++not_dark_;
  if (quad == values_.size()) values_.emplace_back();
  (is_corner ? values_[quad].corners : values_[quad].places).push_back(weight * factor.hidden);
  ++sight_.points;
}

void PairOnLattices::settle(const SquareLattice& lattice) {
  settle_at(lattice);
  if (2 * lattice.places.size() > most_) goes_on_ = false;
  if (!goes_on_) std::vector<Values>().swap(values_);
}

void PairOnLattices::settle_at(const SquareLattice& lattice) {
  const double count = static_cast<double>(lattice.places.size());
  means_.push_back(sum_of_values() / count);
  if (lattice.places.size() < fewest_) return;
  double error = share_of_residuals() * std::sqrt(sum_of_squares(lattice)) / count;
  for (std::size_t k = 0; k < share_of_change.size() && k + 1 < means_.size(); ++k)
    error = std::max(error,
                     share_of_change[k] * std::abs(means_.back() - means_[means_.size() - 2 - k]));
  sight_.value = std::max(0., whole_.value - means_.back());
  sight_.error = whole_.error + error;
  const double allowed = hidden_allowed_.allowed(sight_.value);
  tells_ = goes_on_ && std::min(not_lit_, not_dark_) >= too_few_points;
  sight_.is_reached = tells_ && error <= allowed;
  const double needed = count * std::pow(error / allowed, 1 / decay);
  const bool may_tell = goes_on_ && not_lit_ > 0 && not_dark_ > 0;
  const bool is_hopeless = !to_the_end_ && needed > static_cast<double>(most_);
  goes_on_ = may_tell && !sight_.is_reached && !is_hopeless;
}

double PairOnLattices::share_of_residuals() const {
  return std::max(least_share, few_points / static_cast<double>(std::min(not_lit_, not_dark_)));
}

double PairOnLattices::sum_of_values() const {
  double sum = 0;
  for (const Values& values : values_)
    for (const double value : values.places) sum += value;
  return sum;
}

/// Of what places and corners are off from the places round them.
double PairOnLattices::sum_of_squares(const SquareLattice& lattice) const {
  double sum = 0;
  for (const auto& [places, corners] : values_) {
    const auto [least, most] = std::minmax_element(places.begin(), places.end());
    const double jump = share_of_jump * (*most - *least);
    const auto note = [&](double value, const SquareLattice::Watch& watch) {
      for (std::size_t k = 0; k < SquareLattice::Watch::count; ++k)
        value -= watch.weight[k] * places[at(watch.near[k])];
      sum += (std::abs(value) > jump ? target_.weight_of_jumps : 1) * value * value;
    };
    for (std::size_t k = 0; k < places.size(); ++k) note(places[k], lattice.inner[k]);
    for (std::size_t k = 0; k < corners.size(); ++k) note(corners[k], lattice.corners[k]);
  }
  return sum;
}

/// Looks at all of some pairs from one lattice after the other.
void look_at(std::vector<PairOnLattices*> pairs, std::span<const Quad> quads,
             SharedShadows& shadows, const std::stop_token& stop) {
  std::size_t first = 0;
  for (std::size_t level = 0; level < lattice_levels; ++level) {
    std::erase_if(pairs, [](const PairOnLattices* pair) { return !pair->goes_on(); });
    if (pairs.empty()) return;
    const SquareLattice& lattice = square_lattice(level);
    for (std::size_t q = 0; q < quads.size(); ++q) {
      const auto look_from = [&](const Vec2& at, bool is_corner) {
        if (stop.stop_requested()) return;
        const Place place = place_in(quads[q], at);
        shadows.move_to(place.position);
        for (PairOnLattices* pair : pairs) pair->look(place.weight, q, is_corner);
      };
      for (std::size_t k = first; k < lattice.places.size(); ++k)
        look_from(lattice.places[k], false);
      for (std::size_t k = 0; level == 0 && k < lattice.corners.size(); ++k)
        look_from(lattice.corner(k), true);
    }
    if (stop.stop_requested()) return;
    for (PairOnLattices* pair : pairs) pair->settle(lattice);
    first = lattice.places.size();
  }
}

}  // namespace halfshade
