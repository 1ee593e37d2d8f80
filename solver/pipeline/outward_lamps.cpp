#include "solver/pipeline/outward_lamps.h"

#include "meshing/core/light_source.h"
#include "meshing/core/tolerance.h"

#include <algorithm>

namespace halfshade {
namespace {

/// Pairs of an emitter and another surface.
constexpr std::size_t most_comparisons = 100'000'000;

bool is_before(const Surface& viewer, const Surface& other) {
  const double least = tolerance_of(viewer, other).length;
  const Ring& ring = other.rings.front();
  return std::any_of(ring.begin(), ring.end(), [&](const Vec2& p) {
    return viewer.frame.height(other.frame.to_space(p)) > least;
  });
}

}  // namespace

std::vector<std::string> outward_lamps(const SoundScene& scene) {
  const std::vector<LightSource> sources = light_sources(scene);
  if (2 * sources.size() > scene.surfaces.size()) return {};
  enum : char { no_lamp, outwards, inwards };
  std::vector<char> of_group(scene.groups.size(), no_lamp);
  std::size_t pairs = 0;
  for (const LightSource& source : sources) {
    const Surface& lamp = scene.surfaces[at(source.surface)];
    char& group = of_group[at(lamp.group)];
    if (group == inwards) continue;
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
