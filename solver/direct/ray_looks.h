#pragma once

#include "solver/direct/emitter_tree.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// What rays to one emitter, or to one of a group that is drawn, are to tell.
struct RayLook {
  const RayEmitter* emitter = nullptr;  ///< null: a group
  int group = -1;                       ///< node of the tree
  double factor = 0;                    ///< form factor if nothing is in between; not of groups
  double strength = 0;                  ///< light that gives, in W/m²; of groups, the most
  bool is_rough = false;                ///< that is known but for far_error
  std::size_t first_part = 0, end_part = 0;  ///< of a list of parts; none: light from it is even
};

/// Form factor if nothing is in between, exact.
double exact_factor(const SurfacePoint& point, const RayEmitter& emitter);

/// Emitters that a point may see; those that give `weak` W/m² or less in groups that do.
void collect_looks(const EmitterTree& tree, const SurfacePoint& point, double weak,
                   std::vector<RayLook>& looks);

/// The emitter that gives a point the most light if nothing is in between; null if none does.
const RayEmitter* strongest_emitter(const EmitterTree& tree, const SurfacePoint& point);

}  // namespace halfshade
