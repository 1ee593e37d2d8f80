#pragma once

#include "solver/adapt/noisy_field.h"

#include <array>
#include <span>
#include <vector>

namespace halfshade {

struct NoisySample {
  TrianglePlace place;
  NoisyValue value;
};

/// An element of a noisy field while it is made.
struct NoisyElement {
  std::array<Vec3, 3> triangle;
  Vec3 normal = Vec3::Zero();
  int surface = 0;
  double area = 0;
  double reach = -1;  ///< square of what light there does not exceed, as a share; < 0: not known
  double slack = 1;   ///< how many times as noisy as usual each of its samples may be
  int wanted = 0;     ///< samples
  std::vector<NoisySample> samples;
  bool is_fitted = false;
  int order = 0;
  ChannelArray coefficients = ChannelArray::Zero(1, 3);
  /// Mean square of what the polynomial cannot follow: right in the mean of many elements, so that
  /// noise makes it negative in some.
  double left = 0;
  double surely_left = 0;  ///< of it, what noise is not likely to have made; ≥ 0
  double by_chance = 0;    ///< mean square of what it is off because samples are few and noisy
  double unseen = 0;       ///< mean square of what neighbours see and too few samples here may miss
  double noise = 0;        ///< mean square of that of its samples, each the mean of two values

  /// In the mean of many elements.
  double square_error() const { return left + by_chance + unseen; }
  /// Of this one; ≥ 0.
  double known_error() const { return surely_left + by_chance + unseen; }
};

/// ∫ of that, of the noise of samples, and of what light does not exceed, over all of them.
double known_error(std::span<const NoisyElement> elements);
double sum_of_noise(std::span<const NoisyElement> elements);
double sum_of_reaches(std::span<const NoisyElement> elements);

/// What slack an element has to begin with, and its parts keep: more where it is smaller than the
/// mean.
double slack_of(const NoisyElement& element, double mean_area);

inline FieldPoint point_at(const NoisyElement& element, const TrianglePlace& place) {
  return {{position(element.triangle, place), element.normal}, element.surface};
}

Rgb value_at(const NoisyElement& element, const TrianglePlace& place);

/// Fits the order of 0 to 2 with the least error to an element's samples by least squares. What is
/// left at the samples, less what their noise is, is what the polynomial cannot follow; both
/// together, times the trace of the inverse normal matrix, are what the fit is off by chance. What
/// is below 0 at corners or middles of edges then varies less, so that it is not.
void fit(NoisyElement& element);

/// Parts of an element begin with no fewer samples.
constexpr int least_samples_of_parts = 6;

/// The samples that an element should have before it is split: more, up to 96, where too few of
/// them are what it is off by, or where light varies so little that it may be an order that is
/// missing.
int next_samples(const NoisyElement& element);

/// Sets `unseen`: an edge of a shadow seen in an element goes on in the next one, whose samples may
/// miss it.
void suspect_unseen(std::span<const std::array<int, 3>> neighbours,
                    std::span<NoisyElement> elements);

/// Gives each sample of an element to the part of it where it lies.
void share_samples(const NoisyElement& whole, std::span<const int> parts,
                   std::span<NoisyElement> elements);

}  // namespace halfshade
