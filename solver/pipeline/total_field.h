#pragma once

#include "solver/pipeline/direct_field.h"
#include "solver/pipeline/solve_options.h"
#include "solver/reflected/reflected_light.h"

#include <optional>
#include <vector>

namespace halfshade {

struct TotalFieldOptions {
  ReflectedOptions reflected;
  /// Of reflected light as polynomials on the elements of direct light; its norm is that of all
  /// irradiance.
  AdaptiveFieldOptions values;
  FinalGather final_gather = FinalGather::off;
};

/// Direct and reflected light together, on the elements of direct light and parts of them.
struct TotalField {
  ElementTable elements;
  ElementField direct, irradiance;
  Eigen::ArrayXd error;  ///< root mean square over each element, the channels' squares summed; W/m²
  std::vector<Region> region;
  std::optional<ReflectedLight> reflected;
  std::vector<ElementField> bounces;  ///< of `irradiance`: reflected once, twice, …; if asked for
  AdaptiveFieldReport values;
  double relative_error = 0;  ///< of the whole, estimated, in the L2 norm
};

/// Solves for the light that direct light makes by reflection, on a mesh of its own, and adds the
/// two. Where direct light needs few elements, as in the dark, they are divided as reflected light
/// takes it. What a final gather makes better is not claimed. Adds its stages to `stages`.
TotalField add_reflected_light(const SoundScene& scene, DirectField direct,
                               const TotalFieldOptions& options, const Progress& progress,
                               Stages& stages);

}  // namespace halfshade
