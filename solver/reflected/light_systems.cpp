#include "solver/reflected/light_systems.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "solver/exchange/shells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Points at which direct light is asked for, over all surfaces.
constexpr double mean_points = 20000;

Rgb sampled_mean(const ReflectedMesh& mesh, const FirstLight& light, int element, int strata) {
  const int triangle = mesh.triangle[at(element)];
  const std::uint64_t seed = ray_seed(triangle, 0, 1);
  Rgb sum = Rgb::Zero();
  std::uint64_t number = 0;
  for (int i = 0; i < strata; ++i)
    for (int j = 0; j < strata; ++j, number += 2) {
      const double across = std::sqrt((i + random_number(seed, number)) / strata);
      const double along = (j + random_number(seed, number + 1)) / strata;
      sum += light.direct_at(mesh.root(element),
                             mesh.position(element, {across * (1 - along), across * along}));
    }
  return sum / (strata * strata);
}

}  // namespace

LightSystems find_systems(const ReflectingScene& scene, const FirstLight& light,
                          const ReflectedMesh& mesh, const RayExchange& exchange) {
  JoinedSets sets(mesh.count());
  std::vector<int> of_cell(at(scene.cells.count()), -1);
  for (int e = 0; e < mesh.count(); ++e) {
    const int cell = scene.cells.before(mesh.root(e));
    int& first = of_cell[at(cell)];
    if (scene.cells.closed[at(cell)]) {
      if (first >= 0) sets.join(first, e);
      first = e;
      continue;
    }
    for (const int other : exchange.seen_from(mesh, e)) sets.join(e, other);
  }
  LightSystems systems;
  systems.of_element = sets.numbered();
  const int count = 1 + *std::max_element(systems.of_element.begin(), systems.of_element.end());
  systems.closed.assign(at(count), false);
  systems.area = Eigen::ArrayXd::Zero(count);
  systems.absorption = systems.power = ChannelArray::Zero(count, 3);
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    systems.closed[at(s)] = scene.cells.closed[at(scene.cells.before(mesh.root(e)))];
    systems.area[s] += mesh.area(e);
    systems.absorption.row(s) += mesh.area(e) * (1 - light.rho[at(mesh.root(e))]).transpose();
  }
  return systems;
}

void DirectMeans::update(const ReflectedMesh& mesh, const FirstLight& light) {
  of_triangle_.resize(at(mesh.forest.count()));
  double total = 0;
  for (int e = 0; e < mesh.count(); ++e) total += mesh.area(e);
  parallel_for(at(mesh.count()), [&](std::size_t e) {
    auto& mean = of_triangle_[at(mesh.triangle[e])];
    if (mean) return;
    const double points = mean_points * mesh.area(static_cast<int>(e)) / total;
    const int strata = std::max(1, static_cast<int>(std::lround(std::sqrt(points))));
    mean = std::make_unique<Rgb>(sampled_mean(mesh, light, static_cast<int>(e), strata));
  });
}

ChannelArray DirectMeans::power(const ReflectedMesh& mesh, const FirstLight& light,
                                const LightSystems& systems) const {
  ChannelArray emitted = ChannelArray::Zero(systems.count(), 3), arriving = emitted;
  ChannelArray reflected = emitted;
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    const std::size_t root = at(mesh.root(e));
    const Rgb direct = mesh.area(e) * *of_triangle_[at(mesh.triangle[at(e)])];
    emitted.row(s) += mesh.area(e) * light.exitance[root].transpose();
    arriving.row(s) += direct.transpose();
    reflected.row(s) += (light.rho[root] * direct).transpose();
  }
  if (light.through_operator) return emitted;
  return (arriving > 0).select(reflected * emitted / arriving, 0.);
}

ChannelArray integrals(const ReflectedMesh& mesh, const LightSystems& systems,
                       const ElementField& field, const std::vector<Rgb>* weight) {
  ChannelArray result = ChannelArray::Zero(systems.count(), 3);
  for (int e = 0; e < mesh.count(); ++e) {
    Rgb mean = field.of(e).row(0).transpose();
    if (weight) mean *= (*weight)[at(mesh.root(e))];
    result.row(systems.of_element[at(e)]) += mesh.area(e) * mean.transpose();
  }
  return result;
}

void add_constants(const ReflectedMesh& mesh, const LightSystems& systems,
                   const ChannelArray& value, const std::vector<Rgb>* weight, ElementField& field) {
  for (int e = 0; e < mesh.count(); ++e) {
    Rgb added = value.row(systems.of_element[at(e)]).transpose();
    if (weight) added *= (*weight)[at(mesh.root(e))];
    field.of(e).row(0) += added.transpose();
  }
}

ElementField SplitIrradiance::whole(const ReflectedMesh& mesh, const LightSystems& systems) const {
  ElementField sum = rest;
  add_constants(mesh, systems, constant, nullptr, sum);
  return sum;
}

ElementField leaving_rest(const ReflectedMesh& mesh, const FirstLight& light,
                          const LightSystems& systems, const SplitIrradiance& irradiance) {
  ElementField leaving = reflected_part(mesh, light, irradiance.rest);
  const std::vector<Rgb> absorbed = absorptances(light);
  add_constants(mesh, systems, -irradiance.constant, &absorbed, leaving);
  return leaving;
}

std::vector<Rgb> absorptances(const FirstLight& light) {
  std::vector<Rgb> result;
  for (const Rgb& rho : light.rho) result.push_back(1 - rho);
  return result;
}

}  // namespace halfshade
