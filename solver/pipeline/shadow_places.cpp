#include "solver/pipeline/shadow_places.h"

#include "meshing/core/planar.h"
#include "solver/pipeline/middle.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Surfaces looked at in all.
constexpr double most_looks = 2e7;
/// Cosines below this count as it: grazing shadows have no end.
constexpr double least_cosine = 0.05;

/// What light from a point meets next behind another, on its front; −1 if nothing.
struct Landing {
  int surface = -1;
  double distance = 0;  ///< from the light, in units of that to the blocker
};

Landing land(const SoundScene& scene, int blocker, const Vec3& from, const Vec3& through) {
  Landing landing;
  const Vec3 along = through - from;
  for (int r = 0; r < static_cast<int>(scene.surfaces.size()); ++r) {
    const Surface& surface = scene.surfaces[at(r)];
    const double falling = -surface.frame.normal.dot(along);
    if (r == blocker || !(falling > 0)) continue;
    const double distance = surface.frame.height(from) / falling;
    if (!(distance > 1) || (landing.surface >= 0 && distance >= landing.distance)) continue;
    if (is_inside(surface.rings, surface.frame.to_plane(from + distance * along)))
      landing = {r, distance};
  }
  return landing;
}

}  // namespace

std::vector<WatchedPlace> shadow_places(const SoundScene& scene, std::span<const int> sources,
                                        std::span<const int> blocking) {
  std::vector<int> blockers(blocking.begin(), blocking.end());
  std::stable_sort(blockers.begin(), blockers.end(), [&](int a, int b) {
    return area(scene.surfaces[at(a)]) > area(scene.surfaces[at(b)]);
  });
  const double each = static_cast<double>(scene.surfaces.size()) *
                      static_cast<double>(std::max<std::size_t>(sources.size(), 1));
  const double most = std::floor(most_looks / each);
  if (static_cast<double>(blockers.size()) > most) blockers.resize(static_cast<std::size_t>(most));
  std::vector<WatchedPlace> places;
  for (const int source : sources) {
    const Vec3 from = middle(scene.surfaces[at(source)]);
    for (const int blocker : blockers) {
      if (blocker == source) continue;
      const Surface& surface = scene.surfaces[at(blocker)];
      const Vec3 through = middle(surface), along = (through - from).normalized();
      const Landing landing = land(scene, blocker, from, through);
      if (landing.surface < 0) continue;
      const Surface& receiver = scene.surfaces[at(landing.surface)];
      const double across = area(surface) * std::abs(surface.frame.normal.dot(along));
      const double cosine = std::max(std::abs(receiver.frame.normal.dot(along)), least_cosine);
      places.push_back(
          {{{from + landing.distance * (through - from), receiver.frame.normal}, landing.surface},
           across * landing.distance * landing.distance / cosine});
    }
  }
  return places;
}

}  // namespace halfshade
