#include "solver/exchange/ray_sequence.h"

#include "meshing/geometry/mix_bits.h"

#include <cmath>

namespace halfshade {
namespace {

/// Powers of 1/g, g the positive root of x⁵ = x + 1: the additive sequence of lowest discrepancy
/// known in four dimensions (Roberts 2018).
constexpr std::array<double, 4> steps = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                         0.5385972572236101};

double fraction(double x) { return x - std::floor(x); }

}  // namespace

RaySequence::RaySequence(std::uint64_t seed) {
  for (std::size_t d = 0; d < 4; ++d) start_[d] = unit_share(mix_bits(4 * seed + d));
}

std::array<double, 4> RaySequence::operator[](int k) const {
  std::array<double, 4> u{};
  for (std::size_t d = 0; d < 4; ++d) u[d] = fraction(start_[d] + k * steps[d]);
  return u;
}

Vec3 point_on(const std::array<Vec3, 3>& t, double u, double v) {
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

}  // namespace halfshade
