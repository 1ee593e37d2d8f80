#include "solver/reference/reference_light.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/reference/light_paths.h"

#include <fmt/core.h>

#include <atomic>
#include <bit>
#include <cmath>
#include <functional>

namespace halfshade {
namespace {

void check(const ReferenceOptions& options) {
  if (options.samples < 1 || options.batches < 2 || options.bounces < -1)
    throw Error(ErrorCode::contract, "reference_light",
                fmt::format("{} samples in {} batches after {} bounces are out of range",
                            options.samples, options.batches, options.bounces));
}

int samples_of_batch(const ReferenceOptions& options) {
  const auto wanted = static_cast<unsigned>((options.samples - 1) / options.batches + 1);
  return static_cast<int>(std::bit_ceil(wanted));
}

/// Applies to each part, direct, reflected and total.
template <class F>
void for_parts(F f) {
  f(&ArrivingLight::direct);
  f(&ArrivingLight::reflected);
  f(&ArrivingLight::total);
}

/// Mean and square of deviations of the means of batches, kept up to date (Welford 1962).
struct BatchStatistics {
  int count = 0;
  ArrivingLight mean, squares;

  void add(const ArrivingLight& batch) {
    ++count;
    for_parts([&](auto part) {
      const Rgb before = batch.*part - mean.*part;
      mean.*part += before / count;
      squares.*part += before * (batch.*part - mean.*part);
    });
  }

  ArrivingLight standard_error() const {
    ArrivingLight error;
    for_parts([&](auto part) { error.*part = (squares.*part / (count - 1.) / count).sqrt(); });
    return error;
  }
};

/// Where a path begins, by numbers of its own.
using Place = std::function<ReferencePoint(const SampleNumbers& numbers)>;

/// Stopped: nothing.
BatchStatistics light_at(const LightPaths& paths, const Place& place, std::uint64_t seed,
                         const ReferenceOptions& options, const Progress& progress) {
  const int samples = samples_of_batch(options);
  BatchStatistics statistics;
  for (int b = 0; b < options.batches; ++b) {
    if (progress.stopped()) return {};
    ArrivingLight mean;
    const std::uint64_t batch_seed = mix_bits(seed + static_cast<std::uint64_t>(b));
    for (int s = 0; s < samples; ++s) {
      const auto sample = static_cast<std::uint32_t>(s);
      const ReferencePoint point = place(SampleNumbers(mix_bits(batch_seed + 1), sample));
      const ArrivingLight one =
          paths.trace(point, options.bounces, SampleNumbers(batch_seed, sample));
      for_parts([&](auto part) { mean.*part += one.*part / samples; });
    }
    statistics.add(mean);
  }
  return statistics;
}

/// `place_of(k)`: where paths of the k-th value begin.
ReferenceLight light_at_all(const SoundScene& scene, std::size_t count,
                            const std::function<Place(std::size_t)>& place_of,
                            const ReferenceOptions& options, const Progress& progress) {
  check(options);
  const LightPaths paths(scene);
  ReferenceLight light;
  light.values.resize(count);
  light.standard_errors.resize(count);
  light.batches = options.batches;
  light.samples = options.batches * samples_of_batch(options);
  std::atomic<bool> each{true};
  const bool all = parallel_for(
      count,
      [&](std::size_t k) {
        const std::uint64_t seed = mix_bits(mix_bits(options.seed) + options.first + k);
        const BatchStatistics found = light_at(paths, place_of(k), seed, options, progress);
        if (found.count == 0) {
          each = false;
          return;
        }
        light.values[k] = found.mean;
        light.standard_errors[k] = found.standard_error();
      },
      progress, "reference light");
  light.complete = all && each;
  return light;
}

Vec3 doubled_area(const ReferenceTriangle& t) { return (t[1] - t[0]).cross(t[2] - t[0]); }

/// Evenly over a triangle: the half of the unit square beyond its diagonal is turned back.
ReferencePoint point_of(const ReferenceTriangle& t, const Vec2& numbers) {
  Vec2 p = numbers;
  if (p.sum() > 1) p = Vec2::Ones() - p;
  return {t[0] + p.x() * (t[1] - t[0]) + p.y() * (t[2] - t[0]), doubled_area(t).normalized()};
}

}  // namespace

ReferenceLight reference_light(const SoundScene& scene, std::span<const ReferencePoint> points,
                               const ReferenceOptions& options, const Progress& progress) {
  const auto place_of = [&](std::size_t k) -> Place {
    return [&point = points[k]](const SampleNumbers&) { return point; };
  };
  return light_at_all(scene, points.size(), place_of, options, progress);
}

ReferenceLight reference_means(const SoundScene& scene,
                               std::span<const ReferenceTriangle> triangles,
                               const ReferenceOptions& options, const Progress& progress) {
  for (std::size_t k = 0; k < triangles.size(); ++k)
    if (!(doubled_area(triangles[k]).norm() > 0))
      throw Error(ErrorCode::contract, "reference_means",
                  fmt::format("triangle {} has no area", k));
  const auto place_of = [&](std::size_t k) -> Place {
    return [&triangle = triangles[k]](const SampleNumbers& numbers) {
      return point_of(triangle, numbers.pair(0));
    };
  };
  return light_at_all(scene, triangles.size(), place_of, options, progress);
}

}  // namespace halfshade
