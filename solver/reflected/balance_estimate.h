#pragma once

#include "solver/reflected/reflected_system.h"
#include "solver/reflected/reflection_estimate.h"
#include "solver/reflected/unsure_loss.h"

#include <vector>

namespace halfshade {

/// What light is off because it is not known exactly how much of it gets lost.
struct BalanceEstimate {
  double square = 0;   ///< ∫ |error|², weighted
  double in_gaps = 0;  ///< of that, what closed systems may lose in theirs
  /// Element → its part in that, about; 0 if that is little.
  std::vector<double> of_element;
  double elements = 0;  ///< about as many had to be added to know
};

/// Where light is reflected some thousand times, in gaps or in the whole of an open system, nothing
/// else matters: what gets lost unseen would have been reflected as often. Solves for light that is
/// put in where it gets lost, unless that is sure to matter less than `negligible`, by what
/// `amplification` a residual may have; as light gets lost, less is there to get lost. Of the
/// constant that a closed system holds as much comes in as gets out, but what its gaps may lose.
/// Infinite where a loss is no number. `unsure` is that of each element, `weight` how much the
/// square of its error counts.
BalanceEstimate estimate_balance(const ReflectedSystem& system, const ElementField& first_leaving,
                                 const SplitIrradiance& irradiance,
                                 const std::vector<UnsureLoss>& unsure,
                                 const std::vector<double>& weight, double amplification,
                                 double negligible);

/// The same, with what errors within elements grow to: their means do not tell.
ReflectionEstimate reflected_within(ReflectionEstimate estimate,
                                    const std::vector<UnsureLoss>& unsure);

}  // namespace halfshade
