#include "solver/linear/system_solver.h"

#include "meshing/core/error.h"
#include "solver/elements/balancing_scale.h"
#include "solver/linear/conjugate_gradients.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

/// Reflectances below this reflect nothing that a double could hold beside the rest.
constexpr double least_reflectance = 1e-100;
/// What is put in where nothing gets out, relative to what is sent about, counts as rounding.
constexpr double balanced = 1e-12;

/// (losses + L) R = input, over the elements that reflect.
struct Balance {
  std::vector<int> elements;
  Eigen::VectorXd loss;   ///< power per unit of radiosity that does not come back
  Eigen::VectorXd given;  ///< power per unit of radiosity to others that reflect
  Eigen::VectorXd input;
  Eigen::VectorXd wanted;  ///< of all elements, 1 for these
};

Eigen::VectorXd gather(const Eigen::VectorXd& all, const std::vector<int>& elements) {
  Eigen::VectorXd some(static_cast<Eigen::Index>(elements.size()));
  for (std::size_t k = 0; k < elements.size(); ++k)
    some[static_cast<Eigen::Index>(k)] = all[elements[k]];
  return some;
}

Eigen::VectorXd scatter(const Eigen::VectorXd& some, const std::vector<int>& elements,
                        Eigen::Index count) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(count);
  for (std::size_t k = 0; k < elements.size(); ++k)
    all[elements[k]] = some[static_cast<Eigen::Index>(k)];
  return all;
}

/// What the elements receive of a radiosity of theirs.
Eigen::VectorXd exchanged(const LightExchange& exchange, const Balance& balance,
                          const Eigen::VectorXd& radiosity) {
  const Eigen::Index count = exchange.area.size();
  Eigen::VectorXd out(count);
  exchange.apply(scatter(radiosity, balance.elements, count), balance.wanted, out);
  return gather(out, balance.elements);
}

Balance make_balance(const LightSystem& system, const SystemLight& light, double scale) {
  const LightExchange& exchange = system.exchange;
  Balance balance;
  balance.wanted = Eigen::VectorXd::Zero(exchange.area.size());
  Eigen::VectorXd black = balance.wanted, to_black = balance.wanted;
  for (const int e : system.elements)
    if (light.rho[e] >= least_reflectance) {
      balance.elements.push_back(e);
      balance.wanted[e] = 1;
    } else {
      black[e] = 1;
    }
  if (balance.elements.empty()) return balance;
  exchange.apply(black, balance.wanted, to_black);
  const auto count = static_cast<Eigen::Index>(balance.elements.size());
  balance.loss.resize(count);
  balance.input.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const int e = balance.elements[static_cast<std::size_t>(k)];
    const double area = exchange.area[e], rho = light.rho[e];
    // What factors are off must not make light out of nothing.
    balance.loss[k] = std::max(0., area * ((1 - rho) / rho) + exchange.lost[e] + to_black[e]);
    balance.input[k] = area * (light.direct_irradiance[e] * scale);
  }
  balance.given = exchanged(exchange, balance, Eigen::VectorXd::Ones(count));
  return balance;
}

/// The uniform part of the solution, from the balance of all power.
double uniform_part(const LightSystem& system, const Balance& balance) {
  const double lost = balance.loss.sum(), put_in = balance.input.sum();
  if (lost > 0) return put_in / lost;
  if (std::abs(put_in) > balanced * balance.input.lpNorm<1>())
    throw Error(ErrorCode::invalid_input, {},
                fmt::format("system {} is closed and reflects everything (reflectance 1), so the "
                            "radiosity has no limit; lower a reflectance",
                            system.id));
  return 0;
}

/// What is added to a solution where nothing is lost, so that the radiosity is smallest.
double to_least_norm(const LightSystem& system, const SystemLight& light, const Balance& balance,
                     const Eigen::VectorXd& rest, double scale) {
  double power = 0, area = 0;
  for (std::size_t k = 0; k < balance.elements.size(); ++k) {
    const int e = balance.elements[k];
    area += system.exchange.area[e];
    power +=
        system.exchange.area[e] * (light.exitance[e] * scale + rest[static_cast<Eigen::Index>(k)]);
  }
  return -power / area;
}

double largest_light(const LightSystem& system, const SystemLight& light) {
  double largest = 0;
  for (const int e : system.elements)
    largest =
        std::max({largest, std::abs(light.exitance[e]), std::abs(light.direct_irradiance[e])});
  return largest;
}

}  // namespace

SystemReport solve_system(const LightSystem& system, const SystemLight& light,
                          const RadiosityOptions& options, Eigen::VectorXd& reflected) {
  const double scale = balancing_scale(largest_light(system, light));
  const Balance balance = make_balance(system, light, scale);
  SystemReport report;
  report.unknowns = static_cast<int>(balance.elements.size());
  if (report.unknowns == 0 || balance.input.lpNorm<1>() == 0) return report;
  const double uniform = uniform_part(system, balance);
  const Eigen::VectorXd root =
      (balance.loss + balance.given).cwiseSqrt().cwiseMax(std::numeric_limits<double>::min());
  const auto apply = [&](const Eigen::VectorXd& y) -> Eigen::VectorXd {
    const Eigen::VectorXd x = y.cwiseQuotient(root);
    return y - exchanged(system.exchange, balance, x).cwiseQuotient(root);
  };
  // What the uniform part does not explain; its sum is zero.
  const Eigen::VectorXd b = (balance.input - uniform * balance.loss).cwiseQuotient(root);
  const double input = balance.input.cwiseQuotient(root).norm();
  const IterationResult solved =
      conjugate_gradients(apply, b, {options.tolerance * input, options.max_iterations});
  Eigen::VectorXd residual = b - apply(solved.x);
  Eigen::VectorXd rest = solved.x.cwiseQuotient(root);
  // The balance holds for the rest by itself; rounding may have left a part of the uniform mode.
  const double lost = balance.loss.sum();
  const double correction = lost > 0 ? -balance.loss.dot(rest) / lost
                                     : to_least_norm(system, light, balance, rest, scale);
  const Eigen::VectorXd R = (rest.array() + (uniform + correction)).matrix();
  residual -= correction * balance.loss.cwiseQuotient(root);
  report.iterations = solved.iterations;
  for (const double r : solved.residuals) report.history.push_back(r / input);
  report.residual = residual.norm() / input;
  report.error = residual.norm() / solved.smallest_eigenvalue / R.cwiseProduct(root).norm();
  const bool is_positive = (balance.input.array() >= 0).all() && lost > 0;
  for (std::size_t k = 0; k < balance.elements.size(); ++k) {
    const double value = R[static_cast<Eigen::Index>(k)];
    // Rounding may leave the reflected part of an unlit element a hair below zero.
    reflected[balance.elements[k]] = (is_positive ? std::max(value, 0.) : value) / scale;
  }
  return report;
}

}  // namespace halfshade
