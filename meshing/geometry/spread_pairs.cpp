#include "meshing/geometry/spread_pairs.h"

#include "meshing/geometry/mix_bits.h"

#include <cmath>

namespace halfshade {
namespace {

double step(double from, double width) {
  const double to = from + width;
  return to < 1 ? to : to - 1;
}

}  // namespace

SpreadPairs::SpreadPairs(std::uint64_t seed)
    : s_(unit_share(mix_bits(seed))), t_(unit_share(mix_bits(seed + splitmix_step))) {}

std::array<double, 2> SpreadPairs::next() {
  constexpr double root = 1.32471795724474602596;  // of x³ = x + 1
  s_ = step(s_, 1 / root);
  t_ = step(t_, 1 / (root * root));
  return {s_, t_};
}

Vec3 point_of(const std::array<Vec3, 3>& triangle, double s, double t) {
  const auto& [a, b, c] = triangle;
  return a + std::sqrt(s) * (b - a + t * (c - b));
}

}  // namespace halfshade
