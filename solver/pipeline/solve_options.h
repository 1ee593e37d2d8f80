#pragma once

#include "meshing/discontinuity/discontinuity.h"
#include "solver/exchange/exchange.h"
#include "solver/linear/radiosity.h"
#include "solver/reflected/reflected_light.h"

#include <string>

namespace halfshade {

enum class DirectLightBy {
  automatic,  ///< exact, unless emitters are most of the scene, as in a furnace
  exact,      ///< closed forms on exactly visible parts at points of each element
  matrix      ///< the same form factors as reflected light
};

enum class SolveMethod {
  fields,  ///< direct light as polynomials on elements made for it, to the tolerance asked
  matrix   ///< constant elements and a dense matrix of form factors
};

/// Where reflected light that files hold comes from.
enum class FinalGather {
  automatic,  ///< on only where the polynomials stay short of the tolerance
  on,         ///< gathered once more at points of each element
  off         ///< the polynomials it was solved for as
};

enum class Refinement {
  adaptive,  ///< elements and orders follow the error
  uniform    ///< elements of `elements` or `max_length` are kept
};

/// Stages to run also where the scene does not need them. What the user left out stays so.
struct ForcedStages {
  bool discontinuities = false;
  bool eee = false;  ///< also with one convex occluder
  bool exact_direct_light = false;
  bool factors = false;   ///< also where nothing reflects
  bool channels = false;  ///< all three, also in a grey scene
};

/// Adaptive subdivision of constant elements, see subdivide.
struct SubdivisionOptions {
  int rounds = 0;         ///< ≥ 0
  double gradient = 0.1;  ///< from element to element, as a share of the mean irradiance; > 0
};

struct SolveOptions {
  SolveMethod method = SolveMethod::fields;
  Refinement refine = Refinement::adaptive;
  /// Of the irradiance's error, in the L2 norm, relative to the irradiance's; > 0 unless the method
  /// is the matrix, where curves whose effect is below this share of the mean are left out.
  double tolerance = 0.01;
  /// Files will hold straight triangles instead of polynomials, see cut_for_files: polynomials
  /// leave them a part of the tolerance.
  bool straight = false;
  /// What irradiance is off before it is found, because lamps shine evenly instead of as their
  /// pictures do: L2 norm over all surfaces and channels. Counts as an error of direct light.
  double lamp_error = 0;
  int order = -1;        ///< of all elements, 0…max_order; −1: chosen for each
  int max_unknowns = 0;  ///< per channel, ≥ 1; 0: see with_limits
  /// Name of a group: the tolerance is that of its mean irradiance, and effort goes where that
  /// feels it. Empty: all irradiance matters. Not with the matrix.
  std::string goal;
  int elements =
      8000;  ///< about how many elements to mesh the scene with, ≥ 1; used if max_length is 0
  double max_length = 0;        ///< longest element edge in scene units; 0: derived from `elements`
  double deviation = 0;         ///< of chords from conics, as DiscontinuityMeshOptions has it
  int max_elements = 0;         ///< refuse to make more, ≥ 1; 0: see with_limits
  bool discontinuities = true;  ///< mesh along the curves where the light breaks
  DiscontinuityOptions
      events;            ///< which curves to look for; most_work 0: what `tolerance` is worth
  int secondary = 0;     ///< look for those of this many of the brightest reflecting surfaces, too
  bool regions = false;  ///< say what each element sees of each emitter
  bool each_bounce = false;  ///< tell light apart by how often it was reflected; needs `bounces`
  DirectLightBy direct_light = DirectLightBy::automatic;
  ReflectedVisibility visibility = ReflectedVisibility::automatic;  ///< of reflected light
  FinalGather final_gather = FinalGather::automatic;  ///< not with the matrix or some bounces
  int direct_points = 6;  ///< points an element at which direct light is exact, 1…12
  ExchangeOptions exchange;
  RadiosityOptions radiosity;
  SubdivisionOptions subdivision;  ///< of the matrix' elements
  bool interpolate = false;        ///< linear between values at their points; of the matrix
  ForcedStages force;
};

}  // namespace halfshade
