#pragma once

#include "solver/reflected/exact_sight.h"
#include "solver/reflected/near_backs.h"
#include "solver/reflected/reflected_mesh.h"

#include <Eigen/Core>

#include <span>

namespace halfshade {

/// An element, and what it looks at.
struct ElementView {
  const ExactSight& sight;
  const ReflectedMesh& mesh;
  int element;
  const Vec3& normal;
  std::span<const Sighted> targets;  ///< what it may see
};

/// What an element's nodes miss of slits along its edges, as between a box and a lid that is lifted
/// a little: there, within some gaps' width, up to half of the hemisphere is empty, as before a
/// back that swallows light. ω, the share of a place's hemisphere that is seen, is integrated in
/// strips that halve towards each edge; `seen_at_nodes` is ω at the element's nodes. Empty if there
/// are none, or if a surface faces the element closer than half of what it is long, where light is
/// not even (unsure_losses tells of that). Exact to first order in gap / size for straight slits.
/// Cost: at most 27 looks at all targets, and for each slit some 24 for each halving.
BackShadow slit_shadow(const ElementView& view, const Eigen::VectorXd& seen_at_nodes);

/// What is not known of what is missed along a slit that is as wide as a share of the element's
/// size.
double unsure_part_of_slit(double width);

}  // namespace halfshade
