#include "meshing/backprojection/margins.h"
#include "meshing/backprojection/opaque_topology.h"
#include "meshing/core/planes_explain.h"
#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace halfshade {
namespace {

/// One point per corner of a ring, in the order of the scene.
struct Corners {
  std::vector<Vec3> position;
  std::vector<double> reach;  // corners this close are the same
  std::vector<int> edge;
  std::vector<int> surface;
};

void add_ring(const SoundScene& scene, int id, const Ring& ring, const LocalTolerance& tolerance,
              int first_edge, Corners& corners) {
  const Surface& surface = scene.surfaces[at(id)];
  const std::size_t n = ring.size();
  for (std::size_t k = 0; k < n; ++k) {
    const double before = (ring[k] - ring[(k + n - 1) % n]).norm();
    const double after = (ring[(k + 1) % n] - ring[k]).norm();
    corners.position.push_back(surface.frame.to_space(ring[k]));
    corners.reach.push_back(std::max(
        tolerance.length,
        std::min(2 * tolerance.planarity, margins::largest_joint_gap * std::min(before, after))));
    corners.edge.push_back(first_edge + static_cast<int>(k));
    corners.surface.push_back(id);
  }
}

Bounds box_about(const Vec3& p, double reach) {
  return {p - Vec3::Constant(reach), p + Vec3::Constant(reach)};
}

bool comes_first(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

/// Maps each corner to a vertex. Corners that are joined differ by the digits of the file; which of
/// them is the vertex follows from where they are, so that the order of faces does not matter.
std::vector<int> join(const SoundScene& scene, const Corners& corners,
                      std::vector<Vec3>& vertices) {
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < corners.position.size(); ++i)
    boxes.push_back(box_about(corners.position[i], 0));
  const FlatTree tree = make_flat_tree(boxes);
  std::vector<int> vertex(corners.position.size(), -1);
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    if (vertex[i] >= 0) continue;
    vertex[i] = static_cast<int>(vertices.size());
    vertices.push_back(corners.position[i]);
    visit_overlaps(tree, box_about(corners.position[i], corners.reach[i]), [&](int j) {
      const Vec3 offset = corners.position[at(j)] - corners.position[i];
      if (vertex[at(j)] < 0 && offset.norm() <= std::min(corners.reach[i], corners.reach[at(j)]) &&
          planes_explain(offset, scene.surfaces[at(corners.surface[i])],
                         scene.surfaces[at(corners.surface[at(j)])])) {
        vertex[at(j)] = vertex[i];
        if (comes_first(corners.position[at(j)], vertices.back()))
          vertices.back() = corners.position[at(j)];
      }
    });
  }
  return vertex;
}

/// Whether the projections along some axis show that a line passes a box.
bool line_misses(const Vec3& point, const Vec3& along, const Bounds& box) {
  const Vec3 offset = box.centre() - point, half = box.half_size();
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Index i = (k + 1) % 3, j = (k + 2) % 3;
    const double reach = half[i] * std::abs(along[j]) + half[j] * std::abs(along[i]);
    // A box of no size on the line must not be lost to rounding.
    const double slack = margins::line_slack *
                         (std::abs(offset[i] * along[j]) + std::abs(offset[j] * along[i]) + reach);
    if (std::abs(offset[i] * along[j] - offset[j] * along[i]) > reach + slack) return true;
  }
  return false;
}

/// Appends the vertices that lie within `reach` of the inside of a straight edge, in order.
struct EdgeFiller {
  const std::vector<Vec3>& vertices;
  const FlatTree& tree;
  std::vector<std::pair<double, int>> found;

  void add(int from, int to, int edge, double reach,
           std::vector<OpaqueTopology::OutlineVertex>& outline) {
    const Vec3 a = vertices[at(from)], along = vertices[at(to)] - a;
    const Bounds box = bounds_of(a, vertices[at(to)]);
    const auto may_reach = [&](const Bounds& other) {
      const Bounds grown = other.grown(reach);
      return box.meets(grown) && !line_misses(a, along, grown);
    };
    found.clear();
    visit_reached(tree, may_reach, [&](int v) {
      if (v == from || v == to) return;
      const Vec3 offset = vertices[at(v)] - a;
      const double t = along.dot(offset) / along.squaredNorm();
      if (t > 0 && t < 1 && (offset - t * along).norm() <= reach) found.emplace_back(t, v);
    });
    std::sort(found.begin(), found.end());
    for (const auto& [t, v] : found) outline.push_back({v, edge});
  }
};

}  // namespace

void join_outlines(const SoundScene& scene, OpaqueTopology& out) {
  Corners corners;
  std::vector<int> sizes;
  std::vector<double> reach;  // of each ring's edges
  for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s) {
    const Surface& surface = scene.surfaces[at(s)];
    OpaqueTopology::OpaqueSurface opaque{surface.frame, static_cast<int>(sizes.size()),
                                         static_cast<int>(surface.rings.size()),
                                         tolerance_of(surface)};
    int first_edge = 0;
    for (const Ring& ring : surface.rings) {
      add_ring(scene, s, ring, opaque.tolerance, first_edge, corners);
      first_edge += static_cast<int>(ring.size());
      for (const Vec2& p : ring)
        opaque.magnitude =
            std::max(opaque.magnitude, surface.frame.to_space(p).lpNorm<Eigen::Infinity>());
      sizes.push_back(static_cast<int>(ring.size()));
      reach.push_back(opaque.tolerance.length);
    }
    out.surfaces.push_back(opaque);
  }
  const std::vector<int> vertex = join(scene, corners, out.vertices);
  std::vector<Bounds> boxes;
  for (const Vec3& p : out.vertices) boxes.push_back(box_about(p, 0));
  const FlatTree tree = make_flat_tree(boxes);
  EdgeFiller filler{out.vertices, tree, {}};
  std::size_t first = 0;
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    const int size = sizes[r];
    OpaqueTopology::RingRange range{static_cast<int>(out.outline.size()), 0};
    for (std::size_t k = 0; k < at(size); ++k) {
      const int from = vertex[first + k], to = vertex[first + (k + 1) % at(size)];
      if (from == to) continue;
      out.outline.push_back({from, corners.edge[first + k]});
      filler.add(from, to, corners.edge[first + k], reach[r], out.outline);
    }
    range.count = static_cast<int>(out.outline.size()) - range.first;
    out.rings.push_back(range);
    first += at(size);
  }
  for (const Vec3& p : out.vertices)
    out.magnitude = std::max(out.magnitude, p.lpNorm<Eigen::Infinity>());
}

}  // namespace halfshade
