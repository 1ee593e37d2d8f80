#pragma once

#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/rays/visibility.h"

#include <Eigen/Geometry>

#include <vector>

namespace halfshade {

/// How the elements of two surfaces can see each other.
enum class Sight {
  none,    ///< they do not face each other
  clear,   ///< nothing can come between
  sampled  ///< something may
};

/// What is known of every pair of surfaces before any element is looked at.
class SurfacePairs {
 public:
  SurfacePairs(const SoundScene& scene, const VisibilityIndex& visibility,
               const Progress& progress = {});

  Sight sight(int r, int s) const { return sight_[at(r, s)]; }

  /// Contains everything that can come between r and s.
  const Eigen::AlignedBox3d& blockers(int r, int s) const { return blockers_[at(r, s)]; }

 private:
  std::size_t at(int r, int s) const {
    return static_cast<std::size_t>(r) * count_ + static_cast<std::size_t>(s);
  }

  std::size_t count_;
  std::vector<Sight> sight_;
  std::vector<Eigen::AlignedBox3d> blockers_;
};

}  // namespace halfshade
