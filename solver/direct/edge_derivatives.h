#pragma once

#include "meshing/backprojection/visible_part.h"

namespace halfshade {

struct EdgeDerivatives {
  Vec3 gradient = Vec3::Zero();
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
};

/// First and second derivatives of the form factor to the visible part, with respect to the
/// point and for a fixed normal, in closed form.
///
/// The form factor is ∫ n·u dΩ/π over the visible directions u. It changes only because the
/// boundary moves, and each piece of it stays in the plane of the point and its edge, so that the
/// gradient is a sum of integrals along the edges (compare Arvo 1994). In the second derivatives
/// the ends of the pieces move, too, where one edge hides another: see `end_motion` in the source.
/// Exact within a cell of the discontinuity mesh; unbounded where its border is approached so that
/// two edges that meet line up.
EdgeDerivatives edge_derivatives(const Vec3& point, const Vec3& normal, const VisiblePart& part);

}  // namespace halfshade
