#include "meshing/repair/weld.h"

#include "meshing/core/tolerance.h"
#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

/// Of every vertex: its own magnitude, and the size of the smallest face at it; 0 if there is none.
std::vector<LocalScale> vertex_scales(const Scene& scene) {
  std::vector<LocalScale> scales(scene.vertices.size());
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f) {
    const double size = scale_of(face_corners(scene, f)).size;
    for (const int v : scene.faces[at(f)].vertices) {
      LocalScale& scale = scales[at(v)];
      if (scale.size == 0 || (size > 0 && size < scale.size)) scale.size = size;
      scale.magnitude = scene.vertices[at(v)].cwiseAbs().maxCoeff();
    }
  }
  return scales;
}

/// The largest coordinate of each connected part of the scene, for each of its points.
std::vector<double> connected_magnitudes(const Scene& scene, const WeldedVertices& vertices) {
  std::vector<int> parent(vertices.points.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int p) {
    while (parent[at(p)] != p) p = parent[at(p)] = parent[at(parent[at(p)])];
    return p;
  };
  for (const Face& face : scene.faces)
    for (const int v : face.vertices)
      parent[at(root(vertices.of_vertex[at(v)]))] =
          root(vertices.of_vertex[at(face.vertices.front())]);
  std::vector<double> magnitude(parent.size(), 0);
  for (std::size_t p = 0; p < parent.size(); ++p) {
    double& largest = magnitude[at(root(static_cast<int>(p)))];
    largest = std::max(largest, vertices.points[p].cwiseAbs().maxCoeff());
  }
  for (std::size_t p = 0; p < parent.size(); ++p)
    magnitude[p] = magnitude[at(root(static_cast<int>(p)))];
  return magnitude;
}

}  // namespace

WeldedVertices weld(const Scene& scene) {
  WeldedVertices result;
  result.of_vertex.assign(scene.vertices.size(), -1);
  const std::vector<LocalScale> scales = vertex_scales(scene);
  std::vector<int> used;
  std::vector<bool> is_used(scene.vertices.size(), false);
  for (const Face& face : scene.faces)
    for (const int v : face.vertices) is_used[at(v)] = true;
  std::vector<Bounds> boxes;
  for (std::size_t v = 0; v < is_used.size(); ++v)
    if (is_used[v]) {
      used.push_back(static_cast<int>(v));
      boxes.push_back({scene.vertices[v], scene.vertices[v]});
    }
  const FlatTree tree = make_flat_tree(boxes, 1);
  for (const int v : used) {
    const Vec3& p = scene.vertices[at(v)];
    const Bounds around = Bounds{p, p}.grown(tolerance_of(scales[at(v)]).length);
    int first = v;
    visit_overlaps(tree, around, [&](int item) {
      const int other = used[at(item)];
      // Only those that stand for themselves.
      const int point = result.of_vertex[at(other)];
      if (other >= first || point < 0 || result.points[at(point)] != scene.vertices[at(other)])
        return;
      const double near = tolerance_of(joint_scale(scales[at(v)], scales[at(other)])).length;
      if ((scene.vertices[at(other)] - p).norm() <= near) first = other;
    });
    if (first == v) {
      result.of_vertex[at(v)] = static_cast<int>(result.points.size());
      result.points.push_back(p);
    } else {
      result.of_vertex[at(v)] = result.of_vertex[at(first)];
    }
  }
  result.magnitude = connected_magnitudes(scene, result);
  return result;
}

}  // namespace halfshade
