#include "solver/exchange/surface_pairs.h"

#include "meshing/core/parallel.h"

#include <algorithm>

namespace halfshade {
namespace {

std::vector<Vec3> outline(const Surface& surface) {
  std::vector<Vec3> corners;
  corners.reserve(surface.rings.front().size());
  for (const Vec2& q : surface.rings.front()) corners.push_back(surface.frame.to_space(q));
  return corners;
}

bool reaches_in_front(const std::vector<Vec3>& corners, const PlaneFrame& plane, double margin) {
  return std::any_of(corners.begin(), corners.end(),
                     [&](const Vec3& p) { return plane.height(p) > margin; });
}

}  // namespace

SurfacePairs::SurfacePairs(const SoundScene& scene, const VisibilityIndex& visibility,
                           const Progress& progress)
    : count_(scene.surfaces.size()),
      sight_(count_ * count_, Sight::none),
      blockers_(count_ * count_) {
  std::vector<std::vector<Vec3>> outlines;
  std::vector<Eigen::AlignedBox3d> boxes(count_);
  for (std::size_t r = 0; r < count_; ++r) {
    outlines.push_back(outline(scene.surfaces[r]));
    for (const Vec3& p : outlines[r]) boxes[r].extend(p);
  }
  const auto classify = [&](std::size_t r) {
    for (std::size_t s = r + 1; s < count_; ++s) {
      const double margin = tolerance_of(scene.surfaces[r], scene.surfaces[s]).length;
      if (!reaches_in_front(outlines[s], scene.surfaces[r].frame, margin) ||
          !reaches_in_front(outlines[r], scene.surfaces[s].frame, margin))
        continue;
      Sight& sight = sight_[r * count_ + s];
      sight = Sight::clear;
      for (const int between : visibility.candidates(outlines[r], outlines[s])) {
        const auto b = static_cast<std::size_t>(between);
        if (b == r || b == s) continue;
        sight = Sight::sampled;
        blockers_[r * count_ + s].extend(boxes[b]);
      }
    }
  };
  parallel_for(count_, classify, progress, "surface pairs");
  for (std::size_t r = 0; r < count_; ++r)
    for (std::size_t s = 0; s < r; ++s) {
      sight_[r * count_ + s] = sight_[s * count_ + r];
      blockers_[r * count_ + s] = blockers_[s * count_ + r];
    }
}

}  // namespace halfshade
