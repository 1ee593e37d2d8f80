#pragma once

#include "meshing/rays/ray_space.h"
#include "meshing/rays/soup_triangle.h"
#include "meshing/rays/visibility.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

/// Triangles as Embree holds them, with the tests that decide in double precision whether a ray
/// meets one. The soup and its space must outlive it. All queries may run concurrently.
class EmbreeScene {
 public:
  static constexpr std::size_t packet_size = 16;

  /// Throws Error(too_large) if memory runs out. Precondition: there are triangles.
  EmbreeScene(const TriangleSoup& soup, const RaySpace& space);
  ~EmbreeScene();

  const SoupTriangle& triangle(int index) const { return triangles_[at(index)]; }

  bool blocked(const Segment& segment) const;

  /// Of up to packet_size segments: `result[k]` is 1 or 0.
  void blocked(std::span<const Segment> segments, std::span<std::uint8_t> result) const;

  /// The first triangle that a ray meets, −1 if none.
  int first_hit(const HalfLine& ray, Sides sides) const;

  /// The same for up to packet_size rays.
  void first_hits(std::span<const HalfLine> rays, Sides sides, std::span<int> triangles) const;

 private:
  struct Handles;

  const TriangleSoup& soup_;
  std::vector<SoupTriangle> triangles_;  ///< of it: filters ask for them most often
  const RaySpace& space_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace halfshade
