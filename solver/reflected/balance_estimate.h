#pragma once

#include "solver/reflected/reflected_system.h"
#include "solver/reflected/reflection_estimate.h"

#include <vector>

namespace halfshade {

/// What is not known of the light that an element loses.
struct UnsureLoss {
  Rgb factor = Rgb::Zero();  ///< its form factors to all others may be off by this in the mean
  double parts = 0;          ///< into which its length had to be cut to know; 0: unknown
};

/// What light is off because it is not known exactly how much of it gets lost.
struct BalanceEstimate {
  double square = 0;  ///< ∫ |error|², weighted
  /// Element → its part in that, about; 0 if that is little.
  std::vector<double> of_element;
  double elements = 0;  ///< about as many had to be added to know
};

/// Where light is reflected some thousand times, in gaps or in the whole of an open system, nothing
/// else matters: what gets lost unseen would have been reflected as often. Solves for light that is
/// put in where it gets lost, unless that is sure to matter less than `negligible`, by what
/// `amplification` a residual may have; as light gets lost, less is there to get lost. Of the
/// constant that a closed system holds as much comes in as gets out. `unsure` is that of each
/// element, `weight` how much the square of its error counts.
BalanceEstimate estimate_balance(const ReflectedSystem& system, const ElementField& first_leaving,
                                 const SplitIrradiance& irradiance,
                                 const std::vector<UnsureLoss>& unsure,
                                 const std::vector<double>& weight, double amplification,
                                 double negligible);

/// Of noisy looks at the same elements: the first that is little would end them.
class MeanOfLooks {
 public:
  void add(double value) {
    sum_ += value;
    ++count_;
  }
  double mean() const { return count_ > 0 ? sum_ / count_ : 0; }

 private:
  double sum_ = 0;
  int count_ = 0;
};

/// ∫ |error|², weighted, that comes of what `estimate` finds missing in the mean over each surface,
/// as it is reflected on. What is missing where all that leaves gets lost, as above a lamp close
/// below a ceiling, does not count.
double square_reflected_on(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                           const ReflectionEstimate& estimate, const std::vector<double>& weight);

/// Adds what `rays`, as many from each node of each element, cannot tell of open systems: of N rays
/// that all arrive, up to three in N may get lost (the rule of three, at 95 %).
void add_unsure_by_rays(const ReflectedSystem& system, const std::vector<double>& rays,
                        std::vector<UnsureLoss>& unsure);

}  // namespace halfshade
