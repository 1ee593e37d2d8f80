#include "meshing/planar_mesh.h"
#include "meshing/visibility.h"

namespace halfshade {

TriangleSoup occluders(const SoundScene& scene) {
  TriangleSoup soup;
  for (std::size_t r = 0; r < scene.receivers.size(); ++r) {
    const Receiver& receiver = scene.receivers[r];
    if (receiver.back) continue;
    // Contact lines divide the light on a receiver, not the light it takes from others.
    const PlanarMesh mesh = triangulate(receiver.rings, {});
    const int first = static_cast<int>(soup.points.size());
    for (const Vec2& p : mesh.points) soup.points.push_back(receiver.frame.to_space(p));
    for (const auto& t : mesh.triangles) {
      soup.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      soup.owner.push_back(static_cast<int>(r));
      soup.plane.push_back(receiver.plane);
    }
  }
  return soup;
}

TriangleSoup occluders(const ElementTable& elements) {
  TriangleSoup soup;
  soup.points = elements.points;
  soup.triangles = elements.corners;
  for (int e = 0; e < elements.count(); ++e) soup.owner.push_back(e);
  soup.plane.assign(soup.triangles.size(), -1);
  return soup;
}

}  // namespace halfshade
