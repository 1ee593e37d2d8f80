#pragma once

#include "meshing/core/types.h"
#include "meshing/rays/visibility.h"

#include <span>
#include <vector>

namespace halfshade {

/// Half a cube of side 2 round a point, cut into pixels (Cohen and Greenberg 1985): directions
/// through their centres, in a frame whose third axis is the normal, of unit length; and each
/// pixel's form factor by the midpoint rule, its delta factor. They sum to 1 but for the rule's
/// error, 0.54 over the square of the pixels.
struct Hemicube {
  std::vector<Vec3> directions;
  std::vector<double> factors;
};

/// `pixels` along an edge of the whole faces, even and ≥ 2: pixels² on the top, half as many on
/// each of the four sides. Throws Error(contract) for another number.
Hemicube make_hemicube(int pixels);

/// Where a hemicube stands.
struct HemicubePlace {
  Vec3 point, normal;  ///< of unit length
  Vec3 along;          ///< the direction of its edges in the plane of the point, not of zero length
};

/// The item buffer: adds each pixel's delta factor to the entry of `factors` that the owner of the
/// triangle met first has, if it is met from the front. `items` holds elements, each its own owner,
/// as `normals` has them; twins back to back are told apart by their normals. Pixels that meet
/// nothing, or a back, are left out. Cost: a ray a pixel.
void add_hemicube(const Hemicube& cube, const HemicubePlace& place, const VisibilityIndex& items,
                  std::span<const Vec3> normals, std::span<double> factors);

}  // namespace halfshade
