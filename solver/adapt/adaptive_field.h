#pragma once

#include "meshing/core/progress.h"
#include "meshing/patches/patch_mesh.h"
#include "solver/adapt/watched.h"
#include "solver/elements/element_field.h"
#include "solver/elements/error_weight.h"

#include <functional>
#include <span>
#include <vector>

namespace halfshade {

/// A field on surfaces, W/m²: its values at points. It must be the same for the same points.
using FieldAt = std::function<std::vector<Rgb>(std::span<const FieldPoint>, const Progress&)>;

/// What limits an adaptive field.
enum class FieldLimit { none, elements, unknowns, samples, work, rounds, fixed, stopped };

struct AdaptiveFieldOptions {
  double tolerance = 0.01;        ///< of the error's L2 norm, relative to the field's; > 0
  double norm = 0;                ///< that it is relative to instead, if that is more
  ErrorWeight weight;             ///< of its square; if there is one, `norm` alone counts
  int order = -1;                 ///< of all elements, 0…max_order; −1: chosen for each
  int highest_order = max_order;  ///< if orders are chosen
  bool split = true;              ///< false: elements stay as they are
  bool merge = false;             ///< splits are undone in the end where they are not needed
  bool balance = false;           ///< what matters most gets better still where all get fewer
                                  ///< unknowns by that; with chosen orders
  int max_elements = 40000;
  int max_unknowns = 1000000;  ///< per channel
  /// How many it would take in another way: gives up once what is still to come in this one is
  /// likely to be more, if a few times as many may still be taken; 0: never.
  double samples_of_other_way = 0;
  /// Surface → whether its elements count where others are compared with all of them, in number
  /// and size; empty: all do. Of surfaces that get hardly any light they should not.
  std::vector<bool> counted;
  /// How many samples may still be taken, about: elements begin with lower orders where all would
  /// be too many, and a round has no more. None: any number.
  std::function<double()> samples_left;
  /// What samples have taken, as a share of what they may; more than 1 if it is more. Noisy samples
  /// take less than exact ones, see fit_noisy. None: as good as nothing.
  std::function<double()> work_done;
};

struct AdaptiveFieldReport {
  int rounds = 0;
  std::size_t samples = 0;
  std::size_t unknowns = 0;   ///< coefficients per channel
  double relative_error = 0;  ///< estimated, in the L2 norm over all surfaces and channels
  FieldLimit limit = FieldLimit::none;  ///< what kept it above the tolerance
  bool is_noisy = false;                ///< the field was known but for noise, see fit_noisy
};

/// A field on the elements of a mesh.
struct AdaptiveField {
  ElementTable elements;
  ElementField field;
  Eigen::ArrayXd error;  ///< root mean square over each element, the channels' squares summed; W/m²
  AdaptiveFieldReport report;
};

/// Fits polynomials to a field on the elements of a mesh, until the estimated error is within the
/// tolerance: raises the order of elements where the coefficients decay, splits the others (hp
/// adaptivity; Babuška and Suri 1994), and lowers orders, or merges elements again if asked to,
/// where that costs nothing noticeable. The estimate comes of samples within each element, at
/// Gauss's places, and is checked at others, and where the field is watched, before it is believed.
/// Breaks that elements do not follow are met by splitting. The mesh is left as the elements are.
///
/// If stopped, the elements keep what the last whole round gave. Throws Error(contract) for options
/// out of range. The same for any number of threads.
AdaptiveField fit_adaptively(PatchMesh& mesh, const FieldAt& field,
                             const AdaptiveFieldOptions& options, const Progress& progress = {},
                             const Watched& watched = {});

}  // namespace halfshade
