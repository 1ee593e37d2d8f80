#include "solver/adapt/watched_errors.h"

#include "solver/elements/element_lookup.h"

#include <algorithm>
#include <map>
#include <utility>

namespace halfshade {

std::unordered_map<int, WatchedError> watched_errors(
    const ElementTable& elements, std::span<const WatchedPlace> watched,
    std::span<const Rgb> values,
    const std::function<Rgb(int element, const TrianglePlace& place)>& fitted) {
  std::unordered_map<int, WatchedError> errors;
  std::map<std::pair<int, int>, double> groups;  // element and group → the most it tells so far
  const ElementLookup lookup(elements);
  for (std::size_t k = 0; k < watched.size(); ++k) {
    const FieldPoint& point = watched[k].place;
    const ForestPlace found = lookup.find(point.surface, point.point.position);
    if (found.triangle < 0) continue;
    WatchedError& error = errors[found.triangle];
    ++error.places;
    const double square = std::min(watched[k].area / elements.area[at(found.triangle)], 1.) *
                          (values[k] - fitted(found.triangle, found.place)).square().sum();
    double known = 0;
    if (watched[k].group >= 0) {
      double& most = groups[{found.triangle, watched[k].group}];
      known = std::exchange(most, std::max(most, square));
    }
    error.square += std::max(square - known, 0.);
  }
  return errors;
}

}  // namespace halfshade
