#include "meshing/repair/weld.h"

#include "meshing/core/tolerance.h"
#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>

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
  return result;
}

}  // namespace halfshade
