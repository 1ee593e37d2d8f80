#include "meshing/backprojection/opaque_scene.h"

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/backprojection/silhouette_trees.h"
#include "meshing/geometry/flat_tree.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

FlatTree make_face_tree(const OpaqueTopology& topology) {
  std::vector<Bounds> boxes;
  for (const OpaqueTopology::Triangle& triangle : topology.triangles) {
    const Vec3& first = topology.vertices[at(triangle.corner[0])];
    Bounds box{first, first};
    for (const int v : triangle.corner) box.include(topology.vertices[at(v)]);
    boxes.push_back(box);
  }
  // A box is tested sooner than a face.
  return make_tight_tree(boxes, 1);
}

}  // namespace

OpaqueScene::OpaqueScene(const SoundScene& scene)
    : topology_(std::make_unique<OpaqueTopology>(make_opaque_topology(scene))),
      silhouette_trees_(std::make_unique<SilhouetteTrees>(make_silhouette_trees(*topology_))),
      face_tree_(std::make_unique<FlatTree>(make_face_tree(*topology_))) {}

int OpaqueScene::edge_count() const { return static_cast<int>(topology_->edges.size()); }

std::array<Vec3, 2> OpaqueScene::edge_ends(int edge) const {
  return topology_->ends(topology_->edges[at(edge)]);
}

double OpaqueScene::off_plane(int surface) const {
  const OpaqueTopology::OpaqueSurface& own = topology_->surfaces[at(surface)];
  double most = 0;
  for (int r = own.first_ring; r < own.first_ring + own.ring_count; ++r)
    for (const auto& [vertex, edge] : topology_->ring(r))
      most = std::max(most, std::abs(own.frame.height(topology_->vertices[at(vertex)])));
  return most;
}

OpaqueScene::~OpaqueScene() = default;
OpaqueScene::OpaqueScene(OpaqueScene&&) noexcept = default;
OpaqueScene& OpaqueScene::operator=(OpaqueScene&&) noexcept = default;

}  // namespace halfshade
