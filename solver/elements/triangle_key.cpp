#include "solver/elements/triangle_key.h"

#include "meshing/geometry/mix_bits.h"

#include <cmath>

namespace halfshade {
namespace {

/// Of places and directions, which are at most 1; somewhere between two steps there is nothing that
/// scenes are likely to have.
constexpr double steps_of_place = 0x1p24, steps_of_direction = 0x1p8, between = 0.3719;

void mix_in(std::uint64_t& key, double x, double steps) {
  key = mix_bits(key ^ static_cast<std::uint64_t>(std::llround(x * steps + between)));
}

}  // namespace

std::uint64_t triangle_key(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  const Vec3 middle = (a + b + c) / 3;
  const Vec3 way = (b - a) / (b - a).norm();
  const Vec3 up = way.cross(c - a);  // as long as the triangle is high
  const double far_away = middle.norm() + (b - a).norm();
  std::uint64_t key = 0;
  for (int k = 0; k < 3; ++k) {
    mix_in(key, middle[k] / far_away, steps_of_place);
    mix_in(key, up[k] / up.norm(), steps_of_direction);
  }
  return key;
}

}  // namespace halfshade
