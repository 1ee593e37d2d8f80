#pragma once

#include "solver/exchange/exchange.h"
#include "solver/linear/radiosity.h"

#include <cstdint>
#include <stop_token>
#include <vector>

namespace halfshade {

/// R = first + ρ F R, for the reflected radiosity R of one channel.
struct ReflectionProblem {
  const ExchangeMatrix& matrix;  ///< A F
  const Eigen::ArrayXd& area;
  const Eigen::VectorXd& rho;
  Eigen::VectorXd first;  ///< what is reflected for the first time, ≥ 0
};

struct SweepLimits {
  double tolerance = 1e-10;  ///< of the residual, as in `history`
  int sweeps = 100000;
  bool stages = false;   ///< keep those of shooting
  std::stop_token stop;  ///< looked at after each sweep
};

/// How far shooting had come.
struct ShotStage {
  std::int64_t shots = 0;
  Eigen::VectorXd received;  ///< irradiance by these shots, W/m²
  Eigen::VectorXd unsent;    ///< reflected radiosity that has not been sent yet
  double ambient = 0;        ///< irradiance that is shown in its place; 0 without that term
};

struct SweepResult {
  Eigen::VectorXd reflected;
  int sweeps = 0;
  /// After each sweep: Σ A |first + ρ F R − R|, relative to Σ A first.
  std::vector<double> history;
  double residual = 0;  ///< the same of `reflected`, also if there was no sweep
  /// Of shooting, if asked for: before the first shot, then at numbers of shots that grow by a half
  /// of an octave each until hardly anything is left to send, and at the end.
  std::vector<ShotStage> stages;
};

/// The iterations that radiosity began with, for those who want to compare: their number grows as 1
/// / (1 − ρ), that of conjugate gradients hardly.
/// * jacobi: R ← first + ρ F R ("gathering");
/// * gauss_seidel: the same with the newest values of each element;
/// * southwell: the element with most power not yet sent sends it to all others ("shooting";
/// Cohen, Chen, Wallace and Greenberg 1988); a sweep is as many shots as there are elements;
/// * southwell_ambient: the same, and what is not yet sent counts as spread evenly, as it is after
/// many reflections.
/// Cost of a sweep: two products with the matrix. On one thread but for products.
/// Throws Error(contract) for conjugate gradients.
SweepResult sweep(const ReflectionProblem& problem, RadiositySolver solver,
                  const SweepLimits& limits);

}  // namespace halfshade
