#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/reflected_system.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// Irradiance by many rays that are not kept.
struct FinalPass {
  ElementField rest;          ///< K (S + leaving)
  std::vector<double> noise;  ///< element → ∫ over it of the square of what the rays are off
  std::size_t rays = 0;
  bool complete = true;
};

struct FinalPassOptions {
  int rays = 256;  ///< from a node of an element of mean size; small ones get fewer
  int use = 0;     ///< see ray_seed: passes with different ones are independent
};

/// One more application of K, to S and `leaving`. On all threads.
FinalPass final_pass(const ReflectingScene& scene, const ReflectedMesh& mesh,
                     const FirstLight& light, const ElementField& leaving,
                     const FinalPassOptions& options, const Progress& progress);

/// Scales the irradiance of closed systems so that K conserves power: what leaves, arrives.
/// `leaving` is what `rest` came from without S, which puts in `power`.
void conserve_power(const ReflectedMesh& mesh, const LightSystems& systems,
                    const ElementField& leaving, const ChannelArray& power,
                    SplitIrradiance& irradiance);

}  // namespace halfshade
