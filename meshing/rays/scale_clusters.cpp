#include "meshing/rays/scale_clusters.h"

#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

constexpr double small_share = 0x1p-12;    // of an extent: triangles that may be set apart
constexpr double cluster_share = 0x1p-10;  // of an extent: as large as what they fill may be
constexpr double least_share = 0x1p-100;   // of the extent of all: smaller ones are left alone
constexpr std::size_t most_clusters = 64;  // every ray is tried in each

double extent(const Bounds& box) { return 2 * box.half_size().maxCoeff(); }

class ClusterSearch {
 public:
  explicit ClusterSearch(const TriangleSoup& soup) : boxes_(soup.triangles.size()) {
    for (std::size_t t = 0; t < boxes_.size(); ++t)
      for (const int v : soup.triangles[t]) boxes_[t].include(soup.points[at(v)]);
  }

  /// All triangles in one set to begin with; what is taken out of a set is searched in turn.

  std::vector<std::vector<int>> operator()() {
    std::vector<std::vector<int>> clusters(1, std::vector<int>(boxes_.size()));
    std::iota(clusters[0].begin(), clusters[0].end(), 0);
    least_ = least_share * extent(bounds(clusters[0]));
    for (std::size_t c = 0; c < clusters.size(); ++c) {
      std::vector<std::vector<int>> inner = set_apart(clusters[c], most_clusters - clusters.size());
      std::move(inner.begin(), inner.end(), std::back_inserter(clusters));
    }
    std::erase_if(clusters, [](const std::vector<int>& c) { return c.empty(); });
    return clusters;
  }

 private:
  Bounds bounds(const std::vector<int>& triangles) const {
    Bounds box;
    for (const int t : triangles) box.include(boxes_[at(t)]);
    return box;
  }

  /// Takes clusters out of a set, the largest so many.
  std::vector<std::vector<int>> set_apart(std::vector<int>& triangles, std::size_t most) const {
    const double whole = extent(bounds(triangles));
    std::vector<int> small;
    for (const int t : triangles)
      if (extent(boxes_[at(t)]) < small_share * whole) small.push_back(t);
    std::vector<std::vector<int>> found;
    divide(std::move(small), small_share * whole, found);
    std::erase_if(found, [&](const std::vector<int>& f) {
      const double size = extent(bounds(f));
      return size > cluster_share * whole || size < least_;
    });
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.size() > b.size(); });
    found.resize(std::min(found.size(), most));
    std::vector<int> taken;
    for (std::vector<int>& f : found) {
      std::sort(f.begin(), f.end());
      taken.insert(taken.end(), f.begin(), f.end());
    }
    std::sort(taken.begin(), taken.end());
    std::erase_if(triangles,
                  [&](int t) { return std::binary_search(taken.begin(), taken.end(), t); });
    return found;
  }

  /// Cuts a set wherever a slab across an axis is free of it, at least so wide.
  void divide(std::vector<int> triangles, double gap, std::vector<std::vector<int>>& parts) const {
    if (triangles.empty()) return;
    for (int axis = 0; axis < 3; ++axis) {
      std::sort(triangles.begin(), triangles.end(), [&](int a, int b) {
        return std::pair(boxes_[at(a)].low[axis], a) < std::pair(boxes_[at(b)].low[axis], b);
      });
      std::vector<std::size_t> cuts = {0};
      double reach = boxes_[at(triangles[0])].high[axis];
      for (std::size_t k = 1; k < triangles.size(); ++k) {
        const Bounds& box = boxes_[at(triangles[k])];
        if (box.low[axis] > reach + gap) cuts.push_back(k);
        reach = std::max(reach, box.high[axis]);
      }
      if (cuts.size() == 1) continue;
      cuts.push_back(triangles.size());
      for (std::size_t k = 1; k < cuts.size(); ++k)
        divide({triangles.begin() + static_cast<std::ptrdiff_t>(cuts[k - 1]),
                triangles.begin() + static_cast<std::ptrdiff_t>(cuts[k])},
               gap, parts);
      return;
    }
    parts.push_back(std::move(triangles));
  }

  std::vector<Bounds> boxes_;  // of the triangles
  double least_ = 0;           // extent of a cluster
};

}  // namespace

std::vector<std::vector<int>> scale_clusters(const TriangleSoup& soup) {
  return ClusterSearch(soup)();
}

}  // namespace halfshade
