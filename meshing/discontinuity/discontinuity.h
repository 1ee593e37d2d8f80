#pragma once

#include "meshing/backprojection/visible_part.h"
#include "meshing/core/light_source.h"
#include "meshing/core/progress.h"
#include "meshing/core/sound_scene.h"
#include "meshing/events/critical_event.h"
#include "meshing/geometry/conic_arc.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

/// Where the irradiance that one emitter gives a receiver is not smooth.
struct DiscontinuityCurve {
  int receiver = 0;
  int emitter = 0;                 ///< a receiver, too
  CurveKind kind = CurveKind::ev;  ///< of the source with the lowest order
  int order = 2;  ///< k: the k-th derivative across the curve is the first that jumps
  ConicArc arc;   ///< in the coordinates of the receiver's frame
  /// Unit normal of the plane that all lines of sight lie in; zero where there is none.
  Vec3 sight_plane = Vec3::Zero();
  /// Jump of the k-th derivative along the unit normal, from the right of the arc to its left, at
  /// s = 1/6, 1/2 and 5/6; W/m² per length^k, of the emitter's strongest channel.
  std::array<double, 3> jump{};
  double step = 0;  ///< how far to its sides it was found that what is seen differs, scene units
  std::vector<EdgeTriple> triples;   ///< what the second derivative's jump is the sum of
  std::vector<CurveSource> sources;  ///< everything that makes a curve here, sorted
};

/// The size of the elements that the effect of a curve is judged by: the longest edge asked for, or
/// a twentieth of the receiver's size if that is 0.
inline double element_size(double receiver_size, double max_length) {
  return max_length > 0 ? std::min(max_length, receiver_size) : receiver_size / 20;
}

struct DiscontinuityOptions {
  bool contact = true, face = true, ev = true, eee = true;  ///< which events to look for
  /// Along planes of receivers that cut the emitter. Their jumps are of the third order, so that
  /// they are looked for only if `irradiance_tolerance` is 0.
  bool horizon = true;
  /// Lines of sight along which the irradiance can change by less than this (W/m²) over an element
  /// are not followed; those that can change its slope only where the source gives
  /// less than this. 0: all are.
  double irradiance_tolerance = 0;
  double max_length = 0;  ///< of the elements to come, scene units; see element_size
  /// Kinds that would take more work, as some of their lines of sight tell, are left out; about
  /// 1.5 µs on one core, shared evenly by the sources. 0: no limit.
  double most_work = 0;
};

/// How the curves came about.
struct DiscontinuityReport {
  std::size_t silhouette_edges = 0;  ///< edge–emitter pairs worth looking at
  std::size_t swaths = 0;            ///< one-parameter families of lines that could be events
  std::size_t pieces = 0;            ///< of swaths between critical lines, each decided exactly
  std::array<std::size_t, curve_kinds> found{};  ///< curves by kind, before merging
  double most_work = 0;                          ///< as DiscontinuityOptions has it
  double work = 0;                               ///< done
  std::array<double, curve_kinds>
      left_out{};            ///< work that kinds would have taken, about; 0: none is
  std::size_t merged = 0;    ///< curves that lay on others
  bool interrupted = false;  ///< stopped early: curves are missing
};

struct Discontinuities {
  std::vector<LightSource> sources;
  std::vector<DiscontinuityCurve> curves;  ///< by receiver, then in the order of `sources`
  DiscontinuityReport report;
};

/// All curves across which the irradiance from one of `sources`, or one of its first two
/// derivatives, jumps, and of the third order those across which what is seen changes. See
/// discontinuity.md. Deterministic for any number of threads.
Discontinuities find_discontinuities(const SoundScene& scene, const OpaqueScene& opaque,
                                     std::span<const LightSource> sources,
                                     const DiscontinuityOptions& options = {},
                                     const Progress& progress = {});

/// What finding the curves would take.
struct SearchForecast {
  double work = 0;    ///< as DiscontinuityOptions::most_work counts it
  double look = 0;    ///< work on seeing what is seen from a point, on average
  double curves = 0;  ///< found, before those that lie on others are merged
};

/// Told from some of the edges and vertices of surfaces `among` all, and curves on some of them, as
/// if there were no others, and from some of the sources, whatever DiscontinuityOptions::most_work
/// is; about right, to a factor of two or so. Takes as long as a small share of the search, or all
/// of it in scenes of a few dozen edges. Deterministic.
SearchForecast forecast_search(const SoundScene& scene, const OpaqueScene& opaque,
                               std::span<const LightSource> sources, std::span<const int> among,
                               const DiscontinuityOptions& options = {},
                               const Progress& progress = {});

}  // namespace halfshade
