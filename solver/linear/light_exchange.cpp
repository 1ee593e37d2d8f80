#include "solver/linear/light_exchange.h"

#include "solver/exchange/scaled_operator.h"

namespace halfshade {

Eigen::VectorXd LightExchange::apply_all(const Eigen::VectorXd& in) const {
  Eigen::VectorXd out(in.size());
  apply(in, Eigen::VectorXd::Ones(in.size()), out);
  return out;
}

LightExchange light_exchange(const Exchange& exchange) {
  const auto apply = [&exchange](const Eigen::VectorXd& in, const Eigen::VectorXd& wanted,
                                 Eigen::VectorXd& out) {
    multiply(exchange.matrix, in, wanted, out);
  };
  return {apply, exchange.area, exchange.lost, exchange.enclosures, &exchange.matrix};
}

}  // namespace halfshade
