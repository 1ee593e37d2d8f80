#include "meshing/core/parallel.h"
#include "meshing/core/plane_frame.h"
#include "solver/exchange/hemicube.h"
#include "solver/factors/surface_exchange.h"
#include "solver/factors/surface_origins.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Pixels of a row if none are asked for.
constexpr int pixels_of_row = 10000;
/// Fewer hemicubes of a surface tell nothing of how much they differ.
constexpr double fewest_cubes = 4;
/// Standard errors that count as a bound.
constexpr double cube_deviations = 3;

/// What hemicubes of one surface, or of a row of them, see: mutual areas by row, the last two with
/// the surroundings and unused backs, and the variances of these means.
struct CubeMeans {
  Eigen::ArrayXd mutual, variance;
  std::size_t cubes = 0;

  explicit CubeMeans(int columns)
      : mutual(Eigen::ArrayXd::Zero(columns)), variance(Eigen::ArrayXd::Zero(columns)) {}
};

/// Turned at random, so that pixels do not miss the same things again and again.
CubeMeans see_by_cubes(const FactorScene& scene, const ReflectingScene& reflecting,
                       const Hemicube& cube, SurfaceOrigins places, std::size_t cubes) {
  CubeMeans means(scene.rows() + 2);
  double all = 0;
  for (const double factor : cube.factors) all += factor;
  std::vector<double> factors(reflecting.roots.corners.size());
  Eigen::ArrayXd squares = means.mutual;
  for (std::size_t k = 0; k < cubes; ++k) {
    const RayOrigin from = places.next();
    const PlaneFrame frame = make_frame(from.position, from.normal);
    const double angle = 2 * std::numbers::pi * random_number(places.seed(), 2);
    std::fill(factors.begin(), factors.end(), 0.);
    add_hemicube(
        cube, {from.position, from.normal, std::cos(angle) * frame.e1 + std::sin(angle) * frame.e2},
        reflecting.visibility, reflecting.roots.normal, factors);
    Eigen::ArrayXd seen = Eigen::ArrayXd::Zero(means.mutual.size());
    for (std::size_t r = 0; r < factors.size(); ++r) {
      if (!(factors[r] > 0) || reflecting.cells.before(static_cast<int>(r)) != from.cell) continue;
      const int row = scene.row[at(reflecting.roots.surface[r])];
      seen[row >= 0              ? row
           : row == surroundings ? scene.rows()
                                 : scene.rows() + 1] += places.area() * factors[r] / all;
    }
    means.mutual += seen;
    squares += seen.square();
  }
  const auto n = static_cast<double>(cubes);
  means.cubes = cubes;
  means.mutual /= n;
  means.variance = (squares / n - means.mutual.square()).max(0) / (n - 1);
  return means;
}

}  // namespace

RowExchange hemicube_exchange(const FactorScene& scene, const ReflectingScene& reflecting,
                              const FactorOptions& options, const Progress& progress) {
  const Hemicube cube = make_hemicube(options.hemicube_pixels);
  const auto pixels = static_cast<double>(cube.factors.size());
  const int rays = options.rays > 0 ? options.rays : pixels_of_row;
  const std::vector<std::vector<int>> roots = roots_of_surfaces(reflecting, scene.row.size());
  const int rows = scene.rows();
  std::vector<CubeMeans> of_surface(scene.row.size(), CubeMeans(rows + 2));
  const auto look = [&](std::size_t s) {
    if (scene.row[s] < 0) return;
    const double share = area(scene.sound.surfaces[s]) / scene.areas[at(scene.row[s])];
    const double cubes = std::max(fewest_cubes, std::ceil(share * rays / pixels));
    of_surface[s] = see_by_cubes(scene, reflecting, cube, {reflecting, roots[s], s},
                                 static_cast<std::size_t>(cubes));
  };
  RowExchange exchange(rows);
  exchange.report.method = FactorMethod::hemicube;
  exchange.report.is_complete = parallel_for(of_surface.size(), look, progress, "hemicubes");
  if (!exchange.report.is_complete) return exchange;
  std::vector<CubeMeans> of_row(at(rows), CubeMeans(rows + 2));
  for (std::size_t s = 0; s < of_surface.size(); ++s) {
    if (scene.row[s] < 0) continue;
    CubeMeans& row = of_row[at(scene.row[s])];
    row.mutual += of_surface[s].mutual;
    row.variance += of_surface[s].variance;
    row.cubes += of_surface[s].cubes;
  }
  // A pixel more or less, where there are none or few.
  const auto error_of = [&](double variance, double one) {
    return cube_deviations * std::sqrt(variance + one * one);
  };
  for (int i = 0; i < rows; ++i) {
    const CubeMeans& here = of_row[at(i)];
    const double p = 1 / scene.areas[at(i)], one = 1 / (p * pixels * std::sqrt(here.cubes));
    exchange.report.rays += here.cubes * cube.factors.size();
    exchange.space[i] = here.mutual[rows];
    exchange.backs[i] = here.mutual[rows + 1];
    exchange.space_error[i] = error_of(here.variance[rows] + here.variance[rows + 1], one);
    for (int j = i; j < rows; ++j) {
      const CubeMeans& there = of_row[at(j)];
      const double q = 1 / scene.areas[at(j)];
      const double value = (p * here.mutual[j] + q * there.mutual[i]) / (p + q);
      const double variance =
          (p * p * here.variance[j] + q * q * there.variance[i]) / ((p + q) * (p + q));
      exchange.mutual(i, j) = exchange.mutual(j, i) = value;
      exchange.mutual_error(i, j) = exchange.mutual_error(j, i) =
          error_of(variance, 2 / ((p + q) * pixels * std::sqrt(std::min(here.cubes, there.cubes))));
    }
  }
  return exchange;
}

}  // namespace halfshade
