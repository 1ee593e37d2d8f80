#pragma once

#include "solver/factors/mutual_sight.h"
#include "solver/factors/plane_shadows.h"
#include "solver/factors/shaded_target.h"
#include "solver/factors/square_lattice.h"

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <stop_token>
#include <vector>

namespace halfshade {

/// A convex polygon as a fan of them.
void add_quads(const Polygon3& polygon, std::vector<Quad>& quads);

/// LatticeTarget::weight_of_jumps of what is all of an entry, as a rule, where many surfaces are
/// off independently of each other.
constexpr double weight_where_alone = 25;

/// What is looked at.
struct LatticeTarget {
  /// What is hidden of it from where the shadows are. False if that cannot be told.
  std::function<bool(HiddenFactor&)> hidden_factor;
  /// What the surface and it exchange as if nothing were between them.
  std::function<MutualSight(const SightTolerance&)> unhidden;
  double points_across = HUGE_VAL;  ///< points that it takes at least
  /// How many times squares count at jumps, as where things stand on the surface: lattices are no
  /// better than other points there.
  double weight_of_jumps = 1;
};

struct LatticeLimits {
  SightTolerance tolerance;
  bool to_the_end = false;                       ///< though no lattice is expected to be enough
  std::size_t most_places = few_lattice_places;  ///< of a quadrilateral
};

/// A surface and what it looks at, on their way from lattice to lattice.
class PairOnLattices {
 public:
  /// Goes on if there is a lattice that nothing is too narrow for.
  PairOnLattices(LatticeTarget target, std::size_t quads, const LatticeLimits& limits);

  bool goes_on() const { return goes_on_; }
  const MutualSight& sight() const { return sight_; }
  /// Whether its error tells something, small enough or not.
  bool tells() const { return tells_; }

  /// The next place on a quadrilateral; corners apart.
  void look(double weight, std::size_t quad, bool is_corner);
  /// All places of a lattice have been looked at: whether that is enough, or ever will be.
  void settle(const SquareLattice& lattice);

 private:
  /// What it sees from one quadrilateral, times what that stretches the square by.
  struct Values {
    std::vector<double> places, corners;
  };

  void settle_at(const SquareLattice& lattice);
  double share_of_residuals() const;
  double sum_of_values() const;
  double sum_of_squares(const SquareLattice& lattice) const;

  LatticeTarget target_;
  SightTolerance hidden_allowed_;
  bool to_the_end_;
  MutualSight whole_, sight_;
  std::size_t fewest_ = 0, most_ = 0;  ///< points on a quadrilateral
  bool goes_on_ = false, tells_ = false;
  std::size_t not_lit_ = 0, not_dark_ = 0;  // points that find something hidden, or seen
  std::vector<Values> values_;              // by quadrilateral
  std::vector<double> means_;               // by lattice
};

/// Looks at all of some pairs from one lattice after the other. If stopped, they are not done.
void look_at(std::vector<PairOnLattices*> pairs, std::span<const Quad> quads,
             SharedShadows& shadows, const std::stop_token& stop);

}  // namespace halfshade
