#pragma once

#include "meshing/patches/patch_mesh.h"
#include "solver/adapt/fitted_element.h"

#include <span>
#include <vector>

namespace halfshade {

/// An element that could take the place of its parts.
struct PossibleWhole {
  int node;                ///< of the hierarchy
  std::vector<int> parts;  ///< elements
  ElementFit fit;          ///< to theirs; its error is that, and what they say of theirs
  double more;             ///< square error, weighted, that it adds
  int fewer;               ///< unknowns that it saves
};

/// Those of which all parts are elements, and whose polynomials can be one of no more than the
/// highest order of theirs or one more, those first that add least for an unknown that they save.
/// `order`: of all elements, or −1.
std::vector<PossibleWhole> possible_wholes(const PatchMesh& mesh,
                                           std::span<const FittedElement> elements, int order,
                                           int highest_order);

}  // namespace halfshade
