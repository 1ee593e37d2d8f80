#include "solver/reflected/light_systems.h"

#include "solver/exchange/shells.h"
#include "solver/reflected/ray_exchange.h"

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
  systems.area = systems.gaps = Eigen::ArrayXd::Zero(count);
  systems.absorption = systems.power = ChannelArray::Zero(count, 3);
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    const std::size_t cell = at(scene.cells.before(mesh.root(e)));
    systems.closed[at(s)] = scene.cells.closed[cell];
    if (systems.closed[at(s)]) systems.gaps[s] = scene.cells.gaps[cell];
    systems.area[s] += mesh.area(e);
    systems.absorption.row(s) += mesh.area(e) * (1 - light.mean_rho(mesh, e)).transpose();
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
    reflected.row(s) += mesh.area(e) * direct.mean_leaving(mesh, light, e).transpose();
  }
  if (light.through_operator) return emitted;
  return (arriving > 0).select(reflected * emitted / arriving, 0.);
}

ChannelArray integrals(const ReflectedMesh& mesh, const LightSystems& systems,
                       const ElementField& field) {
  ChannelArray result = ChannelArray::Zero(systems.count(), 3);
  for (int e = 0; e < mesh.count(); ++e)
    result.row(systems.of_element[at(e)]) += mesh.area(e) * field.of(e).row(0);
  return result;
}

ChannelArray absorbed_integrals(const ReflectedMesh& mesh, const FirstLight& light,
                                const LightSystems& systems, const ElementField& field) {
  ChannelArray result = ChannelArray::Zero(systems.count(), 3);
  for (int e = 0; e < mesh.count(); ++e)
    result.row(systems.of_element[at(e)]) +=
        mesh.area(e) * light.absorbed(mesh, e, field.of(e)).transpose();
  return result;
}

void add_constants(const ReflectedMesh& mesh, const LightSystems& systems,
                   const ChannelArray& value, ElementField& field) {
  for (int e = 0; e < mesh.count(); ++e) field.of(e).row(0) += value.row(systems.of_element[at(e)]);
}

void add_absorbed(const ReflectedMesh& mesh, const FirstLight& light, const LightSystems& systems,
                  const ChannelArray& value, ElementField& field) {
  for (int e = 0; e < mesh.count(); ++e) {
    const auto added = value.row(systems.of_element[at(e)]);
    if (!light.painted.is_painted(mesh.root(e))) {
      field.of(e).row(0) += added * (1 - light.rho[at(mesh.root(e))]).transpose();
      continue;
    }
    ChannelArray even = ChannelArray::Zero(field.of(e).rows(), 3);
    even.row(0) = added;
    field.of(e) += even - light.reflected(mesh, e, even);
  }
}

ElementField SplitIrradiance::whole(const ReflectedMesh& mesh, const LightSystems& systems) const {
  ElementField sum = rest;
  add_constants(mesh, systems, constant, sum);
  return sum;
}

ElementField leaving_rest(const ReflectedMesh& mesh, const FirstLight& light,
                          const LightSystems& systems, const SplitIrradiance& irradiance) {
  ElementField leaving = reflected_part(mesh, light, irradiance.rest);
  add_absorbed(mesh, light, systems, -irradiance.constant, leaving);
  return leaving;
}

}  // namespace halfshade
