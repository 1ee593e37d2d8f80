#include "solver/factors/body_sight.h"

#include "meshing/core/plane_frame.h"
#include "solver/factors/body_target.h"
#include "solver/factors/pair_on_lattices.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
namespace {

/// Of what a pair may be off by: if no more is seen, nothing is. What is seen of many pairs, and of
/// the same sign, would add up.
constexpr double share_of_dark = 1. / 16;

/// Sides that face a surface, but for those that nothing comes between.
std::vector<int> sides_in_doubt(const SightScene& scene, const BodyPair& pair,
                                std::span<const int> sides) {
  std::vector<int> doubtful;
  for (const int side : sides)
    if (!std::binary_search(pair.clear.begin(), pair.clear.end(), side) &&
        may_see(scene, pair.surface, side))
      doubtful.push_back(side);
  return doubtful;
}

/// Parts of quadrilaterals that are looked at to tell what all of them see at most, and how often
/// one is halved for that.
constexpr int most_parts_to_tell = 256, most_halvings = 16;

/// What of a body a quadrilateral sees at most, as a mutual area: of parts that are small for their
/// distance from it. Parts that are not, if there are too many, tell nothing.
class SeenAtMost {
 public:
  SeenAtMost(const ConvexBody& shape, BodyTarget& body, Outlines& outlines)
      : shape_(shape), body_(body), outlines_(outlines) {}

  double of(const Quad& quad, int halvings = 0) {
    if (parts_ > most_parts_to_tell || halvings > most_halvings) return HUGE_VAL;
    if (is_small(quad)) {
      ++parts_;
      return area_vector(quad).norm() * body_.seen_at_most(quad, outlines_);
    }
    const bool is_long = (quad[1] - quad[0]).norm() + (quad[2] - quad[3]).norm() >
                         (quad[2] - quad[1]).norm() + (quad[3] - quad[0]).norm();
    const Quad q = is_long ? quad : Quad{quad[1], quad[2], quad[3], quad[0]};
    const Vec3 low = (q[0] + q[1]) / 2, high = (q[2] + q[3]) / 2;
    const double first = of({q[0], low, high, q[3]}, halvings + 1);
    return first < HUGE_VAL ? first + of({low, q[1], q[2], high}, halvings + 1) : first;
  }

 private:
  /// Its sides are shorter than half of what it is off.
  bool is_small(const Quad& quad) const {
    const Ball ball = ball_round(quad);
    const double apart =
        (ball.centre - shape_.ball.centre).norm() - ball.radius - shape_.ball.radius;
    return 2 * ball.radius <= apart;
  }

  const ConvexBody& shape_;
  BodyTarget& body_;
  Outlines& outlines_;
  int parts_ = 0;
};

}  // namespace

std::optional<MutualSight> body_sight(const SightScene& scene, const BodyPair& pair,
                                      std::span<const int> sides, const SightTolerance& tolerance,
                                      std::size_t most_places, const std::stop_token& stop) {
  const SightSurface& own = scene.surfaces[at(pair.surface)];
  // Those that are hidden by one thing alone are no pairs, but hidden.
  const std::vector<int> doubtful = sides_in_doubt(scene, pair, sides);
  BodyTarget body(scene, pair.surface, pair.body, doubtful);
  if (!body.is_applicable()) return {};
  std::vector<Quad> quads;
  for (const Polygon3& piece : own.pieces) add_quads(piece, quads);
  SharedShadows shadows(scene);
  SeenAtMost seen_at_most(scene.bodies[at(pair.body)], body, shadows.outlines());
  double most = 0;
  for (const Quad& quad : quads) most += most < HUGE_VAL ? seen_at_most.of(quad) : 0;
  if (most <= share_of_dark * tolerance.absolute) return MutualSight{0, most, 0, true, false};
  LatticeTarget target;
  target.points_across = body.points_across(quads);
  target.weight_of_jumps = weight_where_alone;
  target.hidden_factor = [&](HiddenFactor& factor) {
    return body.hidden_factor(shadows.outlines(), factor);
  };
  target.unhidden = [&](SightTolerance of_side) {
    of_side.absolute /= static_cast<double>(doubtful.size());
    MutualSight whole;
    for (const int side : doubtful) {
      const MutualSight seen = clear_sight(scene, pair.surface, side, of_side, stop);
      whole.value += seen.value;
      whole.error += seen.error;
    }
    return whole;
  };
  PairOnLattices look(std::move(target), quads.size(), {tolerance, false, most_places});
  look_at({&look}, quads, shadows, stop);
  if (stop.stop_requested()) return {};
  if (look.tells()) return look.sight();
  // No more than a few points saw anything, or all saw all.
  if (!(most <= tolerance.absolute)) return {};
  return MutualSight{std::clamp(look.sight().value, 0., most), most, look.sight().points, true,
                     false};
}

}  // namespace halfshade
