#include "solver/reflected/reflected_system.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>

namespace halfshade {
namespace {

constexpr int most_iterations = 600;

RowGroups groups_of(const ReflectedMesh& mesh, const LightSystems& systems,
                    const ElementField& field) {
  RowGroups groups;
  groups.count = systems.count();
  groups.of_row.resize(at(field.first.back()));
  groups.weight.resize(field.first.back());
  for (int e = 0; e < mesh.count(); ++e)
    for (int i = field.first[at(e)]; i < field.first[at(e) + 1]; ++i) {
      groups.of_row[at(i)] = systems.of_element[at(e)];
      groups.weight[i] = mesh.area(e);
    }
  return groups;
}

/// 0 where the divisor is.
ChannelArray ratio(const ChannelArray& a, const ChannelArray& b) {
  return (b != 0).select(a / b, 0.);
}

/// Keeps the rows of closed systems.
ChannelArray of_closed(const LightSystems& systems, ChannelArray values) {
  for (int s = 0; s < systems.count(); ++s)
    if (!systems.closed[at(s)]) values.row(s).setZero();
  return values;
}

/// The surfaces of a system, the first few.
std::string surfaces_of(const ReflectedSystem& system, int s) {
  constexpr std::size_t most = 8;
  std::set<int> surfaces;
  for (int e = 0; e < system.mesh.count(); ++e)
    if (system.systems.of_element[at(e)] == s)
      surfaces.insert(system.light.surface[at(system.mesh.root(e))]);
  const std::vector<int> all(surfaces.begin(), surfaces.end());
  const std::size_t shown = std::min(all.size(), most);
  return fmt::format("{}{}", fmt::join(all.begin(), all.begin() + static_cast<long>(shown), ", "),
                     shown < all.size() ? fmt::format(" and {} more", all.size() - shown) : "");
}

void require_absorption(const ReflectedSystem& system, const ChannelArray& power) {
  const LightSystems& systems = system.systems;
  for (int s = 0; s < systems.count(); ++s)
    if (systems.closed[at(s)] && (systems.absorption.row(s) <= 0 && power.row(s) > 0).any())
      throw Error(ErrorCode::invalid_input, {},
                  fmt::format("surfaces {} close in a space that reflects everything (reflectance "
                              "1), and light of {} W is put in, so its radiosity has no limit; "
                              "lower a reflectance",
                              surfaces_of(system, s), power.row(s).maxCoeff()));
}

/// The operator of the rest, see solve_reflected.
class RestOperator {
 public:
  RestOperator(const ReflectedSystem& system, const ElementField& ambient)
      : system_(system), ambient_(ambient) {}

  ChannelArray operator()(const ChannelArray& y) const {
    const auto& [mesh, light, exchange, systems] = system_;
    ElementField field = ambient_;
    field.coefficients = y;
    ElementField leaving = reflected_part(mesh, light, field);
    const ChannelArray weighted =
        ratio(absorbed_integrals(mesh, light, systems, field), systems.absorption);
    add_absorbed(mesh, light, systems, of_closed(systems, weighted), leaving);
    const ChannelArray mean =
        of_closed(systems, integrals(mesh, systems, field).colwise() / systems.area);
    ChannelArray image = y - exchange.apply(mesh, leaving).coefficients;
    for (int e = 0; e < mesh.count(); ++e)
      image.middleRows(field.first[at(e)], ambient_.of(e).rows()) +=
          ambient_.of(e).rowwise() * mean.row(systems.of_element[at(e)]);
    return image;
  }

 private:
  ReflectedSystem system_;
  const ElementField& ambient_;
};

/// What arrives in all, scaled to a mean of 1 in each system.
ElementField ambient_form(const ReflectedSystem& system, const SplitIrradiance& arriving) {
  ElementField form = arriving.whole(system.mesh, system.systems);
  const ChannelArray mean =
      integrals(system.mesh, system.systems, form).colwise() / system.systems.area;
  for (int e = 0; e < system.mesh.count(); ++e) {
    const auto m = mean.row(system.systems.of_element[at(e)]);
    for (int c = 0; c < 3; ++c) {
      auto column = form.of(e).col(c);
      if (m[c] > 0) {
        column /= m[c];
      } else {
        column.setZero();
        column[0] = 1;
      }
    }
  }
  return form;
}

}  // namespace

ReflectedSolution solve_reflected(const ReflectedSystem& system, const ElementField& arriving,
                                  const ChannelArray& power, double tolerance,
                                  const ElementField* ambient) {
  const auto& [mesh, light, exchange, systems] = system;
  require_absorption(system, power);
  ReflectedSolution solution;
  SplitIrradiance& irradiance = solution.irradiance;
  irradiance = {of_closed(systems, ratio(power, systems.absorption)), zero_field(mesh)};
  irradiance.rest = exchange.apply(mesh, leaving_rest(mesh, light, systems, irradiance));
  irradiance.rest.coefficients += arriving.coefficients;
  solution.ambient = ambient ? *ambient : ambient_form(system, irradiance);
  const GmresResult solved =
      gmres(RestOperator(system, solution.ambient), irradiance.rest.coefficients,
            groups_of(mesh, systems, irradiance.rest), tolerance, most_iterations,
            [&exchange = exchange] { return exchange.stopped(); });
  irradiance.rest.coefficients = solved.x;
  irradiance.constant -= of_closed(
      systems,
      ratio(absorbed_integrals(mesh, light, systems, irradiance.rest), systems.absorption));
  solution.iterations = solved.iterations;
  solution.residual = solved.residual;
  solution.amplification = solved.amplification;
  return solution;
}

ReflectedSolution solve_for(const ReflectedSystem& system, double tolerance) {
  constexpr double exact = 1e-10;
  // Of the tolerance: the residual, and what it may do.
  constexpr double share = 1e-3, most = 0.03;
  const ElementField source = system.exchange.source(system.mesh);
  const auto solve_to = [&](double residual) {
    return solve_reflected(system, source, system.systems.power, residual);
  };
  if (tolerance == 0) return solve_to(exact);
  const ReflectedSolution solution = solve_to(share * tolerance);
  const bool is_enough = solution.residual * solution.amplification <= most * tolerance;
  return is_enough ? solution : solve_to(exact);
}

ElementField all_light_of(const ReflectedSystem& system, const ElementField& arriving,
                          double residual) {
  const ChannelArray no_power = ChannelArray::Zero(system.systems.count(), 3);
  return solve_reflected(system, arriving, no_power, residual)
      .irradiance.whole(system.mesh, system.systems);
}

ElementField arriving_by_rows(const ReflectedSystem& system, const ElementField& leaving) {
  ElementField arriving = system.exchange.source(system.mesh);
  arriving.coefficients += system.exchange.apply(system.mesh, leaving).coefficients;
  return arriving;
}

ReflectedSolution sum_bounces(const ReflectedSystem& system, int bounces) {
  const auto& [mesh, light, exchange, systems] = system;
  const ElementField first = exchange.source(mesh);
  ReflectedSolution solution;
  solution.irradiance = {ChannelArray::Zero(systems.count(), 3), zero_field(mesh)};
  ElementField& sum = solution.irradiance.rest;
  for (int k = 1; k < bounces && !exchange.stopped(); ++k) {
    sum = exchange.apply(mesh, reflected_part(mesh, light, sum));
    sum.coefficients += first.coefficients;
  }
  return solution;
}

std::vector<ElementField> split_by_bounce(const ReflectedSystem& system, int bounces,
                                          const ElementField& irradiance) {
  const auto& [mesh, light, exchange, systems] = system;
  std::vector<ElementField> parts = {exchange.source(mesh)};
  ElementField left = irradiance;
  left.coefficients -= parts[0].coefficients;
  while (parts.size() < at(bounces)) {
    parts.push_back(exchange.apply(mesh, reflected_part(mesh, light, parts.back())));
    left.coefficients -= parts.back().coefficients;
  }
  for (int e = 0; e < mesh.count(); ++e) {
    Rgb sum = Rgb::Zero();
    for (const ElementField& part : parts) sum += part.of(e).row(0).transpose().abs();
    for (int c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < parts.size(); ++k) {
        auto column = parts[k].of(e).col(c);
        const double even = k == 0 ? 1 : 0;
        column += (sum[c] > 0 ? std::abs(column[0]) / sum[c] : even) * left.of(e).col(c);
      }
  }
  return parts;
}

}  // namespace halfshade
