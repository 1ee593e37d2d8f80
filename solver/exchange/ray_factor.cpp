#include "solver/exchange/ray_factor.h"

#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Powers of 1/g, g the positive root of x⁵ = x + 1: the additive sequence of lowest discrepancy
/// known in four dimensions (Roberts 2018).
constexpr std::array<double, 4> steps = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                         0.5385972572236101};

/// How many times the rays asked for may be tried to find one.
constexpr int most_tries = 16;

double fraction(double x) { return x - std::floor(x); }

/// Maps the unit square to the triangle, area to area.
Vec3 point_on(const std::array<Vec3, 3>& t, double u, double v) {
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

}  // namespace

double RayVisibility::visible_fraction(const PairEnd& a, const PairEnd& b, int rays,
                                       std::uint64_t seed) {
  std::array<double, 4> start{};
  for (std::size_t d = 0; d < 4; ++d)
    start[d] = static_cast<double>(mix_bits(4 * seed + d) >> 11) * 0x1p-53;
  segments_.clear();
  weights_.clear();
  // Where the triangles hardly face each other, most pairs of points do not: look on until one
  // does.
  for (int k = 0; k < rays || (segments_.empty() && k < most_tries * rays); ++k) {
    std::array<double, 4> u{};
    for (std::size_t d = 0; d < 4; ++d) u[d] = fraction(start[d] + k * steps[d]);
    const Vec3 from = point_on(a.triangle, u[0], u[1]), to = point_on(b.triangle, u[2], u[3]);
    const Vec3 way = to - from;
    const double cosines = a.normal.dot(way) * -b.normal.dot(way);
    if (!(a.normal.dot(way) > 0 && cosines > 0)) continue;
    const double r2 = way.squaredNorm();
    segments_.push_back({from, to, a.plane, b.plane});
    weights_.push_back(cosines / (r2 * r2));
  }
  if (segments_.empty()) return 0;
  blocked_.resize(segments_.size());
  visibility_->blocked(segments_, blocked_);
  double all = 0, through = 0;
  for (std::size_t k = 0; k < segments_.size(); ++k) {
    all += weights_[k];
    if (!blocked_[k]) through += weights_[k];
  }
  return through / all;
}

}  // namespace halfshade
