#pragma once

#include "meshing/backprojection/edge_id.h"

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

namespace halfshade {

/// What makes a discontinuity.
enum class CurveKind : std::uint8_t {
  contact,  ///< surfaces touch or cut each other: the irradiance itself jumps
  face,    ///< the plane of a face, or of two edges, that cuts the emitter; the emitter's own plane
  ev,      ///< a vertex and an edge in line
  eee,     ///< three edges in line
  horizon  ///< two edges in line along the receiver's plane, which cuts the emitter
};
inline constexpr std::size_t curve_kinds = 5;

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

/// An edge of the emitter or of the opaque scene as a feature. Error(contract) for the others: a
/// cut is made by a face, which only the scene knows, and the horizon makes no curve.
Feature feature_of(EdgeId edge);

/// Three edges that line up at the curve, seen from its points: on each side of it they bound a
/// small triangle of the emitter. `sign` is that with which the triangle's area is part of the jump
/// of the second derivative from right to left: +1 if it is visible on the left only, or hidden on
/// the right only.
struct EdgeTriple {
  std::array<EdgeId, 3> edges{};
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

}  // namespace halfshade
