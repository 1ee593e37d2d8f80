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
  constexpr std::size_t some = 3;
  if (unknown.size() <= some) return true;
  const auto before = unknown.last(some + 1).first(some);
  return 2 * unknown.back() <= std::ranges::max(before);
}

}  // namespace halfshade
