#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/field_noise.h"
#include "solver/reflected/reflected_system.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// Irradiance by many rays that are not kept.
struct FinalPass {
  ElementField rest;  ///< K (S + leaving)
  FieldNoise noise;
  std::size_t rays = 0;
  bool complete = true;
};

/// One more application of K, to S and `leaving`, by two halves of strata² rays from each node of
/// each element. Passes with a different `use` are independent, see ray_seed. On all threads.
FinalPass final_pass(const ReflectingScene& scene, const ReflectedMesh& mesh,
                     const FirstLight& light, const ElementField& leaving,
                     const std::vector<int>& strata, int use, const Progress& progress);

/// How rays are shared among elements.
struct RayShares {
  double rays;               ///< from a node, that the noise was found with
  std::vector<double> sent;  ///< element → what rays from a node so far are as good as at once
  double wanted;             ///< ∫ of noise², weighted
  double most;               ///< as `sent`, in the mean over the elements
};

/// Strata of each element, 0 where there are rays enough, so that as few rays as possible bring the
/// noise down: as many from a node as its noise. Some of it is taken to be alike everywhere.
std::vector<int> share_rays(const ReflectedMesh& mesh, const std::vector<double>& noise,
                            const std::vector<double>& weight, const RayShares& shares);

/// Scales the irradiance of closed systems so that K conserves power: what leaves, arrives.
/// `leaving` is what `rest` came from without S, which puts in `power`.
void conserve_power(const ReflectedMesh& mesh, const LightSystems& systems,
                    const ElementField& leaving, const ChannelArray& power,
                    SplitIrradiance& irradiance);

/// What many rays change of `before` is reflected on, too, by the exchange. Only its means: the
/// rest of it is mostly noise. `ambient` is that of the solution.
void reflect_change(const ReflectedSystem& system, const ElementField& before,
                    const ElementField& ambient, SplitIrradiance& irradiance);

}  // namespace halfshade
