#pragma once

#include "meshing/conic_arc.h"
#include "meshing/core/progress.h"
#include "meshing/repair.h"
#include "meshing/visible_part.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

/// What makes a discontinuity.
enum class CurveKind : std::uint8_t {
  contact,  ///< surfaces touch or cut each other: the irradiance itself jumps
  face,  ///< the plane of a face, or of two edges, that cuts the emitter; the emitter's own plane
  ev,    ///< a vertex and an edge in line
  eee    ///< three edges in line
};

/// A part of the scene that takes part in making a curve.
struct Feature {
  enum class Kind : std::uint8_t {
    emitter_vertex,  ///< id: the emitter's corners, rings counted through
    emitter_edge,    ///< id: of the corner it starts at
    vertex,          ///< id: of the opaque scene
    edge,            ///< id: of the opaque scene
    face             ///< id: a receiver
  };
  Kind kind = Kind::vertex;
  int id = 0;
  auto operator<=>(const Feature&) const = default;
};

/// Three edges that line up at the curve, seen from its points: on each side of it they bound a
/// small triangle of the emitter. `sign` is that with which the triangle's area is part of the jump
/// of the second derivative from right to left: +1 if it is visible on the left only, or hidden on
/// the right only.
struct EdgeTriple {
  std::array<int, 3> edges{};  ///< as BoundaryPiece::edge
  int sign = 0;
  auto operator<=>(const EdgeTriple&) const = default;
};

/// One reason for a curve.
struct CurveSource {
  CurveKind kind = CurveKind::ev;
  std::array<Feature, 3> features{};
  int feature_count = 0;
  auto operator<=>(const CurveSource&) const = default;
};

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
  std::vector<EdgeTriple> triples;   ///< what the second derivative's jump is the sum of
  std::vector<CurveSource> sources;  ///< everything that makes a curve here, sorted
};

/// A polygon that sends light.
struct LightSource {
  int receiver = 0;
  double exitance = 0;  ///< of the strongest channel; W/m², > 0
};

/// The receivers with E > 0, those that send most power first.
std::vector<LightSource> light_sources(const SoundScene& scene);

/// The size of the elements that the effect of a curve is judged by: the longest edge asked for, or
/// a twentieth of the receiver's size if that is 0.
inline double element_size(double receiver_size, double max_length) {
  return max_length > 0 ? std::min(max_length, receiver_size) : receiver_size / 20;
}

struct DiscontinuityOptions {
  bool contact = true, face = true, ev = true, eee = true;  ///< which events to look for
  /// Lines of sight along which the irradiance can change by less than this (W/m²) over an element
  /// are not followed; those that can change its slope only where the source gives
  /// less than this. 0: all are.
  double irradiance_tolerance = 0;
  double max_length = 0;  ///< of the elements to come, scene units; see element_size
};

/// How the curves came about.
struct DiscontinuityReport {
  std::size_t silhouette_edges = 0;    ///< edge–emitter pairs worth looking at
  std::size_t swaths = 0;              ///< one-parameter families of lines that could be events
  std::size_t pieces = 0;              ///< of swaths between critical lines, each decided exactly
  std::array<std::size_t, 4> found{};  ///< curves by kind, before merging
  std::size_t merged = 0;              ///< curves that lay on others
  bool interrupted = false;            ///< stopped early: curves are missing
};

struct Discontinuities {
  std::vector<LightSource> sources;
  std::vector<DiscontinuityCurve> curves;  ///< by receiver, then in the order of `sources`
  DiscontinuityReport report;
};

/// All curves across which the irradiance from one of `sources`, or one of its first two
/// derivatives, jumps. See discontinuity.md. Deterministic for any number of threads.
Discontinuities find_discontinuities(const SoundScene& scene, const OpaqueScene& opaque,
                                     std::span<const LightSource> sources,
                                     const DiscontinuityOptions& options = {},
                                     const Progress& progress = {});

}  // namespace halfshade
