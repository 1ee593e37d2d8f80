#include "solver/reflected/triangle_forest.h"

#include "meshing/core/rounded.h"

namespace halfshade {
namespace {

/// Points this close to where a triangle is cut lie in its first half, see ElementLookup.
constexpr double edge_margin = 1e-10;

double area_of(const std::array<Vec3, 3>& corner) {
  return 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
}

}  // namespace

int longest_edge(const std::array<Vec3, 3>& corner) {
  int longest = 0;
  double most = 0;
  for (int k = 0; k < 3; ++k)
    if (const double l = rounded((corner[at((k + 1) % 3)] - corner[at(k)]).squaredNorm());
        l > most) {
      most = l;
      longest = k;
    }
  return longest;
}

TriangleForest::TriangleForest(const ElementTable& roots)
    : root_count_(roots.count()), roots_(roots) {
  for (int e = 0; e < roots.count(); ++e) {
    const auto corner = roots.triangle(e);
    add({corner, area_of(corner), e, 0});
  }
}

void TriangleForest::add(const Triangle& triangle) {
  triangles_.push_back(triangle);
  splits_.push_back({-1, longest_edge(triangle.corner)});
}

void TriangleForest::bisect(int triangle) {
  const Triangle parent = triangles_[at(triangle)];
  if (!is_leaf(triangle)) return;
  const std::size_t a = at(cut(triangle)), b = (a + 1) % 3, c = (a + 2) % 3;
  const Vec3 middle = 0.5 * (parent.corner[a] + parent.corner[b]);
  splits_[at(triangle)].child = count();
  for (const auto& corner : {std::array<Vec3, 3>{parent.corner[a], middle, parent.corner[c]},
                             std::array<Vec3, 3>{middle, parent.corner[b], parent.corner[c]}})
    add({corner, 0.5 * parent.area, parent.root, parent.level + 1});
}

ForestPlace TriangleForest::leaf_at(ForestPlace from) const {
  for (;;) {
    const auto [child, edge] = splits_[at(from.triangle)];
    if (child < 0) return from;
    const std::array<double, 3> w = {1 - from.place.x() - from.place.y(), from.place.x(),
                                     from.place.y()};
    const double wa = w[at(edge)], wb = w[at((edge + 1) % 3)], wc = w[at((edge + 2) % 3)];
    if (wa >= wb - edge_margin)
      from = {child, {2 * wb, wc}};
    else
      from = {child + 1, {wb - wa, wc}};
  }
}

ForestPlace TriangleForest::leaf_at(int surface, const Vec3& position) const {
  const ForestPlace root = roots_.find(surface, position);
  return root.triangle < 0 ? root : leaf_at(root);
}

}  // namespace halfshade
