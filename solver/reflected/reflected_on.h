#pragma once

#include "solver/reflected/reflected_system.h"
#include "solver/reflected/reflection_estimate.h"
#include "solver/reflected/unsure_loss.h"

#include <Eigen/Core>

#include <vector>

namespace halfshade {

/// What all light is off by what is missing, as it is reflected on: ∫ |error|², weighted.
struct ReflectedOn {
  double square = 0;     ///< without bias by the noise of the points; may be negative
  double deviation = 0;  ///< standard deviation of that

  /// With two standard deviations.
  double at_most() const;
};

/// The square of the mean of parts that are independent and alike, from their inner products
/// (parts × parts, symmetric, three parts at least): the mean of the products of different ones.
/// Its deviation is what leaving out one part after the other tells (Tukey 1958). Noise in many
/// places cancels in both; noise of one form does not.
ReflectedOn square_of_mean(const Eigen::MatrixXd& products);

/// Whether all points go together, or a part of them at a time, which tells their noise.
enum class PointParts { one, all };

/// What comes of what `estimate` finds missing in the mean over each element. Where light is
/// reflected a hundred times, not only its amount is slow to settle: in a narrow gap it spreads as
/// heat does in a plate, and whatever is missing over some gaps' width moves it there by nearly as
/// much. What is missing where all that leaves gets lost, as above a lamp close below a ceiling,
/// does not count. With PointParts::one, all points go together, which takes a sixth as long: noise
/// counts as what is reflected, and the deviation stays 0.
ReflectedOn reflected_on(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                         const ReflectionEstimate& estimate, const std::vector<UnsureLoss>& unsure,
                         const std::vector<double>& weight, PointParts which);

}  // namespace halfshade
