#pragma once

#include "meshing/core/scene.h"

#include <vector>

/// Where light of lamps falls, as far as that can be told before a scene is made sound.
namespace halfshade::reading {

/// A face that shines.
struct ShiningFace {
  int face = 0;
  Rgb exitance = Rgb::Zero();  ///< its mean
};

/// A point that stands for an area around it.
struct LightReceiver {
  Vec3 position, normal;
  double area = 0;
};

struct LightReceivers {
  std::vector<LightReceiver> points;
  double norm = 0;  ///< root of ∫ H² of all channels over the faces, if nothing is in between
};

/// Hundreds of points on the front of the scene's faces, the denser the more light there is.
/// `first` are looked at before the scene's other lamps, of which the weakest may be left out.
LightReceivers light_receivers(const Scene& scene, const std::vector<ShiningFace>& first);

}  // namespace halfshade::reading
