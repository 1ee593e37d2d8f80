#include "solver/linear/combine_stages.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

double imbalance(double emitted, const StagePower& power) {
  const double rest = emitted - power.unshot - power.absorbed - power.escaped;
  return emitted > 0 ? std::abs(rest) / emitted : 0;
}

StagePower power_at(const ShotStage& stage, const LightExchange& exchange, const Solution& solution,
                    Eigen::Index channel) {
  const Eigen::ArrayXd& area = exchange.area;
  const auto rho = solution.rho.col(channel);
  const Eigen::ArrayXd direct = solution.direct_irradiance.col(channel);
  const Eigen::ArrayXd arrived = direct + stage.received.array();
  const Eigen::ArrayXd sent = rho * arrived - stage.unsent.array();
  const double emitted = (area * solution.exitance.col(channel)).sum();
  StagePower power;
  power.shot = emitted + (area * sent).sum();
  power.unshot = (area * stage.unsent.array()).sum();
  power.absorbed = (area * (1 - rho) * arrived).sum();
  power.escaped = emitted - (area * direct).sum() + (exchange.lost * sent).sum();
  power.ambient = stage.ambient;
  power.balance = imbalance(emitted, power);
  return power;
}

RadiosityStage nothing_sent(const LightExchange& exchange, const Solution& solution) {
  RadiosityStage stage;
  stage.irradiance = ChannelArray::Zero(solution.rho.rows(), 3);
  for (Eigen::Index c = 0; c < 3; ++c)
    stage.power[static_cast<std::size_t>(c)].unshot =
        (exchange.area * solution.exitance.col(c)).sum();
  return stage;
}

}  // namespace

std::vector<RadiosityStage> combine_stages(const LightExchange& exchange, const Solution& solution,
                                           const std::array<std::vector<ShotStage>, 3>& channels) {
  const std::int64_t emitters = (solution.exitance > 0).rowwise().any().count();
  std::vector<RadiosityStage> stages = {nothing_sent(exchange, solution)};
  const auto longest =
      std::max_element(channels.begin(), channels.end(),
                       [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (std::size_t k = 0; k < longest->size(); ++k) {
    RadiosityStage stage;
    stage.shots = emitters + (*longest)[k].shots;
    stage.irradiance = solution.direct_irradiance;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::vector<ShotStage>& of_channel = channels[c].empty() ? channels[0] : channels[c];
      const ShotStage& shot = of_channel[std::min(k, of_channel.size() - 1)];
      const auto column = static_cast<Eigen::Index>(c);
      stage.irradiance.col(column) += shot.received.array() + shot.ambient;
      stage.power[c] = power_at(shot, exchange, solution, column);
    }
    stages.push_back(std::move(stage));
  }
  return stages;
}

}  // namespace halfshade
