#include "solver/pipeline/goal_correction.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/direct/direct_light.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace halfshade {
namespace {

/// Points to begin with, and the most of all. Rays from each, where light is gathered by rays.
constexpr std::size_t first_points = 1000, most_points = 64000;
constexpr int rays_from_point = 256;
/// Where the polynomials' z is below this share of its mean, as many points as if it were that.
constexpr double least_share = 0.1;

/// Random points of elements, and what ∫ z R is by each.
class Sampler {
 public:
  Sampler(const PreparedScene& prepared, const GoalAdjoint& adjoint, const SolvedFields& solved)
      : prepared_(prepared), adjoint_(adjoint), solved_(solved) {
    const ElementTable& elements = solved.elements;
    const ErrorWeight z = [&adjoint](int surface, const Vec3& p) {
      return adjoint.leaving(surface, p).maxCoeff();
    };
    double all = 0, area = 0;
    for (int e = 0; e < elements.count(); ++e) {
      density_.push_back(mean_weight(z, elements.surface[at(e)], elements.triangle(e)));
      all += elements.area[at(e)] * density_.back();
      area += elements.area[at(e)];
    }
    double sum = 0;
    for (int e = 0; e < elements.count(); ++e) {
      density_[at(e)] = std::max(density_[at(e)], least_share * all / area);
      passed_.push_back(sum += elements.area[at(e)] * density_[at(e)]);
    }
  }

  /// The k-th of `count` points, evenly spread along all elements; `seed` tells runs apart.
  Rgb value(std::size_t k, std::size_t count, std::uint64_t seed) const {
    const std::uint64_t own = mix_bits(seed ^ mix_bits(k));
    const double along =
        (static_cast<double>(k) + unit_share(mix_bits(own))) / static_cast<double>(count);
    const auto found = std::lower_bound(passed_.begin(), passed_.end() - 1, along * passed_.back());
    const int e = static_cast<int>(found - passed_.begin());
    const double across = std::sqrt(unit_share(mix_bits(own + 1))),
                 up = unit_share(mix_bits(own + 2));
    const TrianglePlace place(across * (1 - up), across * up);
    return passed_.back() / density_[at(e)] * term(e, place);
  }

 private:
  /// z R at a point.
  Rgb term(int e, const TrianglePlace& place) const {
    const ElementTable& elements = solved_.elements;
    const int surface = elements.surface[at(e)];
    const SurfacePoint point{position(elements.triangle(e), place), elements.normal[at(e)]};
    Rgb residual = Rgb::Zero(), clipped = Rgb::Zero();
    if (!solved_.reflected || !solved_.reflected->report().through_operator) {
      const Rgb fitted = value_at(solved_.direct, e, place);
      // Reflected light is that of direct light which is nowhere below zero.
      residual = prepared_.direct_light().irradiance(point).irradiance - fitted.max(0);
      clipped = fitted.max(0) - fitted;
    }
    if (solved_.reflected)
      residual += solved_.reflected->gather(point, rays_from_point) -
                  solved_.reflected->irradiance(surface, point.position);
    Rgb term = adjoint_.leaving_exactly(surface, point, rays_from_point) * residual;
    if (elements.group[at(e)] == adjoint_.group()) term += clipped;
    return term / adjoint_.area();
  }

  const PreparedScene& prepared_;
  const GoalAdjoint& adjoint_;
  const SolvedFields& solved_;
  std::vector<double> density_;  ///< of points, of each element
  std::vector<double> passed_;   ///< its integral up to the end of each element
};

GoalCorrection sample(const Sampler& sampler, std::size_t count, std::uint64_t seed,
                      const Progress& progress) {
  std::vector<Rgb> values(count, Rgb::Zero());
  GoalCorrection result;
  result.points = count;
  result.complete = parallel_for(
      count, [&](std::size_t k) { values[k] = sampler.value(k, count, seed); }, progress,
      "mean of the goal");
  const auto n = static_cast<double>(count);
  for (const Rgb& value : values) result.missing += value / n;
  Rgb square = Rgb::Zero();
  for (const Rgb& value : values) square += (value - result.missing).square();
  result.deviation = (square / (n * (n - 1))).sqrt();
  return result;
}

}  // namespace

GoalCorrection correct_goal(const PreparedScene& prepared, const GoalAdjoint& adjoint,
                            const SolvedFields& solved, double deviation,
                            const Progress& progress) {
  const Sampler sampler(prepared, adjoint, solved);
  const GoalCorrection first = sample(sampler, first_points, 1, progress);
  const double found = first.deviation.matrix().norm();
  if (!first.complete || found <= deviation) return first;
  constexpr double some_more = 1.2;
  const double wanted = some_more * std::pow(found / deviation, 2) * first_points;
  // Not the same points again: those chose how many there are.
  return sample(sampler, static_cast<std::size_t>(std::min<double>(wanted, most_points)), 2,
                progress);
}

}  // namespace halfshade
