#include "solver/linear/classic_solvers.h"

#include "meshing/core/error.h"
#include "solver/exchange/scaled_operator.h"

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
  Southwell(const ReflectionProblem& problem, bool ambient)
      : problem_(problem), ambient_(ambient), R_(problem.first), unsent_(problem.first) {}

  const Eigen::VectorXd& operator()() {
    for (Eigen::Index shot = 0; shot < R_.size(); ++shot) shoot();
    shown_ = R_;
    if (ambient_) shown_ += problem_.rho * ambient_irradiance();
    return shown_;
  }

 private:
  /// By power, not by radiosity: or else small bright elements keep large ones waiting.
  void shoot() {
    Eigen::Index brightest = 0;
    (problem_.area * unsent_.array()).maxCoeff(&brightest);
    const double sent = unsent_[brightest];
    unsent_[brightest] = 0;
    for (ExchangeMatrix::InnerIterator entry(problem_.matrix, brightest); entry; ++entry) {
      const Eigen::Index j = entry.col();
      const double reflected = problem_.rho[j] * (entry.value() * sent / problem_.area[j]);
      R_[j] += reflected;
      unsent_[j] += reflected;
    }
  }

  double ambient_irradiance() const {
    const double all = problem_.area.sum();
    const double kept = 1 - (problem_.area * problem_.rho.array()).sum() / all;
    return kept > 0 ? power(problem_, unsent_) / all / kept : 0;
  }

  const ReflectionProblem& problem_;
  bool ambient_;
  Eigen::VectorXd R_, unsent_, shown_;
};

template <class Sweep>
SweepResult run(const ReflectionProblem& problem, const SweepLimits& limits, Sweep once) {
  SweepResult result;
  result.reflected = problem.first;
  const double first = power(problem, problem.first);
  if (!(first > 0)) return result;
  while (result.sweeps < limits.sweeps) {
    result.reflected = once();
    ++result.sweeps;
    const Eigen::VectorXd off = gathered(problem, result.reflected) - result.reflected;
    result.history.push_back(power(problem, off) / first);
    if (result.history.back() <= limits.tolerance) break;
  }
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
    case RadiositySolver::southwell_ambient:
      return run(problem, limits, Southwell(problem, solver == RadiositySolver::southwell_ambient));
    default:
      throw Error(ErrorCode::contract, "sweep", "conjugate gradients do not sweep");
  }
}

}  // namespace halfshade
