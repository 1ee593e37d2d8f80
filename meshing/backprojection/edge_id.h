#pragma once

#include <compare>
#include <cstdint>

namespace halfshade {

/// Which straight edge bounds what a point sees of an emitter, or takes part in an event.
struct EdgeId {
  /// In the order in which ids are sorted.
  enum class Kind : std::uint8_t {
    horizon,       ///< the plane through the point that is asked about; id: 0
    emitter_edge,  ///< id: of the emitter's corner it starts at, rings counted through
    edge,          ///< id: of the opaque scene, see OpaqueScene::edge_ends
    cut            ///< where a triangle pierces the emitter's plane; id: of that triangle
  };
  Kind kind = Kind::horizon;
  int id = 0;

  static constexpr EdgeId horizon() { return {}; }
  static constexpr EdgeId emitter_edge(int id) { return {Kind::emitter_edge, id}; }
  static constexpr EdgeId edge(int id) { return {Kind::edge, id}; }
  static constexpr EdgeId cut(int triangle) { return {Kind::cut, triangle}; }

  /// The edge is part of the border of what the emitter shows above the horizon, whatever occludes
  /// it.
  constexpr bool is_of_outline() const {
    return kind == Kind::horizon || kind == Kind::emitter_edge;
  }

  bool operator==(const EdgeId&) const = default;
  /// By kind, then by id; the emitter's edges from the last to the first.
  constexpr std::strong_ordering operator<=>(const EdgeId& other) const {
    if (kind != other.kind) return kind <=> other.kind;
    return kind == Kind::emitter_edge ? other.id <=> id : id <=> other.id;
  }
};

}  // namespace halfshade
