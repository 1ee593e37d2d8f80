#include "solver/factors/body_pairs.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace halfshade {
namespace {

/// Fewer sides of a body that something may come between are looked at one by one.
constexpr std::size_t worth_a_body = 6;

}  // namespace

std::vector<std::vector<int>> sides_of_bodies(const FactorScene& scene, const SightScene& sight) {
  std::vector<std::vector<int>> sides(sight.bodies.size());
  std::vector<char> has_several(sight.bodies.size(), 0);
  for (int s = 0; s < static_cast<int>(sight.surfaces.size()); ++s) {
    const int body = body_with(sight, s);
    if (body < 0) continue;
    if (!sides[at(body)].empty() && scene.row[at(sides[at(body)].front())] != scene.row[at(s)])
      has_several[at(body)] = 1;
    sides[at(body)].push_back(s);
  }
  for (std::size_t b = 0; b < sides.size(); ++b)
    if (has_several[b] != 0) sides[b].clear();
  return sides;
}

std::vector<JoinedPairs> find_body_pairs(const SightScene& sight,
                                         const std::vector<std::vector<SightPair>>& pairs,
                                         const std::vector<std::vector<int>>& sides) {
  const auto sides_round = [&](int surface) {
    const int body = body_with(sight, surface);
    return body < 0 ? 0 : sides[at(body)].size();
  };
  // The one that looks, and the body of the other: that with more sides.
  const auto looks_at = [&](int a, int b) {
    const bool is_swapped = sides_round(a) > sides_round(b);
    return std::array{is_swapped ? b : a, is_swapped ? a : b};
  };
  std::map<std::pair<int, int>, JoinedPairs> found;
  for (int a = 0; a < static_cast<int>(pairs.size()); ++a)
    for (std::size_t k = 0; k < pairs[at(a)].size(); ++k) {
      const auto [looking, seen] = looks_at(a, pairs[at(a)][k].other);
      if (pairs[at(a)][k].sight != Sight::partial || sides_round(seen) < worth_a_body) continue;
      JoinedPairs& joined = found[{looking, body_with(sight, seen)}];
      joined.parts.push_back({a, k});
    }
  std::erase_if(found, [](const auto& one) { return one.second.parts.size() < worth_a_body; });
  if (found.empty()) return {};
  for (int a = 0; a < static_cast<int>(pairs.size()); ++a)
    for (const SightPair& pair : pairs[at(a)]) {
      const auto [looking, seen] = looks_at(a, pair.other);
      if (pair.sight != Sight::clear || sides_round(seen) < worth_a_body) continue;
      const auto joined = found.find({looking, body_with(sight, seen)});
      if (joined == found.end()) continue;
      // Of a side that is clear in cells alone something is hidden.
      if (pair.is_in_cells)
        found.erase(joined);
      else
        joined->second.whole.clear.push_back(seen);
    }
  std::vector<JoinedPairs> result;
  for (auto& [key, joined] : found) {
    joined.whole.surface = key.first;
    joined.whole.body = key.second;
    std::sort(joined.whole.clear.begin(), joined.whole.clear.end());
    result.push_back(std::move(joined));
  }
  return result;
}

}  // namespace halfshade
