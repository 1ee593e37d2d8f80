#include "meshing/backprojection/border_lines.h"

#include "meshing/backprojection/margins.h"

#include <algorithm>

namespace halfshade {

std::vector<BorderLine> border_lines(const OpaqueTopology& topology, int surface) {
  const OpaqueTopology::OpaqueSurface& of = topology.surfaces[at(surface)];
  const auto ring = topology.ring(of.first_ring);
  const auto corner = [&](std::size_t k) -> const Vec3& {
    return topology.vertices[at(ring[k % ring.size()].vertex)];
  };
  std::vector<BorderLine> lines;
  const std::size_t step = (ring.size() + margins::most_sides - 1) / margins::most_sides;
  for (std::size_t k = 0; k < ring.size(); k += step) {
    BorderLine line;
    // Seen from the front the ring runs counter-clockwise, so outwards is to the right.
    const Vec3 across = (corner(k + 1) - corner(k)).cross(of.frame.normal);
    if (!(across.norm() > 0)) continue;
    line.out = across.normalized();
    line.offset = line.out.dot(corner(0) - of.frame.origin);
    for (std::size_t i = 1; i < ring.size(); ++i)
      line.offset = std::max(line.offset, line.out.dot(corner(i) - of.frame.origin));
    // An edge that others end on is several.
    if (lines.empty() || lines.back().out.dot(line.out) < margins::same_direction)
      lines.push_back(line);
  }
  return lines;
}

}  // namespace halfshade
