#pragma once

#include "meshing/rays/occluders.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace halfshade {

/// A straight piece of light. Triangles in the planes of its end points (−1: none) do not block it:
/// a segment that leaves a plane cannot cross it again.
struct Segment {
  Vec3 from, to;
  int from_plane = -1;
  int to_plane = -1;
};

struct Hit {
  int owner = 0;
  int triangle = 0;
  double distance = 0;              ///< scene units
  std::array<double, 3> weights{};  ///< barycentric coordinates at the triangle's corners
};

/// All that lies ahead of a finite point; `direction` has unit length.
struct HalfLine {
  Vec3 origin, direction;
};

enum class Sides { both, front_only };

/// Answers visibility queries among fixed triangles. Embree finds the triangles near a ray in
/// single precision, on coordinates relative to the soup's centre and size, or those of small parts
/// of it that lie apart: a room and a far sun lose nothing to each other (scale_clusters()).
/// Whether a triangle is met is decided in double precision. What can go wrong is that one met
/// within about 1e-6 of the soup's size from its border, at a grazing angle, goes unseen: good for
/// sampling and for clear cases, not for near-tangent decisions. All queries may run concurrently.
class VisibilityIndex {
 public:
  explicit VisibilityIndex(TriangleSoup soup);
  ~VisibilityIndex();
  VisibilityIndex(VisibilityIndex&&) noexcept;
  VisibilityIndex& operator=(VisibilityIndex&&) noexcept;

  const TriangleSoup& soup() const;

  /// True if a triangle lies between the end points. Triangles that an end point lies on do not
  /// block; a segment without length, or with an end that is not finite, is not blocked.
  bool blocked(const Segment& segment) const;

  /// The same for a batch; `result[k]` is 1 or 0. Spans must be equally long. Batches of a few
  /// thousand and more are shared among threads; small ones run in packets on the calling thread.
  /// Segments that are close together in space should be close together in the batch.
  void blocked(std::span<const Segment> segments, std::span<std::uint8_t> result) const;

  /// The nearest triangle along a ray, other than those that the origin lies on; `direction` need
  /// not be of unit length. With Sides::front_only, triangles seen from behind let the ray pass.
  std::optional<Hit> first_hit(const Vec3& origin, const Vec3& direction,
                               Sides sides = Sides::both) const;

  /// The same for many rays; `hits[k].triangle` is −1 where nothing is met. Spans must be equally
  /// long. On the calling thread, in packets: rays that are close together should be close together
  /// in the batch.
  void first_hits(std::span<const HalfLine> rays, Sides sides, std::span<Hit> hits) const;

  /// The triangle that faces a ray in the place where it met another one from behind, if there is
  /// one: of two that lie back to back a ray may meet either first.
  std::optional<Hit> facing_hit(const HalfLine& ray, const Hit& behind) const;

  /// Owners of all triangles that can lie between a point of polygon `a` and a point of polygon
  /// `b`: those that reach into the interior of their convex hull (shaft; Haines and Wallace 1991).
  /// Sorted. Conservative except that triangles reaching in by less than 1e-12 of the hull's size
  /// may be missing: triangles that only touch the shaft, as coplanar ones do, are left out. A
  /// polygon may also be a single point. Double precision; cost grows with the logarithm of the
  /// scene.
  std::vector<int> candidates(std::span<const Vec3> a, std::span<const Vec3> b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace halfshade
