#pragma once

#include "meshing/rays/ray_space.h"
#include "meshing/rays/soup_triangle.h"
#include "meshing/rays/visibility.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

/// Triangles as Embree holds them, in coordinates of their own, with the tests that decide in
/// double precision whether a ray meets one. All queries may run concurrently.
class EmbreeScene {
 public:
  static constexpr std::size_t packet_size = 16;

  /// Of some triangles of a soup, at least one, by their indices. Throws Error(too_large) if memory
  /// runs out.
  EmbreeScene(const TriangleSoup& soup, std::span<const int> triangles);
  EmbreeScene(EmbreeScene&&) noexcept;
  ~EmbreeScene();

  /// What meets one of the triangles meets this.
  const Ball& ball() const { return ball_; }

  bool blocked(const Segment& segment) const;

  /// Of up to packet_size segments: `result[k]` becomes 1 where one is blocked.
  void blocked(std::span<const Segment> segments, std::span<std::uint8_t> result) const;

  /// The first triangle that a ray meets; none: nullptr.
  const SoupTriangle* first_hit(const HalfLine& ray, Sides sides) const;

  /// The same for up to packet_size rays.
  void first_hits(std::span<const HalfLine> rays, Sides sides,
                  std::span<const SoupTriangle*> triangles) const;

 private:
  struct Handles;

  std::vector<SoupTriangle> triangles_;
  RaySpace space_;
  Ball ball_;
  std::unique_ptr<Handles> handles_;
};

}  // namespace halfshade
