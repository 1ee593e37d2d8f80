#pragma once

#include "solver/reflected/reflected_system.h"

#include <vector>

namespace halfshade {

/// The elements on which light that goes to and fro grows, or hardly falls, as no light does: what
/// polynomials on either side of a gap, or where sheets all but touch, make of each other between
/// their nodes. A few reflections of light that is uneven within each element tell: what is real is
/// soon even. Constant ones are none; none are found if stopped. Cost: ten applications of the
/// exchange.
std::vector<int> unstable_elements(const ReflectedSystem& system);

/// Makes them constant in the system's own mesh. Whether there were any: the system is none of this
/// mesh any more.
bool make_stable(const ReflectedSystem& system, ReflectedMesh& mesh);

}  // namespace halfshade
