#include "solver/reflected/loss_balance.h"

#include "solver/reflected/ray_exchange.h"

namespace halfshade {
namespace {

/// Elsewhere what nodes miss matters as little as other errors of theirs.
constexpr double much_lost = 0.2;

/// Systems in which all that gets lost is known.
std::vector<bool> known_systems(const ReflectedSystem& system,
                                const std::vector<UnsureLoss>& unsure) {
  const auto& [mesh, light, exchange, systems] = system;
  std::vector<bool> known(at(systems.count()));
  for (std::size_t s = 0; s < known.size(); ++s) known[s] = !systems.closed[s];
  for (int e = 0; e < mesh.count(); ++e) {
    const BackShadow* shadow = exchange.shadow(e);
    const bool is_slit = shadow && shadow->share != 0;
    const bool is_in_gap = unsure[at(e)].parts > 0 && (unsure[at(e)].factor > 0).any();
    if (exchange.seen(e).size() == 0 || (is_in_gap && !is_slit))
      known[at(systems.of_element[at(e)])] = false;
  }
  return known;
}

/// ∫ (1 − ω) f over each system.
ChannelArray unseen_integrals(const ReflectedSystem& system, const ElementField& f) {
  const auto& [mesh, light, exchange, systems] = system;
  ChannelArray sums = ChannelArray::Zero(systems.count(), 3);
  for (int e = 0; e < mesh.count(); ++e) {
    Eigen::VectorXd unseen = -exchange.seen(e);
    if (unseen.size() == 0) continue;
    unseen[0] += 1;
    sums.row(systems.of_element[at(e)]) +=
        mesh.area(e) * (unseen.transpose() * f.of(e).matrix()).array();
  }
  return sums;
}

/// ∫ (1 − ω ρ) f over each system.
ChannelArray lost_integrals(const ReflectedSystem& system, const ElementField& f) {
  return absorbed_integrals(system.mesh, system.light, system.systems, f) +
         unseen_integrals(system, reflected_part(system.mesh, system.light, f));
}

/// Adds `share` of `irradiance` to a field where all that gets lost is known, and little is.
void add_share(const ReflectedSystem& system, const std::vector<UnsureLoss>& unsure,
               const ElementField& irradiance, const ChannelArray& lost, const ChannelArray& share,
               ElementField& field) {
  const std::vector<bool> known = known_systems(system, unsure);
  const ChannelArray all = integrals(system.mesh, system.systems, irradiance);
  for (int e = 0; e < system.mesh.count(); ++e) {
    const int s = system.systems.of_element[at(e)];
    for (int c = 0; c < 3; ++c)
      if (known[at(s)] && lost(s, c) > 0 && lost(s, c) < much_lost * all(s, c))
        field.of(e).col(c) += share(s, c) * irradiance.of(e).col(c);
  }
}

}  // namespace

void balance_loss(const ReflectedSystem& system, const ElementField& first_leaving,
                  const std::vector<UnsureLoss>& unsure, ElementField& irradiance) {
  const ChannelArray lost = lost_integrals(system, irradiance);
  const ChannelArray arriving = integrals(system.mesh, system.systems, first_leaving) -
                                unseen_integrals(system, first_leaving);
  add_share(system, unsure, ElementField(irradiance), lost, arriving / lost - 1, irradiance);
}

void balance_missing(const ReflectedSystem& system, const ElementField& irradiance,
                     const std::vector<UnsureLoss>& unsure, const ElementField& source,
                     ElementField& missing) {
  const ChannelArray lost = lost_integrals(system, irradiance);
  const ChannelArray unbalanced =
      integrals(system.mesh, system.systems, source) - lost_integrals(system, missing);
  add_share(system, unsure, irradiance, lost, unbalanced / lost, missing);
}

void balance_change(const ReflectedSystem& system, const ElementField& irradiance,
                    const std::vector<UnsureLoss>& unsure, ElementField& change) {
  balance_missing(system, irradiance, unsure, zero_field(system.mesh), change);
}

}  // namespace halfshade
