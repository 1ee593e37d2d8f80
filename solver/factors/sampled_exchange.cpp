#include "meshing/core/parallel.h"
#include "solver/factors/surface_exchange.h"
#include "solver/factors/surface_origins.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Rays of one origin, squared.
constexpr int strata = 4;
/// Standard errors that count as a bound.
constexpr double deviations = 3;

/// Where the rays of one surface end: mutual areas by row, the last two with the surroundings and
/// unused backs.
struct RayCounts {
  Eigen::ArrayXd mutual;
  std::size_t rays = 0;
};

RayCounts count_rays(const FactorScene& scene, const ReflectingScene& reflecting,
                     SurfaceOrigins places, std::size_t origins) {
  RayCounts counts{Eigen::ArrayXd::Zero(scene.rows() + 2)};
  for (std::size_t k = 0; k < origins; ++k) {
    const RayOrigin from = places.next();
    const RayHemisphere hemisphere{from, strata, places.seed()};
    const TracedHemispheres traced = trace_hemispheres(reflecting, {&hemisphere, 1});
    counts.rays += at(traced.of_each[0].rays);
    for (const RayEnd& end : traced.ends) {
      const int row = scene.row[at(reflecting.roots.surface[at(end.triangle)])];
      counts.mutual[row >= 0 ? row : row == surroundings ? scene.rows() : scene.rows() + 1] += 1;
    }
  }
  counts.mutual *= places.area() / static_cast<double>(counts.rays);
  return counts;
}

/// The two directions of each pair, each as good as the area it starts from is small.
void weigh(const FactorScene& scene, const RowMajorMatrix& from, double rays,
           RowExchange& exchange) {
  for (int i = 0; i < scene.rows(); ++i)
    for (int j = i; j < scene.rows(); ++j) {
      const double p = 1 / scene.areas[at(i)], q = 1 / scene.areas[at(j)];
      const double value = (p * from(i, j) + q * from(j, i)) / (p + q);
      // One ray more or less, where there are none or few.
      const double one = 1 / (rays * (p + q));
      exchange.mutual(i, j) = exchange.mutual(j, i) = value;
      exchange.mutual_error(i, j) = exchange.mutual_error(j, i) =
          deviations * std::sqrt(value * one + one * one);
    }
}

}  // namespace

RowExchange sampled_exchange(const FactorScene& scene, const ReflectingScene& reflecting,
                             const FactorOptions& options, const Progress& progress) {
  const std::vector<std::vector<int>> roots = roots_of_surfaces(reflecting, scene.row.size());
  std::vector<RayCounts> counts(scene.row.size());
  const auto cast = [&](std::size_t s) {
    if (scene.row[s] < 0) return;
    const double share = area(scene.sound.surfaces[s]) / scene.areas[at(scene.row[s])];
    const double origins = std::ceil(share * options.rays / (strata * strata));
    counts[s] =
        count_rays(scene, reflecting, {reflecting, roots[s], s}, static_cast<std::size_t>(origins));
  };
  RowExchange exchange(scene.rows());
  exchange.report.is_complete = parallel_for(counts.size(), cast, progress, "rays");
  if (!exchange.report.is_complete) return exchange;
  RowMajorMatrix from = RowMajorMatrix::Zero(scene.rows(), scene.rows());
  for (std::size_t s = 0; s < counts.size(); ++s) {
    const int row = scene.row[s];
    if (row < 0) continue;
    from.row(row) += counts[s].mutual.head(scene.rows()).matrix().transpose();
    exchange.add(row, surroundings, counts[s].mutual[scene.rows()], 0);
    exchange.add(row, unused_back, counts[s].mutual[scene.rows() + 1], 0);
    exchange.report.rays += counts[s].rays;
  }
  weigh(scene, from, options.rays, exchange);
  for (int i = 0; i < scene.rows(); ++i) {
    const double one = scene.areas[at(i)] / options.rays;
    exchange.space_error[i] = deviations * std::sqrt(exchange.space[i] * one + one * one);
  }
  return exchange;
}

}  // namespace halfshade
