#include "solver/reference/emitter_samples.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

const Rgb& exitance(const SoundScene& scene, int surface) {
  return scene.materials[at(scene.surfaces[at(surface)].material)].exitance;
}

}  // namespace

EmitterSamples::EmitterSamples(const SoundScene& scene, const TriangleSoup& soup)
    : scene_(scene), soup_(soup) {
  double sum = 0;
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    const auto& [a, b, c] = soup.triangles[t];
    const Vec3 &p = soup.points[at(a)], &q = soup.points[at(b)], &r = soup.points[at(c)];
    const double power = 0.5 * (q - p).cross(r - p).norm() * exitance(scene, soup.owner[t]).sum();
    if (power <= 0) continue;
    triangles_.push_back(static_cast<int>(t));
    power_sum_.push_back(sum += power);
  }
}

std::optional<EmitterPoint> EmitterSamples::point(const Vec2& numbers) const {
  if (triangles_.empty()) return std::nullopt;
  const double choice = numbers.x() * power_sum_.back();
  const auto found = std::upper_bound(power_sum_.begin(), power_sum_.end() - 1, choice);
  const auto place = static_cast<std::size_t>(found - power_sum_.begin());
  // What the choice leaves of the number is as even as the number itself.
  const double before = place == 0 ? 0 : power_sum_[place - 1];
  const double across = std::sqrt(std::min(1., (choice - before) / (*found - before)));
  const double along = numbers.y();
  const std::size_t triangle = at(triangles_[place]);
  const auto& [a, b, c] = soup_.triangles[triangle];
  const Vec3 &p = soup_.points[at(a)], &q = soup_.points[at(b)], &r = soup_.points[at(c)];
  const Vec3 position = (1 - across) * p + across * ((1 - along) * q + along * r);
  const int surface = soup_.owner[triangle];
  return EmitterPoint{position, surface, density(surface)};
}

double EmitterSamples::density(int surface) const {
  return triangles_.empty() ? 0 : exitance(scene_, surface).sum() / power_sum_.back();
}

}  // namespace halfshade
