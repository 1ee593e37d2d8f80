#include "meshing/backprojection/boundary_chains.h"

#include "meshing/backprojection/margins.h"
#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

double rounding_width(const PointView& view, const Vec3& position) {
  return margins::thinnest_part * view.slack_at(position) +
         margins::jitters_of_a_part * view.jitter_at(position);
}

/// Whether both ends of a piece lie on an edge of the outline, as far as rounding can tell.
bool runs_along(const PointView& view, const ArrangedPiece& piece, const OutlineEdge& edge) {
  const Vec3 from = view.corners[at(edge.from)].true_position - view.point();
  const Vec3 to = view.corners[at(edge.to)].true_position - view.point();
  const Vec3 normal = from.cross(to).normalized();
  const auto lies_on = [&](const Vec3& end) {
    const double width = margins::widest_overlap * rounding_width(view, end);
    const Vec3 p = end - view.point();
    // Seen from the point, the edge lies this far off where the end is, and its own ends are passed
    // by so much.
    return std::abs(normal.dot(p)) <= width && from.cross(p).dot(normal) >= -width * from.norm() &&
           p.cross(to).dot(normal) >= -width * to.norm();
  };
  return lies_on(piece.from) && lies_on(piece.to);
}

/// Tells the edges that one visible part may have apart.
std::uint32_t number_of(EdgeId edge, std::size_t edge_count) {
  const auto id = static_cast<std::uint32_t>(edge.id);
  switch (edge.kind) {
    case EdgeId::Kind::edge:
      return id;
    case EdgeId::Kind::cut:
      return static_cast<std::uint32_t>(edge_count) + id;
    case EdgeId::Kind::emitter_edge:
      return ~id;
    case EdgeId::Kind::horizon:
      break;
  }
  return std::uint32_t{1} << 31;
}

/// Adds a straight piece of boundary to an extent.
void add(Extent& extent, const PointView& view, const Vec3& from, const Vec3& to) {
  const Vec3 a = from - view.point(), b = to - view.point(), normal = a.cross(to - from);
  const double sine = normal.norm(), angle = std::atan2(sine, a.dot(b));
  if (sine > 0) extent.flux += 0.5 * angle / sine * normal;
  extent.rounding +=
      angle * std::max(rounding_width(view, from) / a.norm(), rounding_width(view, to) / b.norm());
}

}  // namespace

/// A piece's follower starts where it ends.
void BoundaryChains::join_at_junctions(const ShadowArrangement& arrangement) {
  const auto& all = arrangement.pieces;
  starts_.assign(at(arrangement.junction_count), -1);
  siblings_.assign(all.size(), -1);
  next_.assign(all.size(), -1);
  is_taken_.assign(all.size(), 0);
  for (std::size_t i = all.size(); i-- > 0;) {
    int& start = starts_[at(all[i].start)];
    siblings_[i] = start;
    start = static_cast<int>(i);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    int& start = starts_[at(all[i].end)];
    next_[i] = start;
    if (start < 0) continue;
    is_taken_[at(start)] = 1;
    start = siblings_[at(start)];
  }
}

/// Where three edges all but meet in a point, a piece shorter than rounding may be missing.
void BoundaryChains::join_leftovers(const ShadowArrangement& arrangement, const PointView& view) {
  const auto& all = arrangement.pieces;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (next_[i] >= 0) continue;
    const Vec3 end = all[i].to - view.point();
    double best = HUGE_VAL;
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (is_taken_[j] != 0) continue;
      const Vec3 start = all[j].from - view.point();
      const double gap = (start.normalized() - end.normalized()).norm() *
                         std::min(start.norm() / view.slack_at(all[j].from),
                                  end.norm() / view.slack_at(all[i].to));
      if (gap < best) {
        best = gap;
        next_[i] = static_cast<int>(j);
      }
    }
    is_taken_[at(next_[i])] = 1;
    closed = closed && best <= margins::widest_gap;
  }
}

void BoundaryChains::add_chain(const ShadowArrangement& arrangement, const PointView& view,
                               int first) {
  const auto& all = arrangement.pieces;
  const std::size_t begin = pieces.size();
  Extent chain;
  int i = first;
  do {
    pieces.push_back(all[at(i)]);
    add(chain, view, all[at(i)].from, all[at(i)].to);
    const int next = next_[at(i)];
    next_[at(i)] = -1;
    i = next;
  } while (i != first);
  if (chain.flux.norm() <= chain.rounding) {
    pieces.resize(begin);
    return;
  }
  total_.flux += chain.flux;
  total_.rounding += chain.rounding;
  ends.push_back(static_cast<int>(pieces.size()));
}

void BoundaryChains::link(const ShadowArrangement& arrangement, const PointView& view) {
  pieces.clear();
  ends.clear();
  signature = 0;
  total_ = {};
  closed = true;
  join_at_junctions(arrangement);
  join_leftovers(arrangement, view);
  for (std::size_t i = 0; i < arrangement.pieces.size(); ++i)
    if (next_[i] >= 0) add_chain(arrangement, view, static_cast<int>(i));
  const std::size_t edge_count = view.topology().edges.size();
  // A sum does not depend on where chains start, nor on their order.
  std::size_t first = 0;
  for (const int end : ends) {
    for (std::size_t i = first; i < at(end); ++i) {
      const ArrangedPiece& next = pieces[i + 1 < at(end) ? i + 1 : first];
      const std::uint64_t kind = arrangement.is_crossing(pieces[i].end) ? 0 : 1;
      const std::uint32_t from = number_of(pieces[i].edge, edge_count);
      const std::uint32_t to = number_of(next.edge, edge_count);
      signature += mix_bits(mix_bits(mix_bits(from) + to) + kind);
    }
    first = at(end);
  }
}

bool BoundaryChains::fill(const EmitterOutline& outline, const PointView& view) const {
  Extent whole;
  for (const OutlineEdge& edge : outline.edges)
    add(whole, view, view.corners[at(edge.from)].true_position,
        view.corners[at(edge.to)].true_position);
  if ((whole.flux - total_.flux).norm() > whole.rounding + total_.rounding) return false;
  // The difference of sums cannot tell a small corner that is cut off from nothing.
  return std::all_of(pieces.begin(), pieces.end(), [&](const ArrangedPiece& piece) {
    return piece.edge.is_of_outline() ||
           std::any_of(outline.edges.begin(), outline.edges.end(),
                       [&](const OutlineEdge& edge) { return runs_along(view, piece, edge); });
  });
}

void BoundaryChains::copy(VisiblePart& part) const {
  for (const ArrangedPiece& piece : pieces)
    part.pieces.push_back({piece.from, piece.to, piece.edge});
  part.chain_ends.assign(ends.begin(), ends.end());
}

}  // namespace halfshade
