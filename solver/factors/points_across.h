#pragma once

#include "solver/factors/sight_scene.h"
#include "solver/factors/square_lattice.h"

#include <span>

namespace halfshade {

/// How many points of a lattice over each of some quadrilaterals of a surface it takes for none of
/// the things that it looks past, nor what it looks at, to lie between them: as many as things
/// cover the quadrilateral, or, where it is narrower than they are, as lie along it. What is long
/// and narrow passes between points only across. What lies closer to the surface than it is wide
/// hides much from under itself and little elsewhere: some points are under it.
class PointsAcross {
 public:
  /// `surface` and `quads` must outlive it; `target` lies round what is looked at.
  PointsAcross(const PlaneFrame& surface, std::span<const Quad> quads, const Ball& target);

  void add(const ConvexBody& body);
  void add(const Blocker& polygon);

  double points() const { return points_; }

 private:
  template <class Measure>
  double most_of_quads(Measure measure) const;
  double points_under(std::span<const Vec3> corners, double width) const;

  const PlaneFrame& surface_;
  std::span<const Quad> quads_;
  double points_;
};

}  // namespace halfshade
