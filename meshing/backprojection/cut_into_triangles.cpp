#include "meshing/backprojection/opaque_topology.h"
#include "meshing/triangulation/ring_triangles.h"

namespace halfshade {

void cut_into_triangles(const SoundScene& scene, OpaqueTopology& out) {
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    if (scene.surfaces[r].back) continue;  // its front blocks already
    const OpaqueTopology::OpaqueSurface& surface = out.surfaces[r];
    std::vector<Ring> images;
    std::vector<int> vertex;  // of each corner
    for (int ring = surface.first_ring; ring < surface.first_ring + surface.ring_count; ++ring) {
      images.emplace_back();
      for (const OpaqueTopology::OutlineVertex& v : out.ring(ring)) {
        images.back().push_back(surface.frame.to_plane(out.vertices[at(v.vertex)]));
        vertex.push_back(v.vertex);
      }
    }
    for (const auto& t : ring_triangles(images)) {
      const int a = vertex[at(t[0])], b = vertex[at(t[1])], c = vertex[at(t[2])];
      if (a != b && b != c && c != a)
        out.triangles.push_back({{a, b, c}, {-1, -1, -1}, static_cast<int>(r)});
    }
  }
}

}  // namespace halfshade
