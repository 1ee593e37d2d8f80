#pragma once

#include "solver/reflected/hemisphere_rays.h"

#include <cstdint>
#include <vector>

namespace halfshade {

/// Places spread over a surface by area, the next one a golden section on along its triangles and
/// at random within the one it comes to. The same for equal arguments.
class SurfaceOrigins {
 public:
  /// `roots` are the triangles of the surface with this number; all must outlive it.
  SurfaceOrigins(const ReflectingScene& scene, const std::vector<int>& roots, std::size_t surface)
      : scene_(&scene), roots_(&roots), next_seed_(static_cast<std::uint64_t>(surface) << 32) {
    for (const int root : roots) area_ += scene.roots.area[at(root)];
  }

  RayOrigin next();

  double area() const { return area_; }
  /// For what else is random at the last origin.
  std::uint64_t seed() const { return next_seed_; }

 private:
  const ReflectingScene* scene_;
  const std::vector<int>* roots_;
  std::uint64_t next_seed_;
  double area_ = 0, along_ = 0.5;
};

/// The triangles of each surface.
std::vector<std::vector<int>> roots_of_surfaces(const ReflectingScene& scene, std::size_t surfaces);

}  // namespace halfshade
