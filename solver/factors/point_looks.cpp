#include "solver/factors/point_looks.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace halfshade {
namespace {

/// So many are kept at most: some 100 MB of the largest.
constexpr std::size_t most_looks = 50000;

/// A border this near to the side of a piece lies on it: relative to the piece, and to the
/// coordinates of the whole. What is seen in between is lost, or seen as well.
constexpr double nearness_of_piece = 1e-10;
constexpr double nearness_of_whole = 1e-13;

// What a border lies on: a side of the piece, the joined surface's own edge or the horizon, or
// an edge that hides things.
constexpr std::uint32_t first_side = 0xffff0000, own_edge = 0xfffffffe, horizon = 0xfffffffd;
constexpr std::uint64_t whole_signature = 0x5b1f3c9d70e2a846, none_signature = 0xc24e9076ad3815fb;

bool hides(std::uint32_t border) { return border < first_side; }

std::uint32_t border_of(const EdgeId& edge) {
  switch (edge.kind) {
    case EdgeId::Kind::horizon:
      return horizon;
    case EdgeId::Kind::emitter_edge:
      return own_edge;
    case EdgeId::Kind::edge:
      return 2 * static_cast<std::uint32_t>(edge.id);
    case EdgeId::Kind::cut:
      return 2 * static_cast<std::uint32_t>(edge.id) + 1;
  }
  return own_edge;
}

}  // namespace

struct PointLooks::Look {
  Region region = Region::away;
  std::vector<Corner> corners;  ///< ring after ring, in the joined surface's frame
  std::vector<int> ring_ends;
};

std::size_t PointLooks::PlaceHash::operator()(const Place& place) const {
  std::uint64_t hash = static_cast<std::uint64_t>(place.joined);
  for (const double x : place.position) hash = mix_bits(hash ^ std::bit_cast<std::uint64_t>(x));
  return hash;
}

PointLooks::PointLooks(const SightScene& scene) : scene_(scene) {}
PointLooks::~PointLooks() = default;

void PointLooks::forget() { looks_.clear(); }

const PointLooks::Look& PointLooks::look(const SurfacePoint& point, int joined) {
  const Vec3& p = point.position;
  if (looks_.size() >= most_looks) looks_.clear();
  std::unique_ptr<Look>& kept = looks_[{joined, {p.x(), p.y(), p.z()}}];
  if (kept) return *kept;
  kept = std::make_unique<Look>();
  Look& look = *kept;
  scene_.light.visible_part(point, joined, part_);
  look.region = part_.region;
  if (look.region != Region::penumbra) return look;
  const PlaneFrame& frame = scene_.joined.sound.surfaces[at(joined)].frame;
  const double height = frame.height(p);
  for (const BoundaryPiece& piece : part_.pieces) {
    const Vec3 direction = piece.from - p;
    look.corners.push_back({frame.to_plane(p - height / frame.normal.dot(direction) * direction),
                            border_of(piece.edge)});
  }
  look.ring_ends = part_.chain_ends;
  return look;
}

/// Leaves what lies left of one side (Sutherland and Hodgman 1974).
void PointLooks::cut_off(const FlatPiece& piece, std::size_t side, double nearness) {
  const Vec2& start = piece.corners[side];
  const Vec2& along = piece.sides[side];
  const std::uint32_t own = first_side + static_cast<std::uint32_t>(side);
  const auto height = [&](const Vec2& p) {
    const double h = cross_2d(along, p - start);
    return std::abs(h) < nearness ? 0 : h;
  };
  next_.clear();
  const Corner* from = &corners_.back();
  double below = height(from->at);
  for (const Corner& to : corners_) {
    const double above = height(to.at);
    const auto crossing = [&] {
      return Vec2(from->at + below / (below - above) * (to.at - from->at));
    };
    if (below >= 0 && above >= 0)
      next_.push_back({from->at, below == 0 && above == 0 ? own : from->border});
    else if (below == 0)
      next_.push_back({from->at, own});
    else if (below > 0) {
      next_.push_back(*from);
      next_.push_back({crossing(), own});
    } else if (above > 0)
      next_.push_back({crossing(), from->border});
    from = &to;
    below = above;
  }
  corners_.swap(next_);
}

PointFactor PointLooks::factor(const SurfacePoint& point, int surface) {
  const SightSurface& target = scene_.surfaces[at(surface)];
  if (target.flat_pieces.empty()) return scene_.light.factor(point, target.joined);
  PointFactor factor;
  const PlaneFrame& frame = target.frame;
  if (!(frame.height(point.position) > 0)) return factor;
  const Look& seen = look(point, target.joined);
  if (seen.region == Region::away) return factor;
  factor.unobstructed = unobstructed_factor(point.position, point.normal, target.rings);
  if (!(factor.unobstructed > 0)) return factor;
  const auto all_or_nothing = [&](bool is_lit) {
    factor.region = is_lit ? Region::lit : Region::umbra;
    factor.visible = is_lit ? factor.unobstructed : 0;
    factor.signature = is_lit ? whole_signature : none_signature;
    return factor;
  };
  if (seen.region != Region::penumbra) return all_or_nothing(seen.region == Region::lit);
  EdgeSum sum(target.rings.front().front() - point.position);
  double twice_area = 0, negligible = 0;
  bool is_cut = false;
  for (std::size_t k = 0; k < target.flat_pieces.size(); ++k) {
    const FlatPiece& piece = target.flat_pieces[k];
    const double nearness =
        nearness_of_piece * piece.size + nearness_of_whole * target.magnitude_in_plane;
    negligible += 8 * nearness * piece.size;
    int first = 0;
    for (const int end : seen.ring_ends) {
      corners_.assign(seen.corners.begin() + first, seen.corners.begin() + end);
      first = end;
      for (std::size_t side = 0; side < piece.corners.size() && corners_.size() > 2; ++side)
        cut_off(piece, side, nearness);
      if (corners_.size() < 3) continue;
      const Corner* before = &corners_[corners_.size() - 2];
      const Corner* from = &corners_.back();
      Vec3 a = frame.to_space(from->at) - point.position;
      for (const Corner& to : corners_) {
        if (hides(from->border) || from->border == horizon) {
          is_cut = is_cut || hides(from->border);
          factor.signature +=
              mix_bits(mix_bits(mix_bits(before->border + (k << 32)) + from->border) + to.border);
        }
        twice_area += cross_2d(from->at - piece.corners[0], to.at - piece.corners[0]);
        const Vec3 b = frame.to_space(to.at) - point.position;
        sum.add(a, b);
        before = from;
        from = &to;
        a = b;
      }
    }
  }
  if (!is_cut) return all_or_nothing(twice_area > negligible);
  factor.region = Region::penumbra;
  factor.visible = std::clamp(sum.form_factor(point.normal), 0., factor.unobstructed);
  return factor;
}

}  // namespace halfshade
