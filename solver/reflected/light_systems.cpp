#include "solver/reflected/light_systems.h"

#include "solver/exchange/shells.h"

#include <algorithm>

namespace halfshade {
LightSystems find_systems(const ReflectingScene& scene, const FirstLight& light,
                          const ReflectedMesh& mesh, const IrradianceOperator& exchange) {
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

ChannelArray power_put_in(const ReflectedMesh& mesh, const FirstLight& light,
                          const DirectProjection& direct, const LightSystems& systems) {
  ChannelArray emitted = ChannelArray::Zero(systems.count(), 3), arriving = emitted;
  ChannelArray reflected = emitted;
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    const std::size_t root = at(mesh.root(e));
    const Rgb falling = mesh.area(e) * direct.mean(mesh, e);
    emitted.row(s) += mesh.area(e) * light.exitance[root].transpose();
    arriving.row(s) += falling.transpose();
    reflected.row(s) += (light.rho[root] * falling).transpose();
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
