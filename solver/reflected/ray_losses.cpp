#include "solver/reflected/ray_losses.h"

#include "meshing/core/parallel.h"
#include "solver/elements/polynomial.h"
#include "solver/reflected/near_slits.h"
#include "solver/reflected/ray_exchange.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr double rule_of_three = 3;
/// Rays in each half from a place: few, for nearly all places are away from slits.
constexpr int strata = 2, rays_of_place = 2 * strata * strata;
/// Places in each pass, and passes at least, to know deviations from.
constexpr double places_at_once = 4096;
constexpr int fewest_passes = 8;
constexpr std::size_t most_rays = std::size_t{1} << 24;
/// What nodes miss is more than noise from so many deviations on.
constexpr double deviations_of_noise = 3;
/// Along a slit as wide as a share x of an element's size, this times x is missed, or more.
constexpr double missed_of_width = 0.4;
/// Numbers from here on are of no node, see ray_seed.
constexpr int first_place = 64;

/// Spreads evenly over the triangle, whatever part of the sequence is looked at (Roberts 2018).
TrianglePlace spread_place(std::uint64_t seed, std::size_t k) {
  constexpr double across = 0.7548776662466927, along = 0.5698402909980532;
  const auto share = [&](std::uint64_t which, double step) {
    const double x = random_number(seed, which) + static_cast<double>(k) * step;
    return x - std::floor(x);
  };
  const double u = share(1, across), v = share(2, along);
  return u + v <= 1 ? TrianglePlace(u, v) : TrianglePlace(1 - u, 1 - v);
}

/// Sums of values and squares of n of them.
struct Sums {
  double n = 0, sum = 0, squares = 0;

  void add(double x) {
    ++n;
    sum += x;
    squares += x * x;
  }
  double mean() const { return sum / n; }
  /// Of the mean.
  double deviation() const {
    return std::sqrt(std::max(squares / n - mean() * mean(), 0.) / std::max(n - 1, 1.));
  }
};

class LossSearch {
 public:
  LossSearch(const ReflectingScene& scene, const FirstLight& light, const ReflectedMesh& mesh,
             const LightSystems& systems, const std::vector<Eigen::VectorXd>& told)
      : scene_(scene),
        mesh_(mesh),
        systems_(systems),
        told_(told),
        absorbed_(Eigen::ArrayXd::Zero(systems.count())) {
    double area = 0;
    for (int e = 0; e < mesh.count(); ++e) {
      const int s = systems.of_element[at(e)];
      const Rgb rho = light.mean_rho(mesh, e);
      absorbed_[s] += mesh.area(e) * (1 - rho.maxCoeff());
      if (systems.closed[at(s)] || !(rho.maxCoeff() > bright) || !mesh.counts(e)) continue;
      elements_.push_back(e);
      area += mesh.area(e);
    }
    for (const int e : elements_)
      places_.push_back(at(static_cast<int>(std::ceil(places_at_once * mesh.area(e) / area))));
    of_element_.resize(elements_.size());
    of_system_.resize(at(systems.count()));
  }

  const std::vector<int>& elements() const { return elements_; }
  const Sums& of(std::size_t i) const { return of_element_[i]; }
  std::size_t rays() const { return rays_; }
  /// From an element.
  double rays(std::size_t i) const {
    return static_cast<double>(static_cast<std::size_t>(passes_) * places_[i]) * rays_of_place;
  }

  /// Of what is lost in a system in all, over its area.
  double deviation(int s) const {
    const Sums& sums = of_system_[at(s)];
    return sums.n > 0 ? sums.deviation() / systems_.area[s] : 0;
  }

  void run(double enough, const Progress& progress) {
    if (elements_.empty()) return;
    std::vector<double> missed(elements_.size());
    do {
      if (!pass(missed, progress)) return;
      std::vector<double> sums(of_system_.size(), 0);
      for (std::size_t i = 0; i < elements_.size(); ++i) {
        sums[at(systems_.of_element[at(elements_[i])])] += mesh_.area(elements_[i]) * missed[i];
        of_element_[i].add(missed[i]);
      }
      for (std::size_t s = 0; s < sums.size(); ++s) of_system_[s].add(sums[s]);
      ++passes_;
    } while (passes_ < fewest_passes || (rays_ < most_rays && !is_known(enough)));
  }

 private:
  bool pass(std::vector<double>& missed, const Progress& progress) {
    std::size_t places = 0;
    for (const std::size_t n : places_) places += n;
    rays_ += places * rays_of_place;
    return parallel_for(
        elements_.size(), [&](std::size_t i) { missed[i] = missed_by_nodes(i); }, progress,
        "light that gets lost");
  }

  /// In the mean over an element, by the places of the next pass.
  double missed_by_nodes(std::size_t i) const {
    const int e = elements_[i];
    const std::uint64_t seed = ray_seed(mesh_, e, first_place, 0);
    const std::size_t n = places_[i], first = static_cast<std::size_t>(passes_) * n;
    std::vector<RayHemisphere> halves;
    for (std::size_t k = first; k < first + n; ++k) {
      const RayOrigin origin = ray_origin(scene_, mesh_, e, spread_place(seed, k));
      const int number = first_place + 1 + static_cast<int>(k);
      for (const int use : {0, 1})
        halves.push_back({origin, strata, ray_seed(mesh_, e, number, use)});
    }
    const TracedHemispheres traced = trace_hemispheres(scene_, halves);
    const auto seen = [&](std::size_t h) {
      return static_cast<double>(traced.ends_of(h).size()) / (strata * strata);
    };
    const int order = mesh_.order[at(mesh_.triangle[at(e)])];
    Eigen::VectorXd basis(basis_size(order));
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      basis_at(order, spread_place(seed, first + k), basis);
      const double told = basis.dot(told_[at(e)]), one = seen(2 * k), other = seen(2 * k + 1);
      sum += one * other - told * (one + other) / 2;
    }
    return sum / static_cast<double>(n);
  }

  bool is_known(double enough) const {
    Eigen::ArrayXd lost = absorbed_;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const int e = elements_[i];
      lost[systems_.of_element[at(e)]] +=
          mesh_.area(e) * (1 - told_[at(e)][0] - of_element_[i].mean());
    }
    for (int s = 0; s < systems_.count(); ++s)
      if (deviation(s) * systems_.area[s] > enough * std::max(lost[s], 0.)) return false;
    return true;
  }

  const ReflectingScene& scene_;
  const ReflectedMesh& mesh_;
  const LightSystems& systems_;
  const std::vector<Eigen::VectorXd>& told_;
  Eigen::ArrayXd absorbed_;
  std::vector<int> elements_;        ///< those that are looked at
  std::vector<std::size_t> places_;  ///< of each in a pass
  std::vector<Sums> of_element_, of_system_;
  std::size_t rays_ = 0;
  int passes_ = 0;
};

/// Empty where it may be noise.
BackShadow shadow_of(const Sums& missed, double size) {
  BackShadow shadow;
  if (std::abs(missed.mean()) <= deviations_of_noise * missed.deviation()) return shadow;
  shadow.share = missed.mean();
  const double width = std::abs(shadow.share) / missed_of_width;
  shadow.height = width * size;
  shadow.unsure = unsure_part_of_slit(width);
  return shadow;
}

}  // namespace

RayLosses find_losses(const ReflectingScene& scene, const FirstLight& light,
                      const ReflectedMesh& mesh, const LightSystems& systems,
                      std::vector<Eigen::VectorXd> told, const std::vector<double>& cast,
                      double enough, const Progress& progress) {
  LossSearch search(scene, light, mesh, systems, told);
  search.run(enough, progress);
  RayLosses losses;
  losses.seen = std::move(told);
  losses.shadow.resize(at(mesh.count()));
  losses.unsure.assign(at(mesh.count()), 0);
  losses.rays = search.rays();
  std::vector<double> all(at(systems.count()), 0);  // rays of each system
  for (int e = 0; e < mesh.count(); ++e) all[at(systems.of_element[at(e)])] += cast[at(e)];
  for (std::size_t i = 0; i < search.elements().size(); ++i) {
    const int e = search.elements()[i];
    losses.seen[at(e)][0] += search.of(i).mean();
    losses.shadow[at(e)] = shadow_of(search.of(i), std::sqrt(mesh.area(e)));
    all[at(systems.of_element[at(e)])] += search.rays(i);
  }
  for (int e = 0; e < mesh.count(); ++e) {
    const int s = systems.of_element[at(e)];
    if (!systems.closed[at(s)])
      losses.unsure[at(e)] = rule_of_three / all[at(s)] + 2 * search.deviation(s);
  }
  return losses;
}

}  // namespace halfshade
