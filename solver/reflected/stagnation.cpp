#include "solver/reflected/stagnation.h"

#include <algorithm>
#include <cstddef>

namespace halfshade {

bool is_stagnant(std::span<const RoundError> rounds) {
  constexpr int many_times = 8;
  constexpr double hardly_less = 0.7;
  if (rounds.empty()) return false;
  const RoundError& last = rounds.back();
  return std::ranges::any_of(rounds, [&](const RoundError& round) {
    return many_times * round.elements <= last.elements && last.error > hardly_less * round.error;
  });
}

bool is_falling(std::span<const double> unknown) {
  const std::size_t n = unknown.size();
  return n < 2 || 2 * unknown[n - 1] <= unknown[n - 2];
}

}  // namespace halfshade
