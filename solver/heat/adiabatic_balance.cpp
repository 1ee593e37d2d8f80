#include "solver/heat/adiabatic_balance.h"

#include <Eigen/LU>

namespace halfshade {
namespace {

/// From far above each step takes a quarter of the temperature away.
constexpr int most_steps = 500;
/// Of the hottest temperature.
constexpr double settled = 1e-14;
/// Below this share of the hottest, black bodies send nothing that doubles could tell from 0.
constexpr double coldest = 1e-12;

/// What is absorbed less what is sent out, and how that changes with the temperatures.
struct Imbalance {
  Eigen::VectorXd power;
  Eigen::MatrixXd slope;
};

Imbalance imbalance_at(const Eigen::ArrayXd& kelvin, const AdiabaticBalance& balance,
                       const std::vector<Band>& bands) {
  const Eigen::Index faces = kelvin.size(), count = balance.rest.size();
  Eigen::ArrayXXd sent(faces, count), slope(faces, count);
  for (Eigen::Index i = 0; i < faces; ++i) {
    sent.row(i) = blackbody_exitance(kelvin[i], bands).transpose();
    slope.row(i) = blackbody_slope(kelvin[i], bands).transpose();
  }
  Imbalance result{Eigen::VectorXd::Zero(faces), Eigen::MatrixXd::Zero(faces, faces)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::VectorXd e = balance.emissivity.col(k);
    const Eigen::MatrixXd weighted =
        e.asDiagonal() * balance.response[static_cast<std::size_t>(k)] * e.asDiagonal();
    const Eigen::VectorXd more = sent.col(k) - balance.rest[k];
    result.power += weighted * more;
    result.power += e.cwiseProduct((balance.arriving.col(k) - sent.col(k)).matrix());
    result.slope += weighted * slope.col(k).matrix().asDiagonal();
    result.slope.diagonal() -= e.cwiseProduct(slope.col(k).matrix());
  }
  return result;
}

}  // namespace

Eigen::ArrayXd balanced_temperatures(const AdiabaticBalance& balance,
                                     const std::vector<Band>& bands) {
  const Eigen::Index faces = balance.emissivity.rows();
  double most = 0;
  for (Eigen::Index i = 0; i < faces; ++i)
    most = std::max(most, balance.arriving.row(i).sum() + balance.rest.sum());
  if (!(most > 0)) return Eigen::ArrayXd::Zero(faces);
  Eigen::ArrayXd kelvin = Eigen::ArrayXd::Constant(faces, blackbody_temperature(most));
  for (int step = 0; step < most_steps; ++step) {
    Imbalance now = imbalance_at(kelvin, balance, bands);
    for (Eigen::Index i = 0; i < faces; ++i)
      if (!(now.slope(i, i) < 0)) {
        now.slope.row(i).setZero();
        now.slope(i, i) = -1;
        now.power[i] = 0;
      }
    const Eigen::ArrayXd change = -now.slope.partialPivLu().solve(now.power).array();
    const double hottest = kelvin.maxCoeff();
    // A step down may not go below nothing.
    kelvin = (kelvin + change).max(kelvin / 2).max(coldest * hottest);
    if (change.abs().maxCoeff() <= settled * kelvin.maxCoeff()) break;
  }
  const double nothing = 2 * coldest * kelvin.maxCoeff();
  kelvin = (kelvin <= nothing).select(0, kelvin);
  return (balance.emissivity.rowwise().maxCoeff() > 0).select(kelvin, NAN);
}

}  // namespace halfshade
