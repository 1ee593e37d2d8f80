#pragma once

#include <cstddef>

namespace halfshade {

/// What it took to see, in counts that depend on nothing but what was asked.
struct SightEffort {
  std::size_t looks = 0;        ///< at an emitter from a point
  std::size_t turns = 0;        ///< signs of how three corners run, as seen from a point
  std::size_t exact_turns = 0;  ///< those among them that took exact arithmetic
  std::size_t boxes = 0;        ///< of trees that were compared with a line or pyramid of sight
};

inline SightEffort operator-(const SightEffort& a, const SightEffort& b) {
  return {a.looks - b.looks, a.turns - b.turns, a.exact_turns - b.exact_turns, a.boxes - b.boxes};
}

inline SightEffort& operator+=(SightEffort& a, const SightEffort& b) {
  a.looks += b.looks;
  a.turns += b.turns;
  a.exact_turns += b.exact_turns;
  a.boxes += b.boxes;
  return a;
}

}  // namespace halfshade
