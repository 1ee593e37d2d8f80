#pragma once

#include "meshing/events/swath.h"
#include "meshing/geometry/conic_arc.h"

#include <vector>

namespace halfshade {

/// The curve that the lines with parameters from t0 to t1 > t0 make on a plane, in its coordinates:
/// one straight arc for a planar swath, else arcs of conics, one after the other, as few as halving
/// allows. Arcs are straight if all their points lie on a line to within `flat` (a length).
/// Precondition: no line between runs along the plane.
std::vector<ConicArc> fit_arcs(const Swath& swath, double t0, double t1, const PlaneFrame& plane,
                               double flat);

}  // namespace halfshade
