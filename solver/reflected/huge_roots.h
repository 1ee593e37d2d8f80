#pragma once

#include "meshing/patches/element_table.h"

#include <vector>

namespace halfshade {

/// Grounds, suns, what is far away: surfaces far larger than all smaller ones together, or that get
/// hardly any light, which say nothing about how fine the others' elements should be.
struct HugeRoots {
  std::vector<bool> is_huge;  ///< root → whether its surface is; empty: none is
  double area = 0;            ///< of all others, squared scene units
  int others = 0;             ///< roots

  bool operator()(int root) const { return !is_huge.empty() && is_huge[at(root)]; }
};

/// `counted`: surface → false if it is huge in any case; empty: none is. There is always a
/// surface that is not huge, unless none is counted.
HugeRoots find_huge(const ElementTable& roots, const std::vector<bool>& counted = {});

}  // namespace halfshade
