#pragma once

#include "solver/reflected/reflected_system.h"
#include "solver/reflected/unsure_loss.h"

#include <vector>

namespace halfshade {

/// What leaves surfaces of an open system arrives so far as it is seen: ∫ G = ∫ ω (S + ρ G), ω the
/// share of the hemisphere of a place that holds surfaces, as IrradianceOperator::seen has it.
/// Where nearly all comes back the amount of light follows from what gets lost, of which the rows
/// of K, whose nodes miss what slits let out or what their edges shade, tell little. So G of such a
/// system is scaled until that holds. Nothing is done where ω is not known, as between plates close
/// to each other, by `unsure`. Only for solutions of all bounces.
void balance_loss(const ReflectedSystem& system, const ElementField& first_leaving,
                  const std::vector<UnsureLoss>& unsure, ElementField& irradiance);

/// What is missing of that irradiance where `source` of it is not there, by the same balance.
/// `missing` is what the rows of K make of that.
void balance_missing(const ReflectedSystem& system, const ElementField& irradiance,
                     const std::vector<UnsureLoss>& unsure, const ElementField& source,
                     ElementField& missing);

/// What of a change of that irradiance is left when it is scaled so again.
void balance_change(const ReflectedSystem& system, const ElementField& irradiance,
                    const std::vector<UnsureLoss>& unsure, ElementField& change);

}  // namespace halfshade
