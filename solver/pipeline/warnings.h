#pragma once

#include "meshing/core/scene.h"
#include "meshing/discontinuity/discontinuity.h"
#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"
#include "solver/exchange/exchange.h"
#include "solver/linear/radiosity.h"

#include <optional>
#include <string>
#include <vector>

namespace halfshade {

/// What a user should know of before trusting a result that was computed.
struct Warning {
  enum class Kind {
    nothing_lit,         ///< no light reaches the front of any surface
    light_escapes,       ///< nearly all light leaves the scene
    dark_groups,         ///< some groups receive nothing
    outward_lamps,       ///< no surface lies before the emitters of some groups
    faces_changed,       ///< faces were dropped or moved, by more than rounding
    narrow_gaps,         ///< faces that may be meant back to back look at each other
    curves_left_out,     ///< kinds of curves were not looked for: it would take too long
    contacts_left_out,   ///< elements do not follow contact lines: there are too many
    tolerance_raised,    ///< curves above the tolerance were left out of the mesh
    elements_exceeded,   ///< the geometry takes more elements than asked for
    unknowns_exceeded,   ///< direct light takes more unknowns than there may be
    power_gained,        ///< surfaces absorb more than is emitted
    exchange_estimated,  ///< form factors were stopped; few rays stand for what is missing
    backs_exchange,      ///< surfaces exchange heat with backs in closed parts of space
    lost_by_factors,     ///< light gets lost in a closed space, for factors are off
    lamps_uneven,        ///< pictures that lamps shine with have more detail than their pieces
    in_files,            ///< something in the scene's files is not used, or not as it may be meant
    guessed              ///< what they do not say
  };
  Kind kind;
  std::string sentence;  ///< without a full stop
};

/// "light_escapes" and so on: how reports name a kind.
const char* name_of(Warning::Kind kind);

/// Appends.
void add(const std::vector<Warning>& more, std::vector<Warning>& warnings);

/// Of what the repair made of the scene.
std::vector<Warning> repair_warnings(const Scene& scene, const SoundScene& sound);

/// Light and how it was found, on the elements of a mesh.
struct LightOutcome {
  const SoundScene& scene;
  const ElementTable& elements;
  const Solution& solution;
  const ExchangeReport& exchange;
  const RadiosityReport& radiosity;
  int bounces = -1;  ///< after which light was not followed; −1: it was to the end
};

/// Of contact lines that would take more elements than an option, if it is that, allows.
Warning contacts_warning(std::optional<int> max_elements = {});

/// Of curves that were not looked for; nothing if all were.
std::vector<Warning> search_warnings(const DiscontinuityReport& report, double tolerance);

/// What a mesh was to be like, and what it is.
struct MeshOutcome {
  const SoundScene& scene;
  std::size_t kept;                   ///< curves
  int plain_elements;                 ///< without any curves
  int asked_elements;                 ///< 0: a length was asked for
  double tolerance, asked_tolerance;  ///< shares of the mean irradiance
  bool is_searched = true;            ///< for curves, if there may be any
};

std::vector<Warning> mesh_warnings(const MeshOutcome& outcome);

/// Of direct light that takes more unknowns than allowed; nothing if it does not. `rounds`: how
/// often its elements were looked at, so that after one none is divided.
std::vector<Warning> unknowns_warnings(std::size_t unknowns, int max_unknowns, int rounds);

/// Of surfaces that absorb more than emitters give, by more than this share of it in some channel;
/// nothing if none do. Where little is bright, an error that is small beside that is none beside
/// what is dark.
std::vector<Warning> power_warnings(const RadiosityReport& report, double tolerance);

/// Of factors that are estimates; nothing if none are.
std::vector<Warning> exchange_warnings(const ExchangeReport& report);

std::vector<Warning> light_warnings(const LightOutcome& outcome);

}  // namespace halfshade
