#include "solver/pipeline/shadow_places.h"

#include "meshing/core/planar.h"
#include "solver/pipeline/middle.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace halfshade {
namespace {

/// Surfaces looked at in all.
constexpr double most_looks = 2e7;
/// Of places in all: beyond them, those of middles only.
constexpr std::size_t many_places = 4000;
/// So far from the middle of blockers towards their corners: to share out their shadow.
constexpr double half_way = 0.513;
/// The mean square of what a penumbra takes away, over the square of it in the middle: 4/3 of
/// ramps, and places are few. And only half of a source is seen over the edge of a wall that stands
/// below.
constexpr double mean_square = 1.5, over_an_edge = 2;
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

/// The place behind a point of a blocker that a point of light makes; none if nothing is there.
std::optional<WatchedPlace> shadow_place(const SoundScene& scene, const Vec3& from, int blocker,
                                         const Vec3& through) {
  const Landing landing = land(scene, blocker, from, through);
  if (landing.surface < 0) return std::nullopt;
  const Surface &surface = scene.surfaces[at(blocker)],
                &receiver = scene.surfaces[at(landing.surface)];
  const Vec3 along = (through - from).normalized();
  const double across = area(surface) * std::abs(surface.frame.normal.dot(along));
  const double cosine = std::max(std::abs(receiver.frame.normal.dot(along)), least_cosine);
  return WatchedPlace{
      {{from + landing.distance * (through - from), receiver.frame.normal}, landing.surface},
      across * landing.distance * landing.distance / cosine};
}

}  // namespace

std::vector<WatchedPlace> shadow_places(const SoundScene& scene, std::span<const int> sources,
                                        std::span<const int> blocking) {
  std::vector<int> blockers(blocking.begin(), blocking.end());
  std::stable_sort(blockers.begin(), blockers.end(), [&](int a, int b) {
    return area(scene.surfaces[at(a)]) > area(scene.surfaces[at(b)]);
  });
  const double each =
      static_cast<double>(scene.surfaces.size() * std::max<std::size_t>(sources.size(), 1));
  constexpr std::size_t around = (1 + 4) * (1 + 4);  // of most surfaces
  const bool only_middles = blockers.size() * sources.size() * around > many_places;
  const double most = std::floor(most_looks / each / (only_middles ? 1 : around));
  if (static_cast<double>(blockers.size()) > most) blockers.resize(static_cast<std::size_t>(most));
  const auto points_of = [&](int id, double towards) {
    const Surface& surface = scene.surfaces[at(id)];
    return only_middles ? std::vector{middle(surface)} : middle_and_around(surface, towards);
  };
  std::vector<WatchedPlace> places;
  for (const int source : sources) {
    const std::vector<Vec3> ends = points_of(source, towards_corner);
    for (const int blocker : blockers) {
      if (blocker == source) continue;
      const std::vector<Vec3> throughs = points_of(blocker, half_way);
      const double share = mean_square *
                           std::min(over_an_edge / static_cast<double>(ends.size()), 1.) /
                           static_cast<double>(throughs.size());
      for (const Vec3& through : throughs)
        for (const Vec3& from : ends)
          if (auto place = shadow_place(scene, from, blocker, through)) {
            place->area *= share;
            places.push_back(*place);
          }
    }
  }
  return places;
}

}  // namespace halfshade
