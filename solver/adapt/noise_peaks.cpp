#include "solver/adapt/noise_peaks.h"

#include "solver/adapt/field_beginnings.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Integrals over what is lit.
struct LitSums {
  double area = 0, square = 0;
  Rgb light = Rgb::Zero();

  double peaks() const {
    const double even = light.square().sum();
    return even > 0 && square > 0 ? std::clamp(std::sqrt(square * area / even), 1., most_peaks) : 1;
  }
};

}  // namespace

double peaks_of(std::span<const NoisyElement> elements) {
  LitSums sums;
  for (const NoisyElement& element : elements) {
    const Rgb mean = element.coefficients.row(0);  // of the element: the first function is 1
    if (!(mean.sum() > 0)) continue;
    sums.area += element.area;
    sums.light += element.area * mean;
    sums.square += element.area * element.coefficients.matrix().squaredNorm();
  }
  return sums.peaks();
}

PeakPlaces peak_places(std::span<const NoisyElement> elements, int count) {
  double area = 0, reach = 0;
  for (const NoisyElement& element : elements) {
    area += element.area;
    reach += element.area * element.reach;
  }
  PeakPlaces places;
  double passed = 0;  // of the places, by the elements so far
  for (const NoisyElement& element : elements) {
    const double light = reach > 0 ? element.reach / reach : 1 / area;
    const double density = count / 2. * (1 / area + light);
    const double first = std::floor(passed + 0.5);
    passed += density * element.area;
    const std::size_t start = first_spread(element.triangle);
    for (std::size_t k = 0; first + static_cast<double>(k) < std::floor(passed + 0.5); ++k) {
      places.points.push_back(point_at(element, spread_place(start + k)));
      places.area.push_back(1 / density);
    }
  }
  return places;
}

FirstLook first_look(const PeakPlaces& places, std::span<const NoisyValue> values) {
  LitSums sums;
  FirstLook look;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double square = places.area[k] * values[k].square();
    look.noise += places.area[k] * values[k].noise();
    look.square += square;
    const Rgb mean = values[k].mean();
    if (!(mean.sum() > 0)) continue;
    sums.area += places.area[k];
    sums.light += places.area[k] * mean;
    sums.square += square;
  }
  look.peaks = sums.peaks();
  return look;
}

}  // namespace halfshade
