#include "solver/factors/blocked_cell.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Where a cell's corners are looked at: this far in, relative to its size, for they may lie on
/// kinks that it was cut along.
constexpr double kink_inset = 0.01;
/// Times that an edge is halved to find a kink on it: nearer than corners are looked at later.
constexpr int searches = 22;
/// A cut nearer to a corner than this, relative to the edge, is no cut.
constexpr double nearest_cut = 1e-3;

/// Where the line through p and q meets the edge from a to b, all in one plane: 0 … 1 along it, or
/// outside.
double meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& normal) {
  const Vec3 across = normal.cross(q - p);
  const double from = across.dot(a - p), to = across.dot(b - p);
  return from / (from - to);
}

}  // namespace

/// On the segment, next to where the signature is no longer the one at `from`.
Vec3 BlockedCells::where_sight_changes(Vec3 from, Vec3 to, std::uint64_t signature) {
  for (int k = 0; k < searches; ++k) {
    const Vec3 middle = 0.5 * (from + to);
    (factor_at(middle).signature == signature ? from : to) = middle;
  }
  return 0.5 * (from + to);
}

/// Straight curves, which all are across which the slope jumps, part a cell in two: what one corner
/// sees is bounded by other edges than what the other two see. Cuts that corner off; elsewhere
/// false.
bool BlockedCells::add_sides_of_kink(const BlockedCell& cell, std::vector<BlockedCell>& next) {
  const Triangle3& corners = cell.corners;
  const Vec3 centre = (corners[0] + corners[1] + corners[2]) / 3;
  Triangle3 inner;
  std::array<std::uint64_t, 3> signature;
  for (std::size_t k = 0; k < 3; ++k) {
    inner[k] = corners[k] + kink_inset * (centre - corners[k]);
    signature[k] = factor_at(inner[k]).signature;
  }
  // The corner that sees something else than the two others, which see the same.
  std::size_t apart = 0;
  while (apart < 3 && !(signature[(apart + 1) % 3] == signature[(apart + 2) % 3] &&
                        signature[apart] != signature[(apart + 1) % 3]))
    ++apart;
  if (apart == 3) return false;
  const std::size_t b = (apart + 1) % 3, c = (apart + 2) % 3;
  const Vec3 p = where_sight_changes(inner[apart], inner[b], signature[apart]);
  const Vec3 q = where_sight_changes(inner[apart], inner[c], signature[apart]);
  const Vec3& normal = scene_.surfaces[at(a_)].frame.normal;
  const double s = meet(p, q, corners[apart], corners[b], normal);
  const double t = meet(p, q, corners[apart], corners[c], normal);
  const auto is_cut = [](double at) { return at > nearest_cut && at < 1 - nearest_cut; };
  if (!is_cut(s) || !is_cut(t)) return false;
  const Vec3 on_b = corners[apart] + s * (corners[b] - corners[apart]);
  const Vec3 on_c = corners[apart] + t * (corners[c] - corners[apart]);
  BlockedCell part = cell;
  ++part.halvings;
  part.may_miss = true;
  for (const Triangle3& side :
       {Triangle3{corners[apart], on_b, on_c}, Triangle3{on_b, corners[b], corners[c]},
        Triangle3{on_b, corners[c], on_c}}) {
    part.corners = side;
    next.push_back(evaluate(part, 4));
  }
  return true;
}

}  // namespace halfshade
