#pragma once

#include "solver/reflected/direct_projection.h"
#include "solver/reflected/first_light.h"
#include "solver/reflected/irradiance_operator.h"
#include "solver/reflected/lockstep_gmres.h"
#include "solver/reflected/reflecting_scene.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace halfshade {

/// Parts of a mesh that exchange no light with each other. One row a system below.
struct LightSystems {
  std::vector<int> of_element;
  std::vector<bool> closed;  ///< no light leaves it
  Eigen::ArrayXd area;
  ChannelArray absorption;  ///< ∫ (1 − ρ)
  Eigen::ArrayXd gaps;      ///< of closed systems, see SpaceCells
  ChannelArray power;       ///< ∫ S, of closed systems

  int count() const { return static_cast<int>(closed.size()); }
};

/// A closed cell of space is one; in an open one it is what sees each other. Without power.
LightSystems find_systems(const ReflectingScene& scene, const FirstLight& light,
                          const ReflectedMesh& mesh, const IrradianceOperator& exchange);

/// ∫ S over each closed system. Direct light is scaled so that all that is emitted arrives.
ChannelArray power_put_in(const ReflectedMesh& mesh, const FirstLight& light,
                          const DirectProjection& direct, const LightSystems& systems);

/// ∫ of a field over each system.
ChannelArray integrals(const ReflectedMesh& mesh, const LightSystems& systems,
                       const ElementField& field);

/// ∫ (1 − ρ) of a field over each system.
ChannelArray absorbed_integrals(const ReflectedMesh& mesh, const FirstLight& light,
                                const LightSystems& systems, const ElementField& field);

/// Adds `value` of its system to an element's field everywhere.
void add_constants(const ReflectedMesh& mesh, const LightSystems& systems,
                   const ChannelArray& value, ElementField& field);

/// The same times 1 − ρ.
void add_absorbed(const ReflectedMesh& mesh, const FirstLight& light, const LightSystems& systems,
                  const ChannelArray& value, ElementField& field);

/// Irradiance as a constant of each closed system, and the rest. What a system that absorbs next to
/// nothing holds is nearly all in the constant, which the balance of power gives exactly.
struct SplitIrradiance {
  ChannelArray constant;  ///< of each system
  ElementField rest;

  ElementField whole(const ReflectedMesh& mesh, const LightSystems& systems) const;
};

/// What leaves where that irradiance arrives, less the constant: ρ rest − (1 − ρ) constant.
ElementField leaving_rest(const ReflectedMesh& mesh, const FirstLight& light,
                          const LightSystems& systems, const SplitIrradiance& irradiance);

}  // namespace halfshade
