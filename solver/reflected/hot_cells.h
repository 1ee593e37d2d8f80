#pragma once

#include "solver/elements/solution.h"
#include "solver/reflected/hemisphere_rays.h"
#include "solver/reflected/leaving_cells.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace halfshade {

/// How exactly light is looked for where rays end.
enum class Looks {
  quick,  ///< in cells that are far away by their mean
  exact   ///< at each place
};

/// Irradiance from what leaves for the first time, by rays. Where much more of it leaves than
/// elsewhere, few rays of a hemisphere meet the place, and what they bring is most of the noise; so
/// some rays are sent there on purpose, more to where more would come from.
class HotCells {
 public:
  /// Light that leaves a point of a root.
  using Leaving = LeavingCells::Leaving;

  /// None are, and all looks are exact.
  HotCells() = default;

  HotCells(const ReflectingScene& scene, const HugeRoots& huge, LeavingCells cells);

  /// Rays to them that go with so many over the hemisphere; 0 if they do not pay.
  int count(int rays) const;

  /// Irradiance by each hemisphere from what leaves where its rays end, and from hot cells by
  /// count(strata²) more rays: each place counts by how many rays of both kinds were to be expected
  /// there (the balance heuristic; Veach and Guibas 1995). One row a hemisphere; all have the same
  /// strata.
  ChannelArray irradiance(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                          std::span<const RayHemisphere> hemispheres,
                          const TracedHemispheres& traced) const;

 private:
  struct Cell {
    int root, number;
    std::array<TrianglePlace, 3> corners;
  };
  /// Hot cells that are near each other: from elsewhere they look about alike.
  struct Group {
    int first, last;      ///< among hot ones
    Vec3 centre, normal;  ///< means
    double area;
    double power;  ///< share of that of all hot cells
  };
  /// How rays from about one place are shared among groups.
  struct Aim {
    std::vector<double> gain;   ///< of each: its share of the rays by its share of the power
    std::vector<double> up_to;  ///< shares of the rays, summed; empty: there are none
  };

  /// In proportion to what would come from each if nothing were in the way.
  Aim aim_from(std::span<const RayHemisphere> hemispheres) const;
  /// Aimed rays per area of a cell; 0 where it is not hot.
  double density(const Aim& aim, int cell) const {
    return aim.up_to.empty() || group_[at(cell)] < 0
               ? 0
               : aim.gain[at(group_[at(cell)])] * density_[at(cell)];
  }
  /// The hot cell that a number in [0, 1) stands for.
  const Cell& cell_at(const Aim& aim, double share) const;
  /// `power`: shares of the power of hot cells, which are sorted by this.
  void make_groups(const ReflectingScene& scene, const std::vector<double>& power);
  /// Rays to hot cells that were to be expected at a place, for each ray over the hemisphere that
  /// was, if they have this density there; d from the origin. Below 0: none of either.
  double expected(const ReflectingScene& scene, const RayOrigin& from, int root, const Vec3& d,
                  double density) const;
  /// What comes by the rays over the hemisphere.
  Rgb by_all_rays(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                  const RayHemisphere& hemisphere, const Aim& aim, std::span<const RayEnd> ends,
                  int rays) const;
  /// Adds what comes by aimed rays, those of all hemispheres together.
  void add_aimed_rays(const ReflectingScene& scene, const Leaving& leaving, Looks looks,
                      std::span<const RayHemisphere> hemispheres, const Aim& aim,
                      ChannelArray& irradiance) const;
  /// What leaves a place of a cell.
  Rgb look(const Leaving& leaving, Looks looks, int root, int cell, const Vec3& position,
           double square_distance) const;

  LeavingCells cells_;
  /// Of each cell: its group, −1 where it is not hot, and its share of the power of hot ones per
  /// area; empty: none is.
  std::vector<int> group_;
  std::vector<double> density_;
  std::vector<Cell> hot_;
  std::vector<double> up_to_;  ///< shares of the power of all hot cells, summed
  std::vector<Group> groups_;
};

}  // namespace halfshade
