#pragma once

#include "solver/reflected/reflected_system.h"

#include <vector>

namespace halfshade {

/// What is not known of the light that an element loses.
struct UnsureLoss {
  double factor = 0;  ///< its form factors to all others may be off by this in the mean
  double parts = 0;   ///< into which its length had to be cut to know; 0: unknown
};

/// What the whole of a system is off because it is not known exactly how much light it loses.
struct BalanceEstimate {
  double square = 0;  ///< ∫ |error|², weighted
  /// Element → its part in what is not known, relative; 0 if that is little.
  std::vector<double> of_element;
  double elements = 0;  ///< about as many had to be added to know
};

/// In open systems where light is reflected some thousand times nothing else matters: the light of
/// the whole system is off by the power that is not known, relative to the power put in. `unsure`
/// is that of each element, `weight` how much the square of its error counts.
BalanceEstimate estimate_balance(const ReflectedSystem& system, const ElementField& first_leaving,
                                 const ElementField& irradiance,
                                 const std::vector<UnsureLoss>& unsure,
                                 const std::vector<double>& weight);

/// What `rays`, as many from each node of each element, cannot tell of open systems: of N rays that
/// all arrive, up to three in N may get lost (the rule of three, at 95 %).
std::vector<UnsureLoss> unsure_by_rays(const ReflectedSystem& system,
                                       const std::vector<double>& rays);

}  // namespace halfshade
