#pragma once

#include "solver/linear/classic_solvers.h"

namespace halfshade {

/// Progressive refinement (Cohen, Chen, Wallace and Greenberg 1988): the element with most power
/// not yet sent sends it to all others. `problem` must outlive it.
class Shooting {
 public:
  explicit Shooting(const ReflectionProblem& problem);

  /// One shot: a row of the matrix.
  void shoot();

  Eigen::Index size() const { return unsent_.size(); }
  const Eigen::VectorXd& received() const { return received_; }
  const Eigen::VectorXd& unsent() const { return unsent_; }
  /// Power not yet sent, relative to that of the first reflection.
  double unsent_share() const;
  /// What is not yet sent, spread evenly over all elements and reflected without end; 0 where
  /// nothing is absorbed, for then it has no limit.
  double ambient_irradiance() const;
  /// The reflected radiosity of what has been received, and of `ambient` irradiance.
  Eigen::VectorXd reflected(double ambient) const;

 private:
  const ReflectionProblem& problem_;
  Eigen::VectorXd received_, unsent_;
};

}  // namespace halfshade
