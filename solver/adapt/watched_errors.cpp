#include "solver/adapt/watched_errors.h"

#include "solver/elements/element_lookup.h"

#include <algorithm>

namespace halfshade {

std::unordered_map<int, WatchedError> watched_errors(
    const ElementTable& elements, std::span<const WatchedPlace> watched,
    std::span<const Rgb> values,
    const std::function<Rgb(int element, const TrianglePlace& place)>& fitted) {
  std::unordered_map<int, WatchedError> errors;
  const ElementLookup lookup(elements);
  for (std::size_t k = 0; k < watched.size(); ++k) {
    const FieldPoint& point = watched[k].place;
    const ForestPlace found = lookup.find(point.surface, point.point.position);
    if (found.triangle < 0) continue;
    WatchedError& error = errors[found.triangle];
    ++error.places;
    error.square += std::min(watched[k].area / elements.area[at(found.triangle)], 1.) *
                    (values[k] - fitted(found.triangle, found.place)).square().sum();
  }
  return errors;
}

}  // namespace halfshade
