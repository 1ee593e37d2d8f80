#include "meshing/rays/shaft_index.h"

#include "meshing/geometry/shaft.h"

#include <algorithm>
#include <numeric>

namespace halfshade {
ShaftIndex::ShaftIndex(const TriangleSoup& soup) {
  std::vector<std::array<Vec3, 3>> corners(soup.triangles.size());
  std::vector<Bounds> boxes(corners.size());
  for (std::size_t t = 0; t < corners.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      corners[t][k] = soup.points[at(soup.triangles[t][k])];
      boxes[t].include(corners[t][k]);
    }
  tree_ = make_flat_tree(boxes);
  for (const int t : tree_.items) {
    triangles_.push_back(corners[at(t)]);
    owners_.push_back(soup.owner[at(t)]);
  }
  std::iota(tree_.items.begin(), tree_.items.end(), 0);
}

std::vector<int> ShaftIndex::candidates(std::span<const Vec3> a, std::span<const Vec3> b) const {
  const Shaft shaft = make_shaft(a, b, shaft_tolerance(a, b));
  const auto skip = [&](int node, SideMask& mask) {
    const Bounds& box = tree_.nodes[at(node)].box;
    return is_outside(shaft, box.low, box.high, mask);
  };
  std::vector<int> found;
  walk_tree(tree_, all_sides(shaft), skip, [&](int i, SideMask mask) {
    if (!is_harmless(shaft, triangles_[at(i)], mask)) found.push_back(owners_[at(i)]);
  });
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace halfshade
