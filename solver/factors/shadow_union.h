#pragma once

#include "solver/factors/flat_sum.h"
#include "solver/factors/shadow_cut.h"

#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// A convex shadow, and a box that it lies in.
struct FlatShadow {
  std::span<const ShadowSide> sides;
  FlatBox box;
};

/// What several shadows hide together, by inclusion and exclusion: what each does, less what each
/// two do, and so on. All of that is convex, where what is left of a polygon when a shadow with
/// many sides is cut off has as many parts, from each of which the next one is to be cut.
class ShadowUnion {
 public:
  /// With more, there may be far more that several do than parts.
  static constexpr std::size_t most_shadows = 8;

  /// Adds edges whose sum is that of what of a convex polygon lies in any of some shadows.
  void add_edges(ShadowCut::Corners polygon, std::span<const FlatShadow> shadows, double nearness,
                 FlatEdges& edges);

 private:
  struct Polygon {
    std::vector<double> x, y;
  };

  void add(ShadowCut::Corners polygon, std::size_t depth, std::size_t first);

  ShadowCut cut_;
  std::vector<Polygon> common_;  // of as many shadows
  std::span<const FlatShadow> shadows_;
  double nearness_ = 0;
  FlatEdges* edges_ = nullptr;
};

}  // namespace halfshade
