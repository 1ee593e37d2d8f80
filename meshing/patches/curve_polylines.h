#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "meshing/patches/discontinuity_mesh.h"
#include "meshing/triangulation/curve_mesh.h"

#include <vector>

namespace halfshade {

/// Whether elements of size h across the curve are wrong by less than the irradiance tolerance:
/// J_k h^k / k! with the largest of the three jumps. Never true of order 0.
bool is_negligible(const DiscontinuityCurve& curve, double h, double irradiance_tolerance);

/// How far the mesh may be off a curve: with a tolerance where the damage J_k δ^k / k! reaches it,
/// within limits; a small part of the surface's size without.
double flattening_deviation(const DiscontinuityCurve& curve, double surface_size,
                            const DiscontinuityMeshOptions& options);

/// The curves that a mesh is to follow, as polylines.
struct CurvePolylines {
  std::vector<std::vector<CurvePolyline>> of_surface;  ///< id: index into Discontinuities::curves
  std::vector<double> deviation;  ///< of each surface: of polylines from their curves at most
  std::size_t kept = 0, culled = 0;
};

CurvePolylines curve_polylines(const SoundScene& scene, const Discontinuities& found,
                               const DiscontinuityMeshOptions& options);

}  // namespace halfshade
