#include "solver/pipeline/middle.h"

#include <algorithm>

namespace halfshade {

std::vector<Vec3> middle_and_around(const Surface& surface, double towards) {
  constexpr std::size_t most_corners = 8;
  constexpr double aside = 0.0371;
  const Vec3 centre = middle(surface);
  std::vector<Vec3> points = {centre};
  const Ring& ring = surface.rings.front();
  const std::size_t count = std::min(ring.size(), most_corners);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t of_ring = k * ring.size() / count;
    const Vec3 corner = surface.frame.to_space(ring[of_ring]),
               next = surface.frame.to_space(ring[(of_ring + 1) % ring.size()]);
    points.push_back(centre + towards * (corner - centre) + aside * (next - corner));
  }
  return points;
}

}  // namespace halfshade
