#include "io/picture/radiance_picture.h"

#include "io/picture/seen_mesh.h"
#include "io/picture/tone_map.h"
#include "meshing/core/error.h"

#include <numbers>

namespace halfshade {

RadiancePicture draw_radiance(const ShadedMesh& mesh, const Camera& camera,
                              const PictureOptions& options, const Progress& progress) {
  if (mesh.headlight)
    throw Error(ErrorCode::contract, "draw_radiance", "a scene without light has no radiance");
  const detail::SeenMesh seen(mesh, detail::make_view(camera, options), options.shading);
  RadiancePicture picture{options.width, options.height, {}};
  picture.radiance.assign(at(options.width) * at(options.height), Rgb::Zero());
  const auto look = [&](std::size_t pixel, std::span<const Vec3> rays) {
    Rgb sum = Rgb::Zero();
    for (const Vec3& ray : rays)
      // Polynomials may undershoot where it is dark.
      if (const auto hit = seen.cast(ray)) sum += seen.value(*hit).max(0.);
    picture.radiance[pixel] = sum / (std::numbers::pi * static_cast<double>(rays.size()));
  };
  for_each_pixel(seen.view(), options.samples, look, progress);
  return picture;
}

Picture tone_mapped(const RadiancePicture& picture, std::span<const std::uint8_t> emits,
                    double exposure) {
  const std::size_t count = picture.radiance.size();
  if (emits.size() != count)
    throw Error(ErrorCode::contract, "tone_mapped", "there is not one mark for each pixel");
  std::vector<Rgb> radiosity;
  for (const Rgb& radiance : picture.radiance) radiosity.emplace_back(std::numbers::pi * radiance);
  const std::vector<double> weights(count, 1);
  Picture result{picture.width, picture.height, exposure, {}, {}};
  if (!(exposure > 0)) result.exposure = choose_exposure(radiosity, weights, emits);
  for (const Rgb& value : radiosity) {
    const auto pixel = encode_srgb(tone_map(value, result.exposure));
    result.pixels.insert(result.pixels.end(), pixel.begin(), pixel.end());
  }
  return result;
}

}  // namespace halfshade
