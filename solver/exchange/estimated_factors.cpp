#include "solver/exchange/estimated_factors.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/cosine_direction.h"
#include "solver/exchange/element_soup.h"
#include "solver/exchange/ray_sequence.h"
#include "solver/exchange/scaled_operator.h"

#include <algorithm>

namespace halfshade {
namespace {

/// Rays in all, and the least and the most of an element: who stops a program waits for them.
constexpr std::size_t all_rays = 2'000'000, least_rays = 16, most_rays = 256;

using Entries = std::vector<Eigen::Triplet<double>>;

class Estimation {
 public:
  Estimation(const SoundScene& scene, const ElementTable& elements, const SpaceCells& cells,
             const VisibilityIndex& visibility, int rays)
      : scene_(scene),
        elements_(elements),
        cells_(cells),
        visibility_(visibility),
        fronts_(element_soup(scene, elements)),
        rays_(rays) {}

  /// The elements that rays of one meet; those met twice stand there twice.
  std::vector<int> met(int e) const {
    const Surface& surface = scene_.surfaces[at(elements_.surface[at(e)])];
    const auto triangle = elements_.triangle(e);
    const RaySequence sequence(static_cast<std::uint64_t>(e));
    std::vector<int> result;
    for (int k = 0; k < rays_; ++k) {
      const auto u = sequence[k];
      const Vec3 from = point_on(triangle, u[0], u[1]);
      const Vec3 along = cosine_direction(surface.frame, u[2], u[3]);
      if (const int other = first_met(from, along, e); other >= 0) result.push_back(other);
    }
    return result;
  }

 private:
  /// −1 if there is none. Fronts of two-sided faces lie on their backs, so that the nearest
  /// front is looked for, and then whether a back comes before it.
  int first_met(const Vec3& from, const Vec3& along, int e) const {
    const auto hit = fronts_.first_hit(from, along, Sides::front_only);
    if (!hit || cells_.before(hit->owner) != cells_.before(e)) return -1;
    const Segment segment = {from, from + hit->distance * along, plane_of(e), plane_of(hit->owner)};
    return visibility_.blocked(segment) ? -1 : hit->owner;
  }

  int plane_of(int e) const { return scene_.surfaces[at(elements_.surface[at(e)])].plane; }

  const SoundScene& scene_;
  const ElementTable& elements_;
  const SpaceCells& cells_;
  const VisibilityIndex& visibility_;
  VisibilityIndex fronts_;
  int rays_;
};

ExchangeMatrix symmetric(const Entries& entries, int count) {
  ExchangeMatrix matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

EstimatedFactors estimate_factors(const SoundScene& scene, const ElementTable& elements,
                                  const SpaceCells& cells, const VisibilityIndex& visibility,
                                  const std::vector<char>& is_missing) {
  // Pairs belong to the row of their first element, so that those before are complete.
  const auto first = static_cast<std::size_t>(std::find(is_missing.begin(), is_missing.end(), 1) -
                                              is_missing.begin());
  const std::size_t count = is_missing.size() - first;
  const std::size_t rays =
      std::clamp(all_rays / std::max<std::size_t>(count, 1), least_rays, most_rays);
  const Estimation estimation(scene, elements, cells, visibility, static_cast<int>(rays));
  std::vector<std::vector<int>> met(count);
  parallel_for(count, [&](std::size_t k) { met[k] = estimation.met(static_cast<int>(first + k)); });
  Entries factors, variances;
  for (std::size_t k = 0; k < count; ++k) {
    const int i = static_cast<int>(first + k);
    const double share = 0.5 * elements.area[at(i)] / static_cast<double>(rays);
    for (const int j : met[k]) {
      if (!is_missing[at(std::min(i, j))]) continue;
      for (const auto& [row, column] : {std::pair(i, j), std::pair(j, i)}) {
        factors.emplace_back(row, column, share);
        variances.emplace_back(row, column, share * share);
      }
    }
  }
  return {symmetric(factors, elements.count()), symmetric(variances, elements.count()),
          count * rays};
}

Eigen::ArrayXd estimation_error(const Exchange& exchange, const ChannelArray& radiosity) {
  if (exchange.variance.nonZeros() == 0) return Eigen::ArrayXd::Zero(exchange.area.size());
  // Squares of light of any size must not over- or underflow.
  const double scale = radiosity.abs().maxCoeff();
  if (!(scale > 0)) return Eigen::ArrayXd::Zero(exchange.area.size());
  const Eigen::VectorXd squares = (radiosity / scale).square().rowwise().mean().matrix();
  return scale * multiply(exchange.variance, squares).array().sqrt() / exchange.area;
}

}  // namespace halfshade
