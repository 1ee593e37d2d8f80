#include "solver/exchange/ray_factor.h"

#include "solver/exchange/ray_sequence.h"

namespace halfshade {
namespace {

/// How many times the rays asked for may be tried to find one.
constexpr int most_tries = 16;

}  // namespace

double RayVisibility::visible_fraction(const PairEnd& a, const PairEnd& b, int rays,
                                       std::uint64_t seed) {
  const RaySequence sequence(seed);
  segments_.clear();
  weights_.clear();
  // Where the triangles hardly face each other, most pairs of points do not: look on until one
  // does.
  for (int k = 0; k < rays || (segments_.empty() && k < most_tries * rays); ++k) {
    const std::array<double, 4> u = sequence[k];
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
