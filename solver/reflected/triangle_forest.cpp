#include "solver/reflected/triangle_forest.h"

#include <Eigen/Dense>

#include <algorithm>
#include <limits>

namespace halfshade {
namespace {

int longest_edge(const std::array<Vec3, 3>& corner) {
  int longest = 0;
  double most = 0;
  for (int k = 0; k < 3; ++k)
    if (const double l = (corner[at((k + 1) % 3)] - corner[at(k)]).squaredNorm(); l > most) {
      most = l;
      longest = k;
    }
  return longest;
}

double area_of(const std::array<Vec3, 3>& corner) {
  return 0.5 * (corner[1] - corner[0]).cross(corner[2] - corner[0]).norm();
}

/// The box of a triangle with room for the rounding of points that are asked for.
Bounds roomy_box(const std::array<Vec3, 3>& corner) {
  Bounds box;
  for (const Vec3& p : corner) box.include(p);
  const double magnitude = std::max(box.low.lpNorm<Eigen::Infinity>(),  //
                                    box.high.lpNorm<Eigen::Infinity>());
  return box.grown(1e-9 * (box.high - box.low).maxCoeff() +
                   64 * std::numeric_limits<double>::epsilon() * magnitude);
}

double least_weight(const TrianglePlace& p) { return std::min({p.x(), p.y(), 1 - p.x() - p.y()}); }

TrianglePlace clamped(const TrianglePlace& p) {
  const TrianglePlace q = p.cwiseMax(0.);
  return q.sum() > 1 ? TrianglePlace(q / q.sum()) : q;
}

}  // namespace

TriangleForest::TriangleForest(const ElementTable& roots)
    : root_count_(roots.count()), surface_(roots.surface) {
  std::vector<Bounds> boxes;
  for (int e = 0; e < roots.count(); ++e) {
    const auto corner = roots.triangle(e);
    triangles_.push_back({corner, area_of(corner), e, 0, -1, longest_edge(corner)});
    boxes.push_back(roomy_box(corner));
    Eigen::Matrix<double, 3, 2> edges;
    edges << corner[1] - corner[0], corner[2] - corner[0];
    place_map_.push_back(
        {corner[0], edges.colPivHouseholderQr().solve(Eigen::Matrix3d::Identity())});
    const std::size_t surface = at(surface_[at(e)]);
    if (of_surface_.size() <= surface) of_surface_.resize(surface + 1);
    of_surface_[surface].push_back(e);
  }
  tree_ = make_flat_tree(boxes);
}

void TriangleForest::bisect(int triangle) {
  const Triangle parent = triangles_[at(triangle)];
  if (parent.child >= 0) return;
  const std::size_t a = at(parent.cut), b = (a + 1) % 3, c = (a + 2) % 3;
  const Vec3 middle = 0.5 * (parent.corner[a] + parent.corner[b]);
  triangles_[at(triangle)].child = count();
  for (const auto& corner : {std::array<Vec3, 3>{parent.corner[a], middle, parent.corner[c]},
                             std::array<Vec3, 3>{middle, parent.corner[b], parent.corner[c]}})
    triangles_.push_back(
        {corner, 0.5 * parent.area, parent.root, parent.level + 1, -1, longest_edge(corner)});
}

ForestPlace TriangleForest::leaf_at(ForestPlace from) const {
  for (;;) {
    const Triangle& triangle = triangles_[at(from.triangle)];
    if (triangle.child < 0) return from;
    const std::array<double, 3> w = {1 - from.place.x() - from.place.y(), from.place.x(),
                                     from.place.y()};
    const double wa = w[at(triangle.cut)], wb = w[at((triangle.cut + 1) % 3)];
    const double wc = w[at((triangle.cut + 2) % 3)];
    if (wa >= wb)
      from = {triangle.child, {2 * wb, wc}};
    else
      from = {triangle.child + 1, {wb - wa, wc}};
  }
}

ForestPlace TriangleForest::leaf_at(int surface, const Vec3& position) const {
  if (surface < 0 || at(surface) >= of_surface_.size()) return {};
  ForestPlace best;
  double most = -std::numeric_limits<double>::infinity();
  const auto look_at = [&](int root) {
    const TrianglePlace place = place_map_[at(root)](position);
    if (const double least = least_weight(place); least > most) {
      most = least;
      best = {root, place};
    }
  };
  const std::vector<int>& roots = of_surface_[at(surface)];
  constexpr std::size_t few = 4;
  if (roots.size() > few)
    visit_overlaps(tree_, {position, position}, [&](int root) {
      if (surface_[at(root)] == surface) look_at(root);
    });
  if (best.triangle < 0)
    for (const int root : roots) look_at(root);
  if (best.triangle < 0) return best;
  best.place = clamped(best.place);
  return leaf_at(best);
}

}  // namespace halfshade
