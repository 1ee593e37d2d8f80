#pragma once

#include "solver/heat/heat.h"
#include "solver/pipeline/solve.h"

#include <functional>
#include <vector>

namespace halfshade {

/// Any way to solve a scene in its three channels.
using SceneSolver = std::function<SolveResult(const Scene&)>;

/// What materials (rows) reflect and send out in each band (columns).
struct BandMaterials {
  Eigen::ArrayXXd rho, exitance;
};

/// As `heat` has them; of a scene whose bands have no names the first channel.
BandMaterials band_materials(const Scene& scene, const Heat& heat);

/// Light in any number of bands. Columns are bands; what space sends is left out of everything.
struct BandLight {
  SolveResult result;  ///< all but the light, on elements that all bands share
  Eigen::ArrayXXd irradiance, direct_irradiance;  ///< means over the elements, W/m²
  Eigen::ArrayXXd field, direct_field;            ///< coefficients, if elements have polynomials
  std::vector<ChannelReport> reports;  ///< of each band: the solver's part, and what escapes
  bool both_signs = false;             ///< bands have parts that may be off in opposite directions
  int packs = 1;                       ///< times the scene was solved
};

/// Solves for what differs from space that sends `space` in each band (W/m²) from everywhere: with
/// E′ = E − (1 − rho) b space is dark, see solve_net_exchange. Where E′ has both signs in a band,
/// the two parts are solved apart and subtracted. All parts go three at a time through `solve`.
/// `materials` has a row for each of the scene's. Error estimates are sums over bands if there are
/// more than three, for so are the channels then. Throws as `solve` and share_elements do, and
/// Error(usage) if results of several times cannot be put together: goals, regions and stages.
BandLight solve_bands(const Scene& scene, const BandMaterials& materials,
                      const Eigen::ArrayXd& space, const SceneSolver& solve);

}  // namespace halfshade
