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

/// What all light is off by what is missing, as it is reflected on: ∫ |error|², weighted.
struct ReflectedOn {
  double square = 0;    ///< without bias by the noise of the points; may be negative
  double variance = 0;  ///< that noise, reflected on as well

  /// With two standard deviations.
  double at_most() const;
  /// Whether more points would say more than that.
  bool is_unsure() const { return 4 * variance > square; }
};

/// Whether all points go together, or a part of them at a time, which tells their noise.
enum class PointParts { one, all };

/// What comes of what `estimate` finds missing in the mean over each element. Where light is
/// reflected a hundred times, not only its amount is slow to settle: in a narrow gap it spreads as
/// heat does in a plate, and whatever is missing over some gaps' width moves it there by nearly as
/// much. What is missing where all that leaves gets lost, as above a lamp close below a ceiling,
/// does not count. With PointParts::one, all points go together, which takes a sixth as long: noise
/// counts as what is reflected, and its variance stays 0.
ReflectedOn reflected_on(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                         const ReflectionEstimate& estimate, const std::vector<UnsureLoss>& unsure,
                         const std::vector<double>& weight, PointParts which);

}  // namespace halfshade
