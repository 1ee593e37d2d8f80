#pragma once

#include "meshing/core/sound_scene.h"
#include "meshing/patches/element_table.h"
#include "meshing/triangulation/planar_mesh.h"

#include <utility>
#include <vector>

/// What must hold of every mesh, checked without using anything that made it: areas, lengths and
/// edges are counted here once more.
namespace halfshade::test {

inline double signed_area(const Ring& ring) {
  double twice = 0;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k] - ring[0], b = ring[(k + 1) % ring.size()] - ring[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

inline double area_of(const std::vector<Ring>& rings) {
  double sum = 0;
  for (const Ring& ring : rings) sum += signed_area(ring);
  return sum;
}

inline double perimeter_of(const std::vector<Ring>& rings) {
  double sum = 0;
  for (const Ring& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k)
      sum += (ring[(k + 1) % ring.size()] - ring[k]).norm();
  return sum;
}

inline double length_of(const std::vector<Segment2>& segments) {
  double sum = 0;
  for (const auto& [a, b] : segments) sum += (b - a).norm();
  return sum;
}

/// The smallest angle and the longest edge of a planar mesh.
std::pair<double, double> angle_and_length(const PlanarMesh& mesh);

/// Orientation, area, conformity, Euler characteristic, border and constrained edges. Holes must
/// not touch each other or the outer boundary.
void expect_sound(const PlanarMesh& mesh, const std::vector<Ring>& rings,
                  const std::vector<Segment2>& contacts = {});

/// Area by surface, orientation, conformity within surfaces, and that exactly the edges on rings
/// and contact lines have no neighbour, from each side.
void expect_sound(const ElementTable& table, const SoundScene& scene);

/// Where edges on rings and contact lines of different surfaces lie on each other, they are the
/// same, bit for bit. They do if they are less than `near` apart (the tolerance's length if it is
/// 0). Returns how many pairs of such edges there are.
int expect_alike_across_surfaces(const ElementTable& table, const SoundScene& scene,
                                 double near = 0);

}  // namespace halfshade::test
