#pragma once

#include "solver/reflected/exact_sight.h"
#include "solver/reflected/irradiance_row.h"
#include "solver/reflected/reflected_mesh.h"

#include <span>
#include <vector>

namespace halfshade {

/// The mean form factor of an element to a surface that lies close before it.
struct NearFactor {
  int surface;
  double mean;   ///< to about 1e-7
  double parts;  ///< into which the element's length had to be cut to see how light gets lost
};

/// Those to surfaces that face an element nearer than it is long, with nothing between. Light gets
/// out of a gap within a few times its width of the border: nodes hardly ever lie there, and see
/// none of it get lost. In closed form (mutual_area). `targets` are what may_see() found for it.
std::vector<NearFactor> near_factors(const ExactSight& sight, const ReflectedMesh& mesh,
                                     int element, std::span<const Sighted> targets);

/// The same mean by the rows of an element's nodes.
double mean_factor(int surface, const ReflectedMesh& mesh, const ElementTable& roots, int element,
                   std::span<const IrradianceRow> rows);

}  // namespace halfshade
