#pragma once

#include "meshing/patches/element_table.h"
#include "solver/elements/element_field.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

/// Elements as a file tells them, one entry a triangle: those of the same surface that have an edge
/// in common, to the last bit of its ends, are neighbours unless its order is 0 (see
/// ElementTable::edge_order). Fills points, corners, neighbours and edge_order.
ElementTable connected(std::span<const std::array<Vec3, 3>> triangles, std::span<const int> surface,
                       std::vector<std::array<int, 3>> edge_order);

/// Makes a field continuous within surfaces, for those who look at it: it is no nearer to what it
/// stands for, but steps are seen that are far below its error. Across D0 lines it stays apart, and
/// at their ends and at corners of what stands on a surface, where light has no single value. What
/// two elements say of their common edge is averaged, weighted by the inverse squares of `error`,
/// the root mean square of what each is off (so that an exact one keeps its light; infinite where
/// nobody knows); strips less than a hundredth as high as what is beside them follow it. Values at
/// inner nodes stay (after Oswald 1993). Orders rise to those of neighbours that have more to say.
/// Elements on which nothing changes by a thousandth of their error stay as they are.
///
/// Of `elements`, only points, corners and neighbours are read. Throws Error(contract) if there are
/// not as many elements, polynomials and errors.
void join(const ElementTable& elements, const Eigen::ArrayXd& error, ElementField& field);

}  // namespace halfshade
