#include "solver/adapt/fresh_places.h"

#include "meshing/geometry/mix_bits.h"
#include "solver/elements/triangle_key.h"

#include <cmath>

namespace halfshade {
namespace {

/// Of the density of places, what has nothing to do with the estimate: half of it by area, half by
/// what light may be there.
constexpr double even_share = 0.5;

}  // namespace

FreshPlaces fresh_places(std::span<const NoisyElement> elements,
                         const AdaptiveFieldOptions& options, double expected, double count,
                         std::uint64_t draw) {
  const double reaches = sum_of_reaches(elements);
  double counted_area = 0;
  for (const NoisyElement& element : elements)
    counted_area += counts(options, element.surface) ? element.area : 0;
  const double by_area = counted_area > 0 ? even_share / 2 * expected / counted_area : 0;
  const double by_reach = reaches > 0 ? even_share / 2 * expected / reaches : 0;
  const auto density = [&](const NoisyElement& element) {  // but for a factor
    return (1 - even_share) * element.known_error() + by_reach * element.reach +
           (counts(options, element.surface) ? by_area : 0);
  };
  double sum = 0;
  for (const NoisyElement& element : elements) sum += element.area * density(element);
  FreshPlaces fresh;
  for (std::size_t e = 0; e < elements.size() && sum > 0; ++e) {
    const NoisyElement& element = elements[e];
    const double on_area = count * density(element) / sum;
    // As many as its share in the mean of such draws, whatever there is besides.
    const double chance = unit_share(mix_bits(triangle_key(element.triangle) + draw));
    const auto end =
        element.samples.size() + static_cast<std::size_t>(on_area * element.area + chance);
    const std::size_t start = first_spread(element.triangle);
    for (std::size_t k = element.samples.size(); k < end; ++k) {
      fresh.place.push_back(spread_place(start + k));
      fresh.points.push_back(point_at(element, fresh.place.back()));
      fresh.element.push_back(e);
      fresh.area.push_back(1 / on_area);
    }
  }
  return fresh;
}

void SquareError::add(const FreshPlaces& places, std::span<const NoisyValue> values,
                      std::span<NoisyElement> elements) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    NoisyElement& element = elements[places.element[k]];
    const Rgb fitted = value_at(element, places.place[k]);
    const double square = places.area[k] * ((values[k].a - fitted) * (values[k].b - fitted)).sum();
    sum_ += square;
    sum_of_squares_ += square * square;
    element.samples.push_back({places.place[k], values[k]});
  }
  ++count_;
}

double SquareError::deviation() const { return std::sqrt(sum_of_squares_) / count_; }

}  // namespace halfshade
