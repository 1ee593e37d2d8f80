#include "solver/linear/shooting.h"

namespace halfshade {

Shooting::Shooting(const ReflectionProblem& problem)
    : problem_(problem),
      received_(Eigen::VectorXd::Zero(problem.first.size())),
      unsent_(problem.first) {}

// By power, not by radiosity: or else small bright elements keep large ones waiting.
void Shooting::shoot() {
  Eigen::Index brightest = 0;
  (problem_.area * unsent_.array()).maxCoeff(&brightest);
  const double sent = unsent_[brightest];
  unsent_[brightest] = 0;
  for (ExchangeMatrix::InnerIterator entry(problem_.matrix, brightest); entry; ++entry) {
    const Eigen::Index j = entry.col();
    const double arriving = entry.value() * sent / problem_.area[j];
    received_[j] += arriving;
    unsent_[j] += problem_.rho[j] * arriving;
  }
}

double Shooting::unsent_share() const {
  return (problem_.area * unsent_.array()).sum() / (problem_.area * problem_.first.array()).sum();
}

double Shooting::ambient_irradiance() const {
  const double all = problem_.area.sum();
  const double kept = 1 - (problem_.area * problem_.rho.array()).sum() / all;
  return kept > 0 ? (problem_.area * unsent_.array()).sum() / all / kept : 0;
}

Eigen::VectorXd Shooting::reflected(double ambient) const {
  return problem_.first + (problem_.rho.array() * (received_.array() + ambient)).matrix();
}

}  // namespace halfshade
