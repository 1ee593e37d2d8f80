#include "meshing/rays/occluders.h"

#include "meshing/triangulation/ring_triangles.h"

namespace halfshade {
namespace {

TriangleSoup triangles_of(const SoundScene& scene, bool with_backs) {
  TriangleSoup soup;
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    const Surface& surface = scene.surfaces[r];
    if (surface.back && !with_backs) continue;
    const int first = static_cast<int>(soup.points.size());
    for (const Ring& ring : surface.rings)
      for (const Vec2& p : ring) soup.points.push_back(surface.frame.to_space(p));
    for (const auto& t : ring_triangles(surface.rings)) {
      soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      soup.owner.push_back(static_cast<int>(r));
      soup.plane.push_back(surface.plane);
    }
  }
  return soup;
}

}  // namespace

TriangleSoup occluders(const SoundScene& scene) { return triangles_of(scene, false); }

TriangleSoup surface_triangles(const SoundScene& scene) { return triangles_of(scene, true); }

}  // namespace halfshade
