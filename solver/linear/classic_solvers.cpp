#include "solver/linear/classic_solvers.h"

#include "meshing/core/error.h"
#include "solver/exchange/scaled_operator.h"
#include "solver/linear/shooting.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace halfshade {
namespace {

/// first + ρ F R.
Eigen::VectorXd gathered(const ReflectionProblem& problem, const Eigen::VectorXd& R) {
  const Eigen::ArrayXd arriving = multiply(problem.matrix, R).array() / problem.area;
  return problem.first + problem.rho.cwiseProduct(arriving.matrix());
}

double power(const ReflectionProblem& problem, const Eigen::VectorXd& radiosity) {
  return (problem.area * radiosity.array().abs()).sum();
}

/// Each does one sweep and returns what it takes for the solution.
class Jacobi {
 public:
  explicit Jacobi(const ReflectionProblem& problem) : problem_(problem), R_(problem.first) {}
  const Eigen::VectorXd& operator()() {
    R_ = gathered(problem_, R_);
    return R_;
  }

 private:
  const ReflectionProblem& problem_;
  Eigen::VectorXd R_;
};

class GaussSeidel {
 public:
  explicit GaussSeidel(const ReflectionProblem& problem) : problem_(problem), R_(problem.first) {}
  const Eigen::VectorXd& operator()() {
    for (Eigen::Index i = 0; i < R_.size(); ++i) {
      double arriving = 0, own = 0;
      for (ExchangeMatrix::InnerIterator entry(problem_.matrix, i); entry; ++entry)
        (entry.col() == i ? own : arriving) +=
            entry.value() * (entry.col() == i ? 1 : R_[entry.col()]);
      const double share = problem_.rho[i] / problem_.area[i];
      R_[i] = (problem_.first[i] + share * arriving) / (1 - share * own);
    }
    return R_;
  }

 private:
  const ReflectionProblem& problem_;
  Eigen::VectorXd R_;
};

class Southwell {
 public:
  Southwell(const ReflectionProblem& problem, bool ambient, bool keeps_stages)
      : shooting_(problem), ambient_(ambient), keeps_stages_(keeps_stages) {
    keep_stage();
  }

  const Eigen::VectorXd& operator()() {
    for (Eigen::Index shot = 0; shot < shooting_.size(); ++shot) {
      shooting_.shoot();
      if (++shots_ == next_stage_ && shooting_.unsent_share() > nothing_left) keep_stage();
    }
    shown_ = shooting_.reflected(ambient());
    return shown_;
  }

  std::vector<ShotStage> all_stages() {
    if (keeps_stages_ && stages_.back().shots < shots_) keep_stage();
    return std::move(stages_);
  }

 private:
  /// Share of the light beyond which stages look alike.
  static constexpr double nothing_left = 1e-4;
  static constexpr double stage_step = std::numbers::sqrt2;

  double ambient() const { return ambient_ ? shooting_.ambient_irradiance() : 0; }

  void keep_stage() {
    if (!keeps_stages_) return;
    stages_.push_back({shots_, shooting_.received(), shooting_.unsent(), ambient()});
    next_stage_ = std::max(
        shots_ + 1, static_cast<std::int64_t>(std::ceil(static_cast<double>(shots_) * stage_step)));
  }

  Shooting shooting_;
  bool ambient_, keeps_stages_;
  std::int64_t shots_ = 0, next_stage_ = 0;
  std::vector<ShotStage> stages_;
  Eigen::VectorXd shown_;
};

template <class Sweep>
SweepResult run(const ReflectionProblem& problem, const SweepLimits& limits, Sweep&& once) {
  SweepResult result;
  result.reflected = problem.first;
  const double first = power(problem, problem.first);
  if (!(first > 0)) return result;
  const auto find_residual = [&] {
    const Eigen::VectorXd off = gathered(problem, result.reflected) - result.reflected;
    result.residual = power(problem, off) / first;
  };
  while (result.sweeps < limits.sweeps && !limits.stop.stop_requested()) {
    result.reflected = once();
    ++result.sweeps;
    find_residual();
    result.history.push_back(result.residual);
    if (result.residual <= limits.tolerance) break;
  }
  if (result.sweeps == 0) find_residual();
  return result;
}

}  // namespace

SweepResult sweep(const ReflectionProblem& problem, RadiositySolver solver,
                  const SweepLimits& limits) {
  switch (solver) {
    case RadiositySolver::jacobi:
      return run(problem, limits, Jacobi(problem));
    case RadiositySolver::gauss_seidel:
      return run(problem, limits, GaussSeidel(problem));
    case RadiositySolver::southwell:
    case RadiositySolver::southwell_ambient: {
      Southwell southwell(problem, solver == RadiositySolver::southwell_ambient, limits.stages);
      SweepResult result = run(problem, limits, southwell);
      result.stages = southwell.all_stages();
      return result;
    }
    default:
      throw Error(ErrorCode::contract, "sweep", "conjugate gradients do not sweep");
  }
}

}  // namespace halfshade
