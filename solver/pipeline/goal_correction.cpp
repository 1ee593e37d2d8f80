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

/// What a point contributes.
struct Term {
  int element = 0;
  Rgb value = Rgb::Zero();
};

/// Random points of elements, and what ∫ z R is by each.
class Sampler {
 public:
  Sampler(const PreparedScene& prepared, const GoalAdjoint& adjoint, const SolvedFields& solved)
      : prepared_(prepared), adjoint_(adjoint), solved_(solved) {
    const ElementTable& elements = solved.elements;
    const ErrorWeight z = [&adjoint](int surface, const Vec3& p) {
      return adjoint.leaving(surface, p).maxCoeff();
    };
    double all = 0, area = 0, light = 0;
    for (int e = 0; e < elements.count(); ++e) {
      area += elements.area[at(e)];
      light += elements.area[at(e)] * brightness(e);
    }
    for (int e = 0; e < elements.count(); ++e) {
      // What is bright is off by more.
      const double bright = light > 0 ? std::max(1., brightness(e) * area / light) : 1;
      density_.push_back(bright * mean_weight(z, elements.surface[at(e)], elements.triangle(e)));
      all += elements.area[at(e)] * density_.back();
    }
    double sum = 0;
    for (int e = 0; e < elements.count(); ++e) {
      density_[at(e)] = std::max(density_[at(e)], least_share * all / area);
      passed_.push_back(sum += elements.area[at(e)] * density_[at(e)]);
    }
  }

  /// The k-th of `count` points, evenly spread along all elements; `seed` tells runs apart.
  Term term(std::size_t k, std::size_t count, std::uint64_t seed) const {
    const std::uint64_t own = mix_bits(seed ^ mix_bits(k));
    const double along =
        (static_cast<double>(k) + unit_share(mix_bits(own))) / static_cast<double>(count);
    const auto found = std::lower_bound(passed_.begin(), passed_.end() - 1, along * passed_.back());
    const int e = static_cast<int>(found - passed_.begin());
    const double across = std::sqrt(unit_share(mix_bits(own + 1))),
                 up = unit_share(mix_bits(own + 2));
    const TrianglePlace place(across * (1 - up), across * up);
    return {e, passed_.back() / density_[at(e)] * term(e, place)};
  }

 private:
  /// Irradiance in the middle of an element, as the solution has it.
  double brightness(int e) const {
    const auto [a, b, c] = solved_.elements.triangle(e);
    const TrianglePlace middle(1. / 3, 1. / 3);
    return solution(e, middle, solved_.elements.surface[at(e)], (a + b + c) / 3).maxCoeff();
  }

  bool is_direct_apart() const {
    return !solved_.reflected || !solved_.reflected->report().through_operator;
  }

  /// All irradiance. Reflected light is that of direct light which is nowhere below zero.
  Rgb solution(int e, const TrianglePlace& place, int surface, const Vec3& position) const {
    Rgb sum = Rgb::Zero();
    if (is_direct_apart()) sum += value_at(solved_.direct, e, place).max(0);
    if (solved_.reflected) sum += solved_.reflected->irradiance(surface, position);
    return sum;
  }

  /// What leaves a point more than what stands for it where light is gathered.
  Rgb not_gathered(int e, const TrianglePlace& place, int surface, const Vec3& position) const {
    if (!solved_.reflected) return Rgb::Zero();
    const auto gathered = solved_.reflected->gathered_from(surface, position);
    if (!gathered) return Rgb::Zero();
    const SoundScene& scene = prepared_.scene();
    const Surface& here = scene.surfaces[at(surface)];
    Rgb leaving = reflectance_at(scene, here, position) * solution(e, place, surface, position);
    if (!is_direct_apart()) leaving += scene.materials[at(here.material)].exitance;
    return leaving - *gathered;
  }

  /// z R at a point, with what arrives there of z times what leaves it and is not gathered: that is
  /// missing in R elsewhere.
  Rgb term(int e, const TrianglePlace& place) const {
    const ElementTable& elements = solved_.elements;
    const int surface = elements.surface[at(e)];
    const PlaneFrame& frame = prepared_.scene().surfaces[at(surface)].frame;
    const SurfacePoint point{frame.foot(position(elements.triangle(e), place)),
                             elements.normal[at(e)]};
    Rgb residual = Rgb::Zero(), clipped = Rgb::Zero();
    if (is_direct_apart()) {
      const Rgb fitted = value_at(solved_.direct, e, place);
      residual = prepared_.direct_light().irradiance(point).irradiance - fitted.max(0);
      clipped = fitted.max(0) - fitted;
    }
    if (solved_.reflected)
      residual += solved_.reflected->gather_on(surface, point.position, rays_from_point) -
                  solved_.reflected->irradiance(surface, point.position);
    const GoalAdjoint::Importance z = adjoint_.exactly(surface, point, rays_from_point);
    Rgb term = z.leaving * residual + z.arriving * not_gathered(e, place, surface, point.position);
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
  std::vector<Term> terms(count);
  GoalCorrection result;
  result.points = count;
  result.complete = parallel_for(
      count, [&](std::size_t k) { terms[k] = sampler.term(k, count, seed); }, progress,
      "mean of the goal");
  const auto n = static_cast<double>(count);
  // Those of an element follow each other.
  Rgb of_element = Rgb::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    result.missing += terms[k].value / n;
    of_element += terms[k].value / n;
    if (k + 1 < count && terms[k + 1].element == terms[k].element) continue;
    result.moved += of_element.abs();
    of_element.setZero();
  }
  Rgb square = Rgb::Zero();
  for (const Term& term : terms) square += (term.value - result.missing).square();
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
