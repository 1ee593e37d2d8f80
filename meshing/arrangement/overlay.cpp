#include "meshing/arrangement/overlay.h"

#include "meshing/core/error.h"
#include "meshing/core/planar.h"

#include <algorithm>
#include <map>

namespace halfshade {
namespace {

using Winding = std::vector<std::pair<int, int>>;

struct BoundaryLinks {
  std::vector<Link> links;      // sorted
  std::vector<Winding> change;  // going from the right of low → high to its left
};

BoundaryLinks boundary_links(const Arrangement& arrangement, std::span<const int> loop_of) {
  std::map<Link, std::map<int, int>> net;
  for (std::size_t s = 0; s < loop_of.size(); ++s) {
    const auto& chain = arrangement.chains[s];
    for (std::size_t k = 1; k < chain.size(); ++k) {
      const bool up = chain[k - 1] < chain[k];
      const Link link = sorted_link(chain[k - 1], chain[k]);
      net[link][loop_of[s]] += up ? 1 : -1;
    }
  }
  BoundaryLinks result;
  for (const auto& [link, by_loop] : net) {
    result.links.push_back(link);
    result.change.emplace_back();
    for (const auto& [loop, change] : by_loop)
      if (change != 0) result.change.back().emplace_back(loop, change);
  }
  return result;
}

// Sum of two sparse vectors, the second multiplied by `sign`.
Winding add(const Winding& a, const Winding& b, int sign) {
  std::map<int, int> sum(a.begin(), a.end());
  for (const auto& [loop, change] : b) sum[loop] += sign * change;
  Winding result;
  for (const auto& [loop, w] : sum)
    if (w != 0) result.emplace_back(loop, w);
  return result;
}

// The winding on the left of a → b, given the one on its right.
Winding cross(const BoundaryLinks& boundary, const Winding& right, int a, int b) {
  const Link link = sorted_link(a, b);
  const auto found = std::lower_bound(boundary.links.begin(), boundary.links.end(), link);
  if (found == boundary.links.end() || *found != link) return right;
  const auto index = static_cast<std::size_t>(found - boundary.links.begin());
  return add(right, boundary.change[index], a < b ? 1 : -1);
}

void flood(Overlay& result, const BoundaryLinks& boundary) {
  const auto& [triangles, neighbours] = result.hull;
  result.winding.resize(triangles.size());
  std::vector<bool> known(triangles.size(), false);
  std::vector<int> open;
  const auto settle = [&](int t, Winding winding) {
    result.winding[at(t)] = std::move(winding);
    known[at(t)] = true;
    open.push_back(t);
  };
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (neighbours[at(t)][k] < 0 && !known[at(t)])
        settle(t, cross(boundary, {}, triangles[at(t)][k], triangles[at(t)][(k + 1) % 3]));
  while (!open.empty()) {
    const int t = open.back();
    open.pop_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const int next = neighbours[at(t)][k];
      if (next < 0 || known[at(next)]) continue;
      const int a = triangles[at(t)][k], b = triangles[at(t)][(k + 1) % 3];
      settle(next, cross(boundary, result.winding[at(t)], b, a));
    }
  }
}

struct Half {
  int triangle, edge;
  auto operator<=>(const Half&) const = default;
};

class RegionTracer {
 public:
  RegionTracer(const Overlay& overlay, std::span<const int> labels)
      : overlay_(overlay), labels_(labels) {}

  std::vector<OverlayRegion> run() {
    std::vector<OverlayRegion> result;
    std::vector<bool> seen(labels_.size(), false);
    for (int t = 0; t < static_cast<int>(labels_.size()); ++t) {
      if (seen[at(t)] || labels_[at(t)] < 0) continue;
      OverlayRegion region;
      region.label = labels_[at(t)];
      region.triangles.push_back(t);
      seen[at(t)] = true;
      for (std::size_t i = 0; i < region.triangles.size(); ++i)
        for (int k = 0; k < 3; ++k) {
          const int next = inner_neighbour(region.triangles[i], k);
          if (next < 0 || seen[at(next)]) continue;
          seen[at(next)] = true;
          region.triangles.push_back(next);
        }
      std::sort(region.triangles.begin(), region.triangles.end());
      trace_rings(region);
      result.push_back(std::move(region));
    }
    return result;
  }

 private:
  int corner(int t, int k) const { return overlay_.hull.triangles[at(t)][at(k % 3)]; }

  // The neighbour across an edge if it has the same label, else −1.
  int inner_neighbour(int t, int k) const {
    const int next = overlay_.hull.neighbours[at(t)][at(k)];
    return next >= 0 && labels_[at(next)] == labels_[at(t)] ? next : -1;
  }

  // Round the end of a boundary edge, through triangles of the region, to the next boundary edge:
  // where the region touches itself in a point, its boundary does not change sides.
  Half next_on_boundary(Half half) const {
    const int pivot = corner(half.triangle, half.edge + 1);
    half.edge = (half.edge + 1) % 3;
    for (int next; (next = inner_neighbour(half.triangle, half.edge)) >= 0;) {
      half.triangle = next;
      half.edge = 0;
      while (corner(next, half.edge) != pivot) ++half.edge;
    }
    return half;
  }

  void trace_rings(OverlayRegion& region) const {
    std::map<Half, bool> done;
    for (const int t : region.triangles)
      for (int k = 0; k < 3; ++k)
        if (inner_neighbour(t, k) < 0) done[{t, k}] = false;
    for (auto& [start, traced] : done) {
      if (traced) continue;
      std::vector<int> loop;
      Half half = start;
      do {
        done[half] = true;
        loop.push_back(corner(half.triangle, half.edge));
        half = next_on_boundary(half);
      } while (half != start);
      split_at_repeats(loop, region.rings);
    }
    for (auto& ring : region.rings)
      std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end()), ring.end());
    std::sort(region.rings.begin(), region.rings.end(), [&](const auto& a, const auto& b) {
      return std::pair(-twice_area(overlay_.points, a), a) <
             std::pair(-twice_area(overlay_.points, b), b);
    });
  }

  static void split_at_repeats(const std::vector<int>& loop, std::vector<std::vector<int>>& rings) {
    std::vector<int> path;
    std::map<int, std::ptrdiff_t> place;  // of the points on the path
    for (const int p : loop) {
      if (const auto earlier = place.find(p); earlier != place.end()) {
        const auto begin = path.begin() + earlier->second;
        rings.emplace_back(begin, path.end());
        for (auto q = begin; q != path.end(); ++q) place.erase(*q);
        path.erase(begin, path.end());
      }
      place[p] = static_cast<std::ptrdiff_t>(path.size());
      path.push_back(p);
    }
    rings.push_back(std::move(path));
  }

  const Overlay& overlay_;
  std::span<const int> labels_;
};

}  // namespace

double twice_area(std::span<const Vec2> points, std::span<const int> loop) {
  double sum = 0;
  const Vec2& origin = points[at(loop[0])];
  for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
    const Vec2 a = points[at(loop[k])] - origin, b = points[at(loop[k + 1])] - origin;
    sum += cross_2d(a, b);
  }
  return sum;
}

std::vector<int> crossed_loops(const Overlay& overlay, double width) {
  std::vector<int> result;
  for (std::size_t t = 0; t < overlay.winding.size(); ++t) {
    const auto& corners = overlay.hull.triangles[t];
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(
          longest,
          (overlay.points[at(corners[k])] - overlay.points[at(corners[(k + 1) % 3])]).norm());
    if (twice_area(overlay.points, corners) <= width * longest) continue;
    for (const auto& [loop, w] : overlay.winding[t])
      if (w != 1) result.push_back(loop);
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

namespace {

/// The sides of loops, and which loop each is of.
struct Sides {
  std::vector<Link> segments;
  std::vector<int> loop_of;
};

Sides sides_of(std::span<const std::vector<int>> loops) {
  Sides sides;
  for (std::size_t l = 0; l < loops.size(); ++l)
    for (std::size_t k = 0; k < loops[l].size(); ++k) {
      sides.segments.push_back({loops[l][k], loops[l][(k + 1) % loops[l].size()]});
      sides.loop_of.push_back(static_cast<int>(l));
    }
  return sides;
}

Overlay overlay_of(std::vector<Vec2> points, const Sides& sides, const SnapRadii& snap) {
  Arrangement arrangement = arrange(std::move(points), sides.segments, snap);
  const BoundaryLinks boundary = boundary_links(arrangement, sides.loop_of);
  Overlay result;
  result.hull = constrained_delaunay(arrangement.points, boundary.links);
  result.points = std::move(arrangement.points);
  flood(result, boundary);
  return result;
}

}  // namespace

Overlay overlay(std::vector<Vec2> points, std::span<const std::vector<int>> loops,
                const SnapRadii& snap) {
  const Sides sides = sides_of(loops);
  try {
    return overlay_of(points, sides, snap);
  } catch (const Error&) {
    // Two sides whose ends nearly are the same, farther apart than points snap, are led through
    // each other's ends, turn back there and are themselves again: they cross in the end.
    if (!(snap.points < snap.links)) throw;
    return overlay_of(std::move(points), sides, {snap.links, snap.links});
  }
}

std::vector<OverlayRegion> regions(const Overlay& overlay, std::span<const int> labels) {
  return RegionTracer(overlay, labels).run();
}

}  // namespace halfshade
