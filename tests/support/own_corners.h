#pragma once

#include "meshing/core/scene.h"
#include "tests/support/random.h"

#include <algorithm>

namespace halfshade::test {

/// The scene with corners of its own for each face, off by up to `off` of the largest coordinate in
/// each: what a program writes that rounds each face by itself.
inline Scene with_own_corners(const Scene& scene, double off, std::uint64_t seed) {
  double magnitude = 0;
  for (const Vec3& p : scene.vertices) magnitude = std::max(magnitude, p.lpNorm<Eigen::Infinity>());
  Random random(seed);
  Scene result = scene;
  result.vertices.clear();
  for (Face& face : result.faces)
    for (int& v : face.vertices) {
      const Vec3 way(random(-1, 1), random(-1, 1), random(-1, 1));
      result.vertices.push_back(scene.vertices[at(v)] + off * magnitude * way);
      v = static_cast<int>(result.vertices.size()) - 1;
    }
  return result;
}

}  // namespace halfshade::test
