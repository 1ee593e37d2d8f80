#include "tests/support/random_scenes.h"

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace halfshade::test {
namespace {

/// Places for balls that do not touch each other, between floor and light.
class FreePlaces {
 public:
  explicit FreePlaces(std::uint64_t seed) : random(seed) {}
  Vec3 next(double radius) {
    for (;;) {
      const Vec3 centre = random.in_box({-1, -1, 0.1 + radius}, {1, 1, 1.75 - radius});
      bool is_free = true;
      for (const auto& [c, r] : taken_) is_free = is_free && (c - centre).norm() > r + radius;
      if (!is_free) continue;
      taken_.emplace_back(centre, radius);
      return centre;
    }
  }
  Random random;

 private:
  std::vector<std::pair<Vec3, double>> taken_;
};

}  // namespace

SoundScene random_polygons(std::uint64_t seed, int count) {
  FreePlaces places(seed);
  SceneMaker maker;
  maker.square_light().floor();
  for (int i = 0; i < count; ++i) {
    const double radius = places.random(0.15, 0.4);
    const Vec3 centre = places.next(radius), normal = places.random.direction();
    maker.polygon(random_polygon(places.random, centre, normal, radius));
  }
  return maker.sound();
}

SoundScene random_boxes(std::uint64_t seed, int count) {
  FreePlaces places(seed);
  SceneMaker maker;
  maker.square_light().floor();
  for (int i = 0; i < count; ++i) {
    const double size = places.random(0.1, 0.22);
    const Vec3 centre = places.next(1.75 * size);
    for (const auto& face : random_box(places.random, centre, size)) maker.polygon(face);
  }
  return maker.sound();
}

SoundScene random_tetrahedra(std::uint64_t seed, int count) {
  FreePlaces places(seed);
  SceneMaker maker;
  maker.square_light().floor();
  for (int i = 0; i < count; ++i) {
    const double radius = places.random(0.15, 0.4);
    const Vec3 centre = places.next(radius);
    for (;;) {
      std::array<Vec3, 4> p;
      for (Vec3& q : p) q = centre + radius * places.random.direction();
      const double volume = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) / 6;
      if (std::abs(volume) < 0.05 * radius * radius * radius) continue;
      maker.tetrahedron(p);
      break;
    }
  }
  return maker.sound();
}

}  // namespace halfshade::test
