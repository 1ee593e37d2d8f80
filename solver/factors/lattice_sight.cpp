#include "solver/factors/lattice_sight.h"

#include "solver/factors/few_blockers.h"
#include "solver/factors/square_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace halfshade {
namespace {

/// Of what a pair may be off by: what closed forms take little for.
constexpr double share_of_unhidden = 0.1;

/// The estimate shrinks with this power of the number of points, at least.
constexpr double decay = 1.25;

using Quad = std::array<Vec3, 4>;

/// A fan of quadrilaterals; a triangle is one with two corners in one place.
void add_quads(const Polygon3& polygon, std::vector<Quad>& quads) {
  for (std::size_t k = 1; k + 1 < polygon.size(); k += 2) {
    if (k + 2 < polygon.size())
      quads.push_back({polygon[0], polygon[k], polygon[k + 1], polygon[k + 2]});
    else
      quads.push_back({polygon[0], polygon[0], polygon[k], polygon[k + 1]});
  }
}

/// The longest side.
double size_of(std::span<const Quad> quads) {
  double size = 0;
  for (const Quad& q : quads)
    for (std::size_t k = 0; k < 4; ++k) size = std::max(size, (q[(k + 1) % 4] - q[k]).norm());
  return size;
}

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

/// A pair on its way from lattice to lattice.
class PairOnLattices {
 public:
  PairOnLattices(const SightScene& scene, int a, const LatticePair& pair)
      : few_(scene, a, pair.other, {pair.blockers.begin(), pair.blockers.end()}),
        hidden_allowed_(pair.tolerance),
        goes_on_(few_.is_applicable()) {
    sight_.is_reached = false;
    if (!goes_on_) return;
    SightTolerance unhidden = pair.tolerance;
    unhidden.relative *= share_of_unhidden;
    unhidden.absolute *= share_of_unhidden;
    hidden_allowed_.relative -= unhidden.relative;
    hidden_allowed_.absolute -= unhidden.absolute;
    whole_ = clear_sight(scene, a, pair.other, unhidden);
  }

  /// Begins with a lattice that neither the other surface nor anything in between is too narrow
  /// for: shadows are wider than what casts them. `size` is that of the largest quadrilateral.
  void begin(double size) {
    const auto lattices = square_lattices();
    const auto is_too_wide = [&](const SquareLattice& lattice) {
      return size / std::sqrt(static_cast<double>(lattice.places.size())) > few_.narrowest();
    };
    while (goes_on_ && is_too_wide(lattices[level_])) go_on();
    goes_on_ = goes_on_ && is_affordable();
  }

  bool goes_on() const { return goes_on_; }
  std::size_t level() const { return level_; }  ///< of the lattice that comes next
  const MutualSight& sight() const { return sight_; }

  /// The next place on a quadrilateral.
  void look(Silhouettes& silhouettes, double weight) {
    HiddenFactor factor;
    goes_on_ = few_.hidden_factor(silhouettes, factor) && goes_on_;
    is_lit_ = is_lit_ && factor.hidden == 0;
    is_dark_ = is_dark_ && factor.is_dark;
    values_.push_back(weight * factor.hidden);
  }

  /// All places of the lattice and then its corners have been looked at.
  void end_quad(const SquareLattice& lattice) {
    const auto note = [&](double value, const SquareLattice::Watch& watch) {
      for (std::size_t k = 0; k < SquareLattice::Watch::count; ++k)
        value -= watch.weight[k] * values_[at(watch.near[k])];
      square_ += value * value;
    };
    const std::size_t count = lattice.places.size();
    for (std::size_t k = 0; k < count; ++k) {
      sum_ += values_[k];
      note(values_[k], lattice.inner[k]);
    }
    for (std::size_t k = 0; k < lattice.corners.size(); ++k)
      note(values_[count + k], lattice.corners[k]);
    sight_.points += values_.size();
    values_.clear();
  }

  /// All quadrilaterals have been looked at: whether that is enough, or which lattice is likely to
  /// be.
  void settle() {
    const auto lattices = square_lattices();
    const double count = static_cast<double>(lattices[level_].places.size());
    const double error = std::sqrt(square_) / count;
    sight_.value = std::max(0., whole_.value - sum_ / count);
    sight_.error = whole_.error + error;
    const double allowed =
        std::max(hidden_allowed_.absolute, hidden_allowed_.relative * sight_.value);
    sight_.is_reached = goes_on_ && error <= allowed && !is_lit_ && !is_dark_;
    goes_on_ = goes_on_ && !sight_.is_reached && !is_lit_ && !is_dark_;
    sum_ = square_ = 0;
    is_lit_ = is_dark_ = true;
    const double needed = count * std::pow(error / allowed, 1 / decay);
    while (goes_on_ && static_cast<double>(lattices[level_].places.size()) < needed) go_on();
    goes_on_ = goes_on_ && is_affordable();
  }

 private:
  void go_on() { goes_on_ = ++level_ < square_lattices().size(); }
  bool is_affordable() const {
    return square_lattices()[level_].places.size() <= at(hidden_allowed_.max_points);
  }

  FewBlockers few_;
  SightTolerance hidden_allowed_;
  MutualSight whole_, sight_;
  std::size_t level_ = 0;
  bool goes_on_;
  // Of one lattice:
  double sum_ = 0, square_ = 0;
  bool is_lit_ = true, is_dark_ = true;
  std::vector<double> values_;  // on one quadrilateral
};

/// Looks at all of some pairs from one lattice.
void look_at(std::span<PairOnLattices* const> pairs, std::span<const Quad> quads,
             const SquareLattice& lattice, Silhouettes& silhouettes) {
  for (const Quad& quad : quads) {
    const auto look_from = [&](const Vec2& at) {
      const Place place = place_in(quad, at);
      silhouettes.move_to(place.position);
      for (PairOnLattices* pair : pairs) pair->look(silhouettes, place.weight);
    };
    for (const Vec2& at : lattice.places) look_from(at);
    for (std::size_t k = 0; k < lattice.corners.size(); ++k) look_from(lattice.corner(k));
    for (PairOnLattices* pair : pairs) pair->end_quad(lattice);
  }
  for (PairOnLattices* pair : pairs) pair->settle();
}

/// What of a surface lies before the plane of another; `is_all` if nothing but rounding lies
/// behind.
struct PartBefore {
  std::vector<Quad> quads;
  bool is_all = true;
};

PartBefore part_before(const SightSurface& surface, const SightSurface& other) {
  const double margin = tolerance_of(joint_scale(surface.scale, other.scale)).length;
  const PlaneFrame& plane = other.frame;
  PartBefore part;
  for (const Polygon3& piece : surface.pieces) {
    const bool is_before = std::all_of(piece.begin(), piece.end(),
                                       [&](const Vec3& p) { return plane.height(p) >= -margin; });
    add_quads(is_before ? piece : clip_to_front(piece, plane.origin, plane.normal), part.quads);
    part.is_all = part.is_all && is_before;
  }
  return part;
}

}  // namespace

std::vector<std::optional<MutualSight>> lattice_sight(const SightScene& scene, int a,
                                                      std::span<const LatticePair> pairs) {
  const SightSurface& own = scene.surfaces[at(a)];
  std::vector<Quad> all;
  for (const Polygon3& piece : own.pieces) add_quads(piece, all);
  // Pairs that look from all of the surface share their points.
  std::vector<std::unique_ptr<PairOnLattices>> looks;
  std::vector<PairOnLattices*> from_all;
  Silhouettes silhouettes(scene);
  const auto lattices = square_lattices();
  for (const LatticePair& pair : pairs) {
    looks.push_back(nullptr);
    if (!in_all_cells_of(scene, a, pair.other)) continue;
    looks.back() = std::make_unique<PairOnLattices>(scene, a, pair);
    PairOnLattices* look = looks.back().get();
    const PartBefore part = part_before(own, scene.surfaces[at(pair.other)]);
    look->begin(size_of(part.quads));
    if (part.is_all) {
      from_all.push_back(look);
      continue;
    }
    while (look->goes_on()) look_at({&look, 1}, part.quads, lattices[look->level()], silhouettes);
  }
  std::vector<PairOnLattices*> now;
  for (std::size_t level = 0; level < lattices.size(); ++level) {
    now.clear();
    for (PairOnLattices* look : from_all)
      if (look->goes_on() && look->level() == level) now.push_back(look);
    if (!now.empty()) look_at(now, all, lattices[level], silhouettes);
  }
  std::vector<std::optional<MutualSight>> result;
  for (const auto& look : looks) {
    result.emplace_back();
    if (look && look->sight().is_reached) result.back() = look->sight();
  }
  return result;
}

}  // namespace halfshade
