#include "meshing/backprojection/opaque_topology.h"
#include "meshing/backprojection/rounding.h"
#include "meshing/triangulation/planar_mesh.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

double turn_2d(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

/// Four corners clearly convex: two triangles will do.
bool is_convex_quad(const Ring& ring) {
  if (ring.size() != 4) return false;
  double least = HUGE_VAL, most = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const double area = turn_2d(ring[k], ring[(k + 1) % 4], ring[(k + 2) % 4]);
    least = std::min(least, area);
    most = std::max(most, area);
  }
  return least > rounding::clearly_convex * most;
}

/// The vertex whose image in the plane lies nearest to q.
int nearest(const std::vector<Ring>& images, std::span<const std::vector<int>> vertices,
            const Vec2& q) {
  double best = HUGE_VAL;
  int found = -1;
  for (std::size_t r = 0; r < images.size(); ++r)
    for (std::size_t k = 0; k < images[r].size(); ++k)
      if (const double d = (images[r][k] - q).squaredNorm(); d < best) {
        best = d;
        found = vertices[r][k];
      }
  return found;
}

void add_triangle(OpaqueTopology& out, int surface, int a, int b, int c) {
  if (a != b && b != c && c != a) out.triangles.push_back({{a, b, c}, {-1, -1, -1}, surface});
}

}  // namespace

void cut_into_triangles(const SoundScene& scene, OpaqueTopology& out) {
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    if (scene.surfaces[r].back) continue;  // its front blocks already
    const OpaqueTopology::OpaqueSurface& surface = out.surfaces[r];
    std::vector<Ring> images;
    std::vector<std::vector<int>> vertices;
    for (int ring = surface.first_ring; ring < surface.first_ring + surface.ring_count; ++ring) {
      images.emplace_back();
      vertices.emplace_back();
      for (const OpaqueTopology::OutlineVertex& v : out.ring(ring)) {
        images.back().push_back(surface.frame.to_plane(out.vertices[at(v.vertex)]));
        vertices.back().push_back(v.vertex);
      }
    }
    const int id = static_cast<int>(r);
    const std::vector<int>& outer = vertices[0];
    if (images.size() == 1 && outer.size() < 3) continue;
    if (images.size() == 1 && (outer.size() == 3 || is_convex_quad(images[0]))) {
      for (std::size_t k = 2; k < outer.size(); ++k)
        add_triangle(out, id, outer[0], outer[k - 1], outer[k]);
      continue;
    }
    const PlanarMesh mesh = triangulate(images, {});
    std::vector<int> name;
    for (const Vec2& q : mesh.points) name.push_back(nearest(images, vertices, q));
    for (const auto& [a, b, c] : mesh.triangles)
      add_triangle(out, id, name[at(a)], name[at(b)], name[at(c)]);
  }
}

}  // namespace halfshade
