#include "meshing/discontinuity/merge_curves.h"

#include "meshing/discontinuity/margins.h"
#include "meshing/discontinuity/stacked_curves.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace halfshade {
namespace {

bool is_same_plane(const Vec3& a, const Vec3& b) {
  return (a - b).norm() <= margins::same_plane || (a + b).norm() <= margins::same_plane;
}

/// The sight plane that all curves of an order share, or zero.
Vec3 common_plane(std::span<const DiscontinuityCurve> curves, std::span<const StackedCurve> members,
                  int order) {
  const DiscontinuityCurve* first = nullptr;
  for (const StackedCurve& member : members) {
    const DiscontinuityCurve& curve = curves[at(member.curve)];
    if (curve.order != order) continue;
    if (!first) first = &curve;
    if (!is_same_plane(first->sight_plane, curve.sight_plane)) return Vec3::Zero();
  }
  return first->sight_plane;
}

template <class T>
void sort_unique(std::vector<T>& items) {
  std::sort(items.begin(), items.end());
  items.erase(std::unique(items.begin(), items.end()), items.end());
}

}  // namespace

DiscontinuityCurve stack(std::span<const DiscontinuityCurve> curves,
                         std::span<const StackedCurve> members, const ConicArc& arc) {
  const auto curve_of = [&](const StackedCurve& member) -> const DiscontinuityCurve& {
    return curves[at(member.curve)];
  };
  const auto rank = [](const DiscontinuityCurve& c) { return std::pair(c.order, c.kind); };
  DiscontinuityCurve result = curve_of(members.front());
  result.arc = arc;
  result.jump = {};
  result.triples.clear();
  result.sources.clear();
  for (const StackedCurve& member : members) {
    const DiscontinuityCurve& curve = curve_of(member);
    result.step = std::min(result.step, curve.step);
    if (rank(curve) < rank(result)) {
      result.order = curve.order;
      result.kind = curve.kind;
    }
    for (EdgeTriple triple : curve.triples) {
      std::sort(triple.edges.begin(), triple.edges.end());
      if (member.reversed) triple.sign = -triple.sign;
      result.triples.push_back(triple);
    }
    result.sources.insert(result.sources.end(), curve.sources.begin(), curve.sources.end());
  }
  result.sight_plane = common_plane(curves, members, result.order);
  sort_unique(result.triples);
  sort_unique(result.sources);
  return result;
}

bool alike(const DiscontinuityCurve& a, const DiscontinuityCurve& b) {
  return a.kind == b.kind && a.order == b.order && a.sources == b.sources &&
         a.triples == b.triples && is_same_plane(a.sight_plane, b.sight_plane);
}

std::size_t merge_coincident(std::vector<DiscontinuityCurve>& curves, double tolerance) {
  std::vector<int> order(curves.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto pair_of = [&](int i) {
    const DiscontinuityCurve& curve = curves[at(i)];
    return std::pair(curve.receiver, curve.emitter);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return pair_of(i) < pair_of(j); });
  std::vector<MergedCurve> merged;
  std::size_t count = 0;
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end = std::upper_bound(begin, order.end(), *begin,
                                      [&](int i, int j) { return pair_of(i) < pair_of(j); });
    const auto middle =
        std::stable_partition(begin, end, [&](int i) { return curves[at(i)].arc.is_straight; });
    count += merge_straight(curves, {begin, middle}, tolerance, merged);
    count += merge_conics(curves, {middle, end}, tolerance, merged);
    begin = end;
  }
  std::stable_sort(merged.begin(), merged.end(),
                   [](const MergedCurve& a, const MergedCurve& b) { return a.place < b.place; });
  curves.clear();
  for (MergedCurve& piece : merged) curves.push_back(std::move(piece.curve));
  return count;
}

}  // namespace halfshade
