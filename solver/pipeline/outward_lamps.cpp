#include "solver/pipeline/outward_lamps.h"

#include "meshing/core/tolerance.h"

#include <algorithm>

namespace halfshade {
namespace {

/// Pairs of an emitter and another surface.
constexpr std::size_t most_comparisons = 100'000'000;

bool emits(const SoundScene& scene, const Surface& surface) {
  return (scene.materials[at(surface.material)].exitance > 0).any();
}

bool is_before(const Surface& viewer, const Surface& other) {
  const double least = tolerance_of(viewer, other).length;
  const Ring& ring = other.rings.front();
  return std::any_of(ring.begin(), ring.end(), [&](const Vec2& p) {
    return viewer.frame.height(other.frame.to_space(p)) > least;
  });
}

}  // namespace

std::vector<std::string> outward_lamps(const SoundScene& scene) {
  const auto emitters = static_cast<std::size_t>(
      std::ranges::count_if(scene.surfaces, [&](const Surface& s) { return emits(scene, s); }));
  if (2 * emitters > scene.surfaces.size()) return {};
  enum : char { no_lamp, outwards, inwards };
  std::vector<char> of_group(scene.groups.size(), no_lamp);
  std::size_t pairs = 0;
  for (const Surface& lamp : scene.surfaces) {
    char& group = of_group[at(lamp.group)];
    if (group == inwards || !emits(scene, lamp)) continue;
    group = outwards;
    for (const Surface& other : scene.surfaces) {
      if (++pairs > most_comparisons) return {};
      if (!is_before(lamp, other) || !is_before(other, lamp)) continue;
      group = inwards;
      break;
    }
  }
  std::vector<std::string> names;
  for (std::size_t g = 0; g < of_group.size(); ++g)
    if (of_group[g] == outwards) names.push_back(scene.groups[g]);
  return names;
}

}  // namespace halfshade
