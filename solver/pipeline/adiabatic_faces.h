#pragma once

#include "solver/pipeline/band_light.h"

#include <vector>

namespace halfshade {

/// A scene in which each face with a balance to find (see is_balanced) has a material of its own,
/// behind those of the scene.
struct AdiabaticFaces {
  Scene scene;
  BandMaterials materials;    ///< of the scene; adiabatic ones send out nothing yet
  std::vector<int> face;      ///< those
  std::vector<int> material;  ///< theirs; −1: it is black in no band, and has no temperature
  std::vector<int> original;  ///< of each material: that of the scene it was made of
};

AdiabaticFaces adiabatic_faces(const Scene& scene, const Heat& heat);

/// Finds the temperatures of adiabatic faces in several bands or on two sides, each face at one, so
/// that they absorb in all bands and on both sides together what they send out, and makes them send
/// that out. `space` is what space sends in each band. The scene is solved once without them and
/// once for each of them, in all bands: the rest is a small system, see balanced_temperatures.
/// Returns K for each face of the scene, NaN where nothing was to be found. Throws as solve_bands
/// and require_fixed_temperatures do, and Error(invalid_input) where there are too many of them, or
/// the bands hold too little to tell their temperature.
std::vector<double> find_temperatures(AdiabaticFaces& faces, const Heat& heat,
                                      const Eigen::ArrayXd& space, const SceneSolver& solve);

}  // namespace halfshade
