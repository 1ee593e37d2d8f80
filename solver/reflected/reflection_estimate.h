#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/probe_places.h"
#include "solver/reflected/reflected_system.h"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace halfshade {

/// Parts of the points that tell how sure their means are.
inline constexpr std::size_t parts_of_probes = 6;

/// What reflected light is off, by rays at random points.
struct ReflectionEstimate {
  /// Element → ∫ over it of |error|², without bias: of one element it is mostly noise, and may be
  /// negative.
  std::vector<double> square_error;  ///< weighted, as the next two
  double sum = 0;                    ///< of it
  double deviation = 0;              ///< standard deviation of the sum
  double square_total = 0;           ///< ∫ |H_d + G|²
  /// Element → how likely a point was to fall on it, where one did: only this share of the error
  /// found there is its own, the rest stands for elements like it that none fell on.
  std::vector<double> chance;
  /// Element → ∫ over it of what arrives and is not in the solution, times the share of what leaves
  /// there that arrives somewhere, as each part of the points has it; of this share alone; and the
  /// area that the points stand for.
  std::vector<std::array<Rgb, parts_of_probes>> missing;
  std::vector<double> reach, probed;
  std::size_t rays = 0;
  bool complete = true;

  /// What was found at places, and what is known of ∫ |H_d + G|² beside it.
  void add(const ReflectedMesh& mesh, std::span<const ProbePlace> probes, double known_square);

  /// The mean of this and another of the same light at other points, weighted.
  void join(const ReflectionEstimate& other, double weight_of_other);
};

struct ReflectionProbes {
  const ElementField& leaving;        ///< what it came from without S, less the constants' part
  const std::vector<double>& weight;  ///< of |error|² in each element
  const std::vector<double>& shares;  ///< of the points that each is given
  const std::vector<int>& strata;     ///< of either half of the rays from a point of each element
  int points = 1000;                  ///< over all surfaces
  int use = 0;                        ///< see ray_seed
};

/// About ∫ |H_d + G|², from means over elements; without `direct` of G alone.
double rough_square(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                    const DirectProjection* direct);

/// Strata of either half of the rays from points of each element: more where there is more `noise`,
/// which `known` rays from each node would leave. That of the estimate is then the least, and
/// `allowed` of it in all is kept to in the mean.
std::vector<int> share_probe_rays(const ReflectedMesh& mesh, const std::vector<double>& noise,
                                  const std::vector<double>& shares, double known, double allowed);

/// Compares irradiance with what arrives of leaving light. Two halves of the
/// rays from a point differ from it by the same error and by noise that is independent: the product
/// of the differences has no bias. Blind to an error of direct light.
ReflectionEstimate estimate_error(const ReflectingScene& scene, const ReflectedSystem& system,
                                  const SplitIrradiance& irradiance, const ReflectionProbes& probes,
                                  const Progress& progress);

}  // namespace halfshade
