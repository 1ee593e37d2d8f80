#include "meshing/core/sound_scene.h"

#include "meshing/core/planar.h"

namespace halfshade {

LocalTolerance tolerance_of(const Surface& surface) { return tolerance_of(surface.scale); }

LocalTolerance tolerance_of(const Surface& a, const Surface& b) {
  return tolerance_of(joint_scale(a.scale, b.scale));
}

Rgb reflectance_at(const SoundScene& scene, const Surface& surface, const Vec3& position) {
  const Rgb& rho = scene.materials[at(surface.material)].rho;
  return surface.paint < 0 ? rho : Rgb(rho * colour_at(scene.paints[at(surface.paint)], position));
}

double area(const Surface& surface) {
  double twice = 0;
  for (const Ring& ring : surface.rings)
    for (std::size_t k = 1; k + 1 < ring.size(); ++k) {
      const Vec2 a = ring[k] - ring[0], b = ring[k + 1] - ring[0];
      twice += cross_2d(a, b);
    }
  return 0.5 * twice;
}

double size_of(const Surface& surface) {
  Eigen::AlignedBox2d box;
  for (const Vec2& p : surface.rings[0]) box.extend(p);
  return box.diagonal().norm();
}

}  // namespace halfshade
