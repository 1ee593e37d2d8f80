#include "solver/heat/adiabatic_balance.h"

#include "solver/heat/emission.h"

#include <Eigen/LU>

namespace halfshade {
namespace {

/// Of thousands of random systems none took more than eleven.
constexpr int most_steps = 120;
/// Should steps swing back and forth, they are halved after as many.
constexpr int whole_steps = 40;
/// Of a face's power: out of balance by no more, it is balanced.
constexpr double settled = 1e-15;
/// The same, where rounding keeps it from getting better.
constexpr double good_enough = 1e-9;
/// Of what they were: more is not taken from powers at once.
constexpr double least_kept = 0.01;

/// What faces send out, and what they absorb then.
struct State {
  Eigen::ArrayXd power;  ///< y
  Eigen::ArrayXd kelvin;
  Eigen::ArrayXXd sent, growth;  ///< of each face (row) in each band, see Emission
  Eigen::ArrayXd absorbed;
};

class Balancing {
 public:
  Balancing(const AdiabaticBalance& balance, const std::vector<Band>& bands)
      : balance_(balance), bands_(bands) {}

  State first() const {
    const Eigen::ArrayXd power = (balance_.emissivity * balance_.arriving).rowwise().sum();
    return at(power, Eigen::ArrayXd::Zero(power.size()));
  }

  /// `kelvin` is near what is found, or 0.
  State at(const Eigen::ArrayXd& power, const Eigen::ArrayXd& kelvin) const {
    State state{power, kelvin, {}, {}, {}};
    state.sent = state.growth = Eigen::ArrayXXd::Zero(power.size(), balance_.rest.size());
    for (Eigen::Index i = 0; i < power.size(); ++i) {
      const Eigen::ArrayXd emissivity = balance_.emissivity.row(i);
      state.kelvin[i] = emission_temperature(power[i], emissivity, bands_, kelvin[i]);
      if (!(state.kelvin[i] > 0)) continue;
      const Emission emission = emission_at(state.kelvin[i], emissivity, bands_);
      state.sent.row(i) = emission.power.transpose();
      state.growth.row(i) = emission.growth.transpose();
    }
    state.absorbed = absorbed(state.sent);
    return state;
  }

  /// Newton's step for all powers.
  Eigen::ArrayXd step_from(const State& state) const {
    const Eigen::Index faces = state.power.size();
    const Eigen::ArrayXd growth = state.growth.rowwise().sum();
    Eigen::MatrixXd slope = -Eigen::MatrixXd::Identity(faces, faces);
    for (Eigen::Index k = 0; k < balance_.rest.size(); ++k) {
      const Eigen::VectorXd share = (growth > 0).select(state.growth.col(k) / growth, 0);
      slope += balance_.emissivity.col(k).matrix().asDiagonal() * response(k) * share.asDiagonal();
    }
    return slope.partialPivLu().solve((state.power - state.absorbed).matrix()).array();
  }

 private:
  const Eigen::MatrixXd& response(Eigen::Index band) const {
    return balance_.response[static_cast<std::size_t>(band)];
  }

  Eigen::ArrayXd absorbed(const Eigen::ArrayXXd& sent) const {
    Eigen::ArrayXd sum = Eigen::ArrayXd::Zero(sent.rows());
    for (Eigen::Index k = 0; k < balance_.rest.size(); ++k) {
      const Eigen::ArrayXd e = balance_.emissivity.col(k);
      const Eigen::VectorXd more = sent.col(k) - e * balance_.rest[k];
      const Eigen::ArrayXd irradiance = balance_.arriving.col(k) + (response(k) * more).array();
      sum += e * irradiance.max(0);
    }
    return sum;
  }

  const AdiabaticBalance& balance_;
  const std::vector<Band>& bands_;
};

/// The worst face's, relative to its power.
double imbalance(const State& state) {
  const Eigen::ArrayXd scale = state.power.max(state.absorbed);
  return (scale > 0).select((state.absorbed - state.power).abs() / scale, 0).maxCoeff();
}

}  // namespace

Eigen::ArrayXd balanced_temperatures(const AdiabaticBalance& balance,
                                     const std::vector<Band>& bands) {
  const Balancing balancing(balance, bands);
  State now = balancing.first(), best = now;
  double least = HUGE_VAL;
  for (int step = 0; step < most_steps && least > settled; ++step) {
    const double off = imbalance(now);
    if (!(off < least) && least <= good_enough) break;
    if (off < least) best = now;
    least = std::min(least, off);
    const Eigen::ArrayXd change = std::exp2(-step / whole_steps) * balancing.step_from(now);
    now = balancing.at((now.power + change).max(least_kept * now.power), now.kelvin);
  }
  if (!(least <= good_enough)) best.kelvin.setConstant(NAN);
  return (balance.emissivity.rowwise().maxCoeff() > 0).select(best.kelvin, NAN);
}

}  // namespace halfshade
