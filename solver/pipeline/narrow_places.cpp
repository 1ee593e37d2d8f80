#include "solver/pipeline/narrow_places.h"

#include "meshing/core/parallel.h"
#include "meshing/core/planar.h"
#include "meshing/geometry/flat_tree.h"
#include "solver/pipeline/middle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

namespace halfshade {
namespace {

/// What is wider than this share of a receiver, with its penumbra, is sampled densely enough.
constexpr double narrow = 0.15;
/// Lines closer than this share of a receiver are the same edge of two faces.
constexpr double same_line = 1e-9;
/// Edges projected in all, and places.
constexpr double most_edges = 1e7;
constexpr std::size_t most_narrow_places = 4000;
/// Areas that are equal but for rounding differ by less.
constexpr double same_area = 1e-9;
/// Where along a line, unlike anything that elements are divided by.
constexpr std::array<double, 3> along_line = {0.173, 0.471, 0.829};
/// Edges end so far from the heights of the source and of the receiver, as a share of the
/// source's: there they are beyond all receivers, or touch this one.
constexpr double least_height = 1e-6;

/// An edge of a blocker, as a point of light throws it on a plane.
struct ThrownEdge {
  Segment2 ends;
  double blur;  ///< width of the penumbra of all of the source there
};

using Edge = std::array<Vec3, 2>;

/// The edges of blockers in space.
std::vector<Edge> edges_of(const SoundScene& scene, std::span<const int> blocking) {
  std::vector<Edge> edges;
  for (const int b : blocking)
    for (const Ring& ring : scene.surfaces[at(b)].rings)
      for (std::size_t k = 0; k < ring.size(); ++k)
        edges.push_back({scene.surfaces[at(b)].frame.to_space(ring[k]),
                         scene.surfaces[at(b)].frame.to_space(ring[(k + 1) % ring.size()])});
  return edges;
}

/// Keeps what of a range of a segment has a value between two bounds, linear along it. False if
/// that is nothing.
bool keep_between(double at_begin, double at_end, double low, double high,
                  std::array<double, 2>& range) {
  const double slope = at_end - at_begin;
  for (const auto& [bound, sign] : {std::pair(low, 1.), std::pair(high, -1.)}) {
    const double begin = sign * (at_begin - bound), change = sign * slope;
    if (change == 0) {
      if (begin < 0) return false;
    } else if (change > 0) {
      range[0] = std::max(range[0], -begin / change);
    } else {
      range[1] = std::min(range[1], -begin / change);
    }
  }
  return range[0] < range[1];
}

class Receiver {
 public:
  explicit Receiver(const Surface& surface) : surface_(surface), size_(size_of(surface)) {
    low_ = high_ = surface.rings.front().front();
    for (const Vec2& p : surface.rings.front()) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    }
    // Lines on the border itself border on nothing.
    low_.array() += same_line * size_;
    high_.array() -= same_line * size_;
  }

  double height(const Vec3& p) const { return surface_.frame.height(p); }
  bool is_below(const Vec3& p) const { return height(p) > least_height * size_; }

  /// What of an edge's shadow from a point `from` of a lamp of some size falls into the rectangle
  /// round the receiver; the edge is looked at only where the lamp shines.
  std::optional<ThrownEdge> thrown(const Edge& edge, const Vec3& from, const Surface& lamp,
                                   double lamp_size) const {
    const double top = height(from), least = least_height * top;
    std::array<double, 2> range = {0, 1};
    if (!keep_between(height(edge[0]), height(edge[1]), least, top - least, range) ||
        !keep_between(lamp.frame.height(edge[0]), lamp.frame.height(edge[1]), least, HUGE_VAL,
                      range))
      return std::nullopt;
    double stretch = 0;
    const auto shadow = [&](double t) -> Vec2 {
      const Vec3 p = edge[0] + t * (edge[1] - edge[0]);
      const double times = top / (top - height(p));
      stretch = std::max(stretch, times - 1);
      return surface_.frame.to_plane(from + times * (p - from));
    };
    const Vec2 a = shadow(range[0]), b = shadow(range[1]);
    std::array<double, 2> inside = {0, 1};
    for (int axis = 0; axis < 2; ++axis)
      if (!keep_between(a[axis], b[axis], low_[axis], high_[axis], inside)) return std::nullopt;
    return ThrownEdge{{a + inside[0] * (b - a), a + inside[1] * (b - a)},
                      lamp_size * std::min(stretch, size_ / lamp_size)};
  }

  /// Adds places half way from each edge to what is next to it on either side, if that is close.
  void add_places(int id, const std::vector<ThrownEdge>& edges, double share,
                  std::vector<WatchedPlace>& places) const {
    std::vector<Bounds> boxes;
    for (const ThrownEdge& edge : edges) boxes.push_back(flat_bounds(edge.ends[0], edge.ends[1]));
    const FlatTree tree = make_flat_tree(boxes, 4);
    for (const ThrownEdge& edge : edges) {
      const Vec2 along = edge.ends[1] - edge.ends[0];
      const double length = along.norm();
      if (!(length > same_line * size_)) continue;
      const Vec2 across = Vec2(-along.y(), along.x()) / length;
      for (const double t : along_line)
        for (const double side : {1., -1.}) {
          const Vec2 p = edge.ends[0] + t * along;
          const double width = next(edges, tree, p, side * across);
          const Vec2 place = p + 0.5 * width * side * across;
          if (!(width + edge.blur < narrow * size_) || !is_inside(surface_.rings, place)) continue;
          const double part = std::max(length / along_line.size(), std::min(length, width));
          places.push_back({{{surface_.frame.to_space(place), surface_.frame.normal}, id},
                            share * (width + edge.blur) * (part + std::min(edge.blur, part))});
        }
    }
  }

 private:
  /// How far the next line is from a point.
  double next(const std::vector<ThrownEdge>& edges, const FlatTree& tree, const Vec2& p,
              const Vec2& direction) const {
    const double most = narrow * size_;
    // Among very many lines it is mostly close.
    for (double reach = most / 64;; reach *= 4) {
      double nearest = std::min(reach, most);
      visit_overlaps(tree, flat_bounds(p, p + nearest * direction), [&](int i) {
        const auto& [a, b] = edges[at(i)].ends;
        const auto distance = line_meets_segment(p, direction, a, b);
        if (distance && *distance > same_line * size_) nearest = std::min(nearest, *distance);
      });
      if (nearest < reach || reach >= most) return nearest;
    }
  }

  const Surface& surface_;
  double size_;
  Vec2 low_, high_;
};

std::vector<int> by_area(const SoundScene& scene) {
  std::vector<int> ids(scene.surfaces.size());
  std::iota(ids.begin(), ids.end(), 0);
  std::vector<double> areas;
  for (const Surface& surface : scene.surfaces) areas.push_back(area(surface));
  std::stable_sort(ids.begin(), ids.end(),
                   [&](int a, int b) { return areas[at(a)] > areas[at(b)]; });
  return ids;
}

/// The largest, in the order they were found.
void keep_largest(std::vector<WatchedPlace>& places) {
  if (places.size() <= most_narrow_places) return;
  std::vector<double> areas;
  for (const WatchedPlace& place : places) areas.push_back(place.area);
  std::nth_element(areas.begin(), areas.begin() + most_narrow_places, areas.end(),
                   std::greater<>());
  const double least = (1 + same_area) * areas[most_narrow_places];
  std::erase_if(places, [&](const WatchedPlace& place) { return place.area <= least; });
}

/// Those on a receiver in the light of a lamp, from some of its points.
void add_narrow(const SoundScene& scene, int id, const Surface& lamp, std::span<const Vec3> ends,
                std::span<const Edge> edges, std::vector<WatchedPlace>& places) {
  const Receiver receiver(scene.surfaces[at(id)]);
  // Both lines beside something narrow find it.
  const double share = 0.5 / static_cast<double>(ends.size());
  for (const Vec3& from : ends) {
    if (!receiver.is_below(from)) continue;
    std::vector<ThrownEdge> thrown;
    for (const Edge& edge : edges)
      if (auto line = receiver.thrown(edge, from, lamp, size_of(lamp))) thrown.push_back(*line);
    if (thrown.size() > 1) receiver.add_places(id, thrown, share, places);
  }
}

}  // namespace

std::vector<WatchedPlace> narrow_places(const SoundScene& scene, std::span<const int> sources,
                                        std::span<const int> blocking, const Progress& progress) {
  std::vector<WatchedPlace> places;
  const std::vector<Edge> edges = edges_of(scene, blocking);
  if (edges.empty() || sources.empty()) return places;
  const std::vector<int> receivers = by_area(scene);
  const double each = static_cast<double>(edges.size()) * static_cast<double>(sources.size());
  const double all = each * static_cast<double>(receivers.size());
  constexpr double around = 1 + 4;  // of most sources
  const bool only_middles = all * around > most_edges;
  const double most = most_edges / each / (only_middles ? 1 : around);
  std::vector<std::vector<WatchedPlace>> of_source(sources.size());
  parallel_for(
      sources.size(),
      [&](std::size_t s) {
        const Surface& lamp = scene.surfaces[at(sources[s])];
        const std::vector<Vec3> ends =
            only_middles ? std::vector{middle(lamp)} : middle_and_around(lamp, towards_corner);
        for (std::size_t r = 0; r < receivers.size() && static_cast<double>(r) < most; ++r)
          add_narrow(scene, receivers[r], lamp, ends, edges, of_source[s]);
      },
      progress, "narrow shadows");
  for (const auto& more : of_source) places.insert(places.end(), more.begin(), more.end());
  keep_largest(places);
  return places;
}

}  // namespace halfshade
