#include "solver/reference/traced_picture.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"

#include <fmt/core.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

void check_pixels(const CameraRays& camera, const PixelOptions& options) {
  if (!(camera.lens >= 0) || !(camera.focus > 0))
    throw Error(
        ErrorCode::contract, "trace_pixels",
        fmt::format("a lens of radius {} with its focus at {} is none", camera.lens, camera.focus));
  if (!camera.move.allFinite())
    throw Error(ErrorCode::contract, "trace_pixels", "the camera's move is not finite");
  if (camera.width < 1 || camera.height < 1 || options.samples < 1 || options.batches < 2)
    throw Error(ErrorCode::contract, "trace_pixels",
                fmt::format("{} samples in {} batches of {} x {} pixels are out of range",
                            options.samples, options.batches, camera.width, camera.height));
}

struct LensRay {
  Vec3 origin, direction;  ///< of unit length
};

/// `time`: 0 when the shutter opens, 1 when it closes.
LensRay lens_ray(const CameraRays& camera, const Vec2& pixel, const Vec2& on_lens, double time) {
  const Vec3 ray = camera.ray(pixel), origin = camera.origin + time * camera.move;
  if (!(camera.lens > 0)) return {origin, ray.normalized()};
  const double r = camera.lens * std::sqrt(on_lens.x()), angle = 2 * std::numbers::pi * on_lens.y();
  const Vec3 aside = r * (std::cos(angle) * camera.right.normalized() +
                          std::sin(angle) * camera.down.normalized());
  return {origin + aside, (camera.focus * ray - aside).normalized()};
}

/// One pixel's rays, a batch at a time.
struct PixelLook {
  const CameraRays& camera;
  const PixelOptions& options;
  const Look& look;
  int samples = 1;  ///< of a batch

  SeenLight batch(const Vec2& pixel, std::uint64_t seed) const {
    SeenLight mean;
    for (int s = 0; s < samples; ++s) {
      const auto sample = static_cast<std::uint32_t>(s);
      const SampleNumbers of_camera(mix_bits(seed + 1), sample);
      const LensRay ray =
          lens_ray(camera, pixel + of_camera.pair(0), of_camera.pair(1), of_camera.number(2));
      const SeenLight one = look(ray.origin, ray.direction, SampleNumbers(seed, sample));
      mean.radiance += one.radiance / samples;
      mean.emits = mean.emits || one.emits;
    }
    return mean;
  }
};

}  // namespace

double TracedPicture::relative_error() const {
  const bool is_all = std::find(emits.begin(), emits.end(), 0) == emits.end();
  double errors = 0, light = 0;
  for (std::size_t k = 0; k < radiance.size(); ++k) {
    if (emits[k] != 0 && !is_all) continue;
    errors += std::pow(standard_error[k].mean(), 2);
    light += std::pow(radiance[k].mean(), 2);
  }
  return light > 0 ? std::sqrt(errors / light) : 0;
}

TracedPicture trace_pixels(const CameraRays& camera, const PixelOptions& options, const Look& look,
                           const Progress& progress) {
  check_pixels(camera, options);
  const auto wanted = static_cast<unsigned>((options.samples - 1) / options.batches + 1);
  const PixelLook pixels{camera, options, look, static_cast<int>(std::bit_ceil(wanted))};
  TracedPicture picture{camera.width, camera.height, {}, {}, {}, options.batches * pixels.samples};
  const std::size_t count = at(camera.width) * at(camera.height);
  picture.radiance.assign(count, Rgb::Zero());
  picture.standard_error.assign(count, Rgb::Zero());
  picture.emits.assign(count, 0);
  const auto trace = [&](std::size_t k) {
    const std::size_t row = k / at(camera.width), column = k % at(camera.width);
    const Vec2 pixel(static_cast<double>(column), static_cast<double>(row));
    const std::uint64_t seed = mix_bits(mix_bits(options.seed) + k);
    Rgb mean = Rgb::Zero(), squares = Rgb::Zero();
    for (int b = 0; b < options.batches; ++b) {
      const SeenLight found = pixels.batch(pixel, mix_bits(seed + static_cast<std::uint64_t>(b)));
      const Rgb before = found.radiance - mean;
      mean += before / (b + 1);
      squares += before * (found.radiance - mean);
      if (found.emits) picture.emits[k] = 1;
    }
    picture.radiance[k] = mean;
    picture.standard_error[k] = (squares / (options.batches - 1.) / options.batches).sqrt();
  };
  picture.complete = parallel_for(count, trace, progress, "rays");
  return picture;
}

}  // namespace halfshade
