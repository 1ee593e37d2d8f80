#pragma once

#include <cstddef>

namespace halfshade {

/// What it took to see, in counts that depend on nothing but what was asked.
struct SightEffort {
  std::size_t looks = 0;        ///< at an emitter from a point
  std::size_t turns = 0;        ///< signs of how three corners run, as seen from a point
  std::size_t exact_turns = 0;  ///< those among them that took exact arithmetic
};

inline SightEffort operator-(const SightEffort& a, const SightEffort& b) {
  return {a.looks - b.looks, a.turns - b.turns, a.exact_turns - b.exact_turns};
}

inline SightEffort& operator+=(SightEffort& a, const SightEffort& b) {
  a.looks += b.looks;
  a.turns += b.turns;
  a.exact_turns += b.exact_turns;
  return a;
}

}  // namespace halfshade
