#include "solver/adapt/wanted_samples.h"

#include "solver/adapt/field_beginnings.h"

#include <algorithm>

namespace halfshade {

WantedSamples wanted_samples(std::span<const NoisyElement> elements, double noise) {
  WantedSamples all;
  for (int e = 0; e < static_cast<int>(elements.size()); ++e) {
    const NoisyElement& element = elements[at(e)];
    if (element.is_fitted && element.samples.size() >= at(element.wanted)) continue;
    all.elements.push_back(e);
    all.first.push_back(all.places.size());
    const std::size_t start = first_spread(element.triangle);
    for (std::size_t k = element.samples.size(); k < at(element.wanted); ++k) {
      all.places.push_back(spread_place(start + k));
      all.points.push_back(point_at(element, all.places.back()));
    }
    all.slack.resize(all.points.size(), noise * element.slack);
  }
  all.first.push_back(all.places.size());
  return all;
}

WantedSamples some_of(const WantedSamples& all, std::size_t count) {
  WantedSamples some;
  count = std::min(count, all.points.size());
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = k * all.points.size() / count;
    some.points.push_back(all.points[i]);
    some.slack.push_back(all.slack[i]);
  }
  return some;
}

}  // namespace halfshade
