#pragma once

#include "solver/reflected/huge_roots.h"
#include "solver/reflected/reflecting_scene.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace halfshade {

/// Where much more light leaves than elsewhere. Few rays of a hemisphere meet such places, and what
/// they bring is most of the noise; so some rays are sent there on purpose.
class HotCells {
 public:
  /// Light that leaves a point of a root.
  using Leaving = std::function<Rgb(int root, const Vec3& position)>;

  /// None are.
  HotCells() = default;

  /// Looks at about 20,000 cells of roots, each at a few random points.
  HotCells(const ReflectingScene& scene, const HugeRoots& huge, const Leaving& leaving);

  /// Rays to them that go with so many over the hemisphere; 0 if they do not pay.
  int count(int rays) const;

  /// Irradiance from what leaves `ends`, of which `rays` are the whole hemisphere, and from hot
  /// cells by count(strata²) more rays: each place counts by how many rays of both kinds were to be
  /// expected there (the balance heuristic; Veach and Guibas 1995).
  Rgb irradiance(const ReflectingScene& scene, const Leaving& leaving, const RayOrigin& from,
                 int strata, int rays, std::span<const RayEnd> ends, std::uint64_t seed) const;

 private:
  struct Cell {
    int root;
    std::array<TrianglePlace, 3> corners;
    double density;  ///< of rays per area
  };

  /// Rays to hot cells that were to be expected at a place, for each ray over the hemisphere that
  /// was.
  double expected(const ReflectingScene& scene, const RayOrigin& from, int root,
                  const Vec3& position, double density) const;
  /// Per area; 0 where it is not hot.
  double density(int root, const TrianglePlace& place) const;
  Rgb by_aimed_rays(const ReflectingScene& scene, const Leaving& leaving, const RayOrigin& from,
                    int rays, int aimed, std::uint64_t seed) const;

  std::vector<int> columns_, first_;  ///< of each root: cells along an edge, and the first one
  std::vector<double> density_;       ///< of each cell of each root
  std::vector<Cell> hot_;
  std::vector<double> up_to_;  ///< shares of the power of all hot cells, summed
};

}  // namespace halfshade
