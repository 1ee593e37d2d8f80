#pragma once

#include "solver/exchange/form_factor.h"
#include "solver/factors/point_looks.h"
#include "solver/factors/sight_scene.h"

#include <algorithm>
#include <cstddef>
#include <stop_token>

namespace halfshade {

/// How exact a mutual area is to be.
struct SightTolerance {
  double relative = 1e-9;    ///< of it, in (0, 1)
  double absolute = 0;       ///< what is good enough in any case, squared scene units, ≥ 0
  int max_points = 1000000;  ///< at which a pair is looked at, ≥ 1
  bool is_trial = false;     ///< what few points tell is enough, of what something may hide

  /// What a mutual area may be off by.
  double allowed(double value) const { return std::max(absolute, relative * value); }
};

/// Mutual area of what two surfaces see of each other.
struct MutualSight {
  double value = 0;          ///< A_a F(a,b) = A_b F(b,a), squared scene units
  double error = 0;          ///< bound of its absolute error
  std::size_t points = 0;    ///< at which visible parts were found
  bool is_reached = true;    ///< the error is as small as asked for
  bool is_at_limit = false;  ///< it is not, for it would take more than SightTolerance::max_points
};

/// Of two surfaces as if nothing were between them: mutual_area, by convex pieces. If stopped, the
/// error is what it is by then.
MutualSight clear_sight(const SightScene& scene, int a, int b, const SightTolerance& tolerance,
                        const std::stop_token& stop = {});

/// Of a part of surface `a` alone.
MutualSight clear_sight(const SightScene& scene, const Triangle3& part, int b,
                        const SightTolerance& tolerance, const std::stop_token& stop = {});

/// Of what lies of two surfaces in cells of space that both look into.
MutualSight clear_sight_in_cells(const SightScene& scene, int a, int b,
                                 const SightTolerance& tolerance, const std::stop_token& stop = {});

/// Of two surfaces that something may come between: what they would see without it less what it
/// hides, by cubature of exact point factors over `a`; see factors.md. If stopped, the error is
/// what it is by then, and is_reached false.
MutualSight partial_sight(const SightScene& scene, int a, int b, const SightTolerance& tolerance,
                          const std::stop_token& stop = {});

/// The same with what was seen for other pairs, which saves time and changes nothing.
MutualSight partial_sight(const SightScene& scene, PointLooks& looks, int a, int b,
                          const SightTolerance& tolerance, const std::stop_token& stop = {});

}  // namespace halfshade
