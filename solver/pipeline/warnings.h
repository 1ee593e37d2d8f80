#pragma once

#include "meshing/core/scene.h"
#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"
#include "solver/exchange/exchange.h"
#include "solver/linear/radiosity.h"

#include <string>
#include <vector>

namespace halfshade {

/// What a user should know of before trusting a result that was computed.
struct Warning {
  enum class Kind {
    nothing_lit,     ///< no light reaches the front of any surface
    light_escapes,   ///< nearly all light leaves the scene
    dark_groups,     ///< some groups receive nothing
    faces_changed,   ///< faces were dropped or moved, by more than rounding
    lost_by_factors  ///< light gets lost in a closed space, for factors are off
  };
  Kind kind;
  std::string sentence;  ///< without a full stop
};

/// "light_escapes" and so on: how reports name a kind.
const char* name_of(Warning::Kind kind);

/// Of what the repair made of the scene.
std::vector<Warning> repair_warnings(const Scene& scene, const SoundScene& sound);

/// Light and how it was found, on the elements of a mesh.
struct LightOutcome {
  const SoundScene& scene;
  const ElementTable& elements;
  const Solution& solution;
  const ExchangeReport& exchange;
  const RadiosityReport& radiosity;
};

std::vector<Warning> light_warnings(const LightOutcome& outcome);

}  // namespace halfshade
