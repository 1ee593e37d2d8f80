#pragma once

#include "meshing/patches/element_table.h"

#include <vector>

namespace halfshade {

/// Grounds, suns, what is far away: surfaces far larger than all smaller ones together, which say
/// nothing about how fine the others' elements should be.
struct HugeRoots {
  std::vector<bool> is_huge;  ///< root → whether its surface is
  double area = 0;            ///< of all others, squared scene units
};

/// There is always a surface that is not huge.
HugeRoots find_huge(const ElementTable& roots);

}  // namespace halfshade
