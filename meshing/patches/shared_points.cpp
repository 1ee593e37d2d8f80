#include "meshing/patches/shared_points.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

class SharedPointFinder {
 public:
  SharedPointFinder(const SoundScene& scene, const SharedEdges& shared,
                    std::span<const CurveMesh> meshes)
      : scene_(scene), lines_(shared.lines()), meshes_(meshes), edges_(lines_.lines.size()) {
    for (std::size_t r = 0; r < meshes.size(); ++r)
      for (const BorderEdge& edge : border_edges(meshes[r])) {
        const int border = shared.border_of(static_cast<int>(r), edge.ends);
        if (border < 0 || lines_.borders[at(border)].line < 0) continue;
        collect(static_cast<int>(r), lines_.borders[at(border)].line, edge);
      }
    std::sort(points_.begin(), points_.end());
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    above_.resize(points_.size());
    std::iota(above_.begin(), above_.end(), 0);
    for (const Point& p : points_) owners_.push_back({p.surface});
  }

  SharedPoints run() {
    std::vector<std::vector<Site>> sites;
    for (std::size_t l = 0; l < edges_.size(); ++l)
      join(sites.emplace_back(sites_of(edges_[l])), lines_.lines[l].length);
    SharedPoints result;
    number(result);
    for (std::size_t r = 0; r < meshes_.size(); ++r) detach_turned(r, result);
    result.gaps.resize(meshes_.size());
    for (std::size_t l = 0; l < edges_.size(); ++l) find_gaps(l, sites[l], result);
    for (auto& gaps : result.gaps)
      std::sort(gaps.begin(), gaps.end(),
                [](const auto& a, const auto& b) { return a.edge < b.edge; });
    return result;
  }

 private:
  struct Point {
    int surface, point;
    auto operator<=>(const Point&) const = default;
  };
  struct Site {
    double t;   // along a line
    int point;  // of points_
    auto operator<=>(const Site&) const = default;
  };
  struct Edge {
    int surface;
    std::array<int, 2> points;  // sorted
    std::array<double, 2> t;
  };

  void collect(int surface, int line, const BorderEdge& border) {
    Edge edge{surface, border.points, {}};
    for (std::size_t k = 0; k < 2; ++k) {
      points_.push_back({surface, border.points[k]});
      edge.t[k] = along(lines_.lines[at(line)], scene_.surfaces[at(surface)].frame, border.ends[k]);
    }
    if (edge.points[0] > edge.points[1]) {
      std::swap(edge.points[0], edge.points[1]);
      std::swap(edge.t[0], edge.t[1]);
    }
    edges_[at(line)].push_back(edge);
  }

  std::vector<Site> sites_of(const std::vector<Edge>& edges) const {
    std::vector<Site> sites;
    for (const Edge& edge : edges)
      for (std::size_t k = 0; k < 2; ++k) {
        const Point p{edge.surface, edge.points[k]};
        const auto found = std::lower_bound(points_.begin(), points_.end(), p);
        sites.push_back({edge.t[k], static_cast<int>(found - points_.begin())});
      }
    std::sort(sites.begin(), sites.end());
    sites.erase(std::unique(sites.begin(), sites.end()), sites.end());
    return sites;
  }

  int root(int i) {
    while (above_[at(i)] != i) i = above_[at(i)] = above_[at(above_[at(i)])];
    return i;
  }

  Vec3 position(int i) const {
    const auto [surface, point] = points_[at(i)];
    return scene_.surfaces[at(surface)].frame.to_space(meshes_[at(surface)].mesh.points[at(point)]);
  }

  // Two planes are off a common corner by this much at most, and its rounding.
  double farthest(int p, int q) const {
    return 4 * tolerance_of(scene_.surfaces[at(points_[at(p)].surface)],
                            scene_.surfaces[at(points_[at(q)].surface)])
                   .planarity;
  }

  // Not if both have a point of the same surface.
  void join(int p, int q) {
    const int a = std::min(root(p), root(q)), b = std::max(root(p), root(q));
    if (a == b || (position(p) - position(q)).norm() > farthest(p, q)) return;
    std::vector<int> both;
    std::merge(owners_[at(a)].begin(), owners_[at(a)].end(), owners_[at(b)].begin(),
               owners_[at(b)].end(), std::back_inserter(both));
    if (std::adjacent_find(both.begin(), both.end()) != both.end()) return;
    owners_[at(a)] = std::move(both);
    above_[at(b)] = a;
  }

  void join(const std::vector<Site>& sites, double length) {
    std::size_t first = 0;
    for (std::size_t i = 1; i < sites.size(); ++i) {
      if (sites[i].t - sites[first].t > length) first = i;
      join(sites[first].point, sites[i].point);
    }
  }

  void number(SharedPoints& result) {
    for (const CurveMesh& mesh : meshes_) result.id.emplace_back(mesh.mesh.points.size(), -1);
    shared_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const auto [surface, point] = points_[i];
      const auto first = at(root(static_cast<int>(i)));  // the lowest of those joined
      if (first == i) {
        shared_[i] = static_cast<int>(result.position.size());
        result.position.push_back(position(static_cast<int>(i)));
        surfaces_at_.push_back(owners_[i]);
      }
      shared_[i] = shared_[first];
      result.id[at(surface)][at(point)] = shared_[i];
    }
  }

  // Only surfaces that are not quite plane have points that move by more than rounding.
  void detach_turned(std::size_t r, SharedPoints& result) const {
    const PlaneFrame& frame = scene_.surfaces[r].frame;
    const PlanarMesh& mesh = meshes_[r].mesh;
    std::vector<int>& id = result.id[r];
    const auto position = [&](int p) {
      return id[at(p)] < 0 ? frame.to_space(mesh.points[at(p)]) : result.position[at(id[at(p)])];
    };
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& t : mesh.triangles) {
        if (std::all_of(t.begin(), t.end(), [&](int p) { return id[at(p)] < 0; })) continue;
        const Vec3 a = position(t[0]);
        if ((position(t[1]) - a).cross(position(t[2]) - a).dot(frame.normal) > 0) continue;
        for (const int p : t) id[at(p)] = -1;
        changed = true;
      }
    }
  }

  // Each once, in the order of the line.
  std::vector<std::pair<double, int>> shared_at(const std::vector<Site>& sites) const {
    std::vector<std::pair<int, double>> first;
    for (const Site& site : sites) first.emplace_back(shared_[at(site.point)], site.t);
    std::sort(first.begin(), first.end());
    std::vector<std::pair<double, int>> shared;
    for (std::size_t i = 0; i < first.size(); ++i)
      if (i == 0 || first[i].first != first[i - 1].first)
        shared.emplace_back(first[i].second, first[i].first);
    std::sort(shared.begin(), shared.end());
    return shared;
  }

  void find_gaps(std::size_t line, const std::vector<Site>& sites, SharedPoints& result) const {
    const double length = lines_.lines[line].length;
    const std::vector<std::pair<double, int>> shared = shared_at(sites);
    for (const Edge& edge : edges_[line]) {
      const auto [low, high] = std::minmax(edge.t[0], edge.t[1]);
      SharedPoints::Gap gap{edge.points, {}};
      auto p = std::upper_bound(shared.begin(), shared.end(), std::pair(low + length, INT32_MAX));
      for (; p != shared.end() && p->first < high - length; ++p) {
        const std::vector<int>& owners = surfaces_at_[at(p->second)];
        if (!std::binary_search(owners.begin(), owners.end(), edge.surface))
          gap.points.push_back(p->second);
      }
      if (gap.points.empty()) continue;
      if (edge.t[0] > edge.t[1]) std::reverse(gap.points.begin(), gap.points.end());
      result.gaps[at(edge.surface)].push_back(std::move(gap));
    }
  }

  const SoundScene& scene_;
  const SharedLines& lines_;
  std::span<const CurveMesh> meshes_;
  std::vector<std::vector<Edge>> edges_;       // of each line
  std::vector<Point> points_;                  // on shared lines, sorted
  std::vector<int> above_;                     // trees of joined points
  std::vector<std::vector<int>> owners_;       // of roots: the surfaces that have a point there
  std::vector<int> shared_;                    // [point] its shared point
  std::vector<std::vector<int>> surfaces_at_;  // [shared point]
};

}  // namespace

SharedPoints shared_points(const SoundScene& scene, const SharedEdges& shared,
                           std::span<const CurveMesh> meshes) {
  return SharedPointFinder(scene, shared, meshes).run();
}

}  // namespace halfshade
