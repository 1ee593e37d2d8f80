#include "solver/reflected/near_factors.h"

#include "meshing/core/parallel.h"
#include "solver/exchange/form_factor.h"
#include "solver/reflected/near_backs.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Gaps up to this share of an element's size are near; where little is reflected, so that points
/// see all that is wrong, only narrower ones, by what is absorbed.
constexpr double nearest = 0.5, nearest_black = 0.05;
constexpr double factor_tolerance = 1e-7;
/// Elements as long as this many gaps have nodes where light gets lost.
constexpr double seen_gaps = 3;
constexpr double least_gap = 1e-9;  // of an element's size
/// Of elements longer than this many gaps between surfaces that absorb less than that, errors over
/// a part, as along a border, are reflected on there: with .9 at 36 gaps they were 1.2 times as
/// large as claimed, at 18 less than that.
constexpr double long_gaps = 24, hardly_absorbed = 0.25, grow_within = 1.5;
/// At most so many times the gap's share of an element's size gets lost. Where that is less than
/// this share of what is absorbed anyway, it is not worth a closed form.
constexpr double lost_at_most = 4, hardly_lost = 1e-5;

/// Looks at backs before an element, times the tolerance and the share that it absorbs: what is
/// left then counts as missed, and hardly adds to the error. At 5 % those of a chair that reflects
/// .9 take 1 s of CPU time, and all that NearBacks would look at 50.
constexpr double looks_at_backs = 5, fewest_looks = 300;

/// Where light gets lost, less leaves than in the mean over an element: so much of what nodes miss
/// does get lost, at most, where both sides together reflect ρ and `gap` is relative to the
/// element. Random walks between plates 1e-3 of their size apart lose, for ρ = .3, .5, .7, .9, .97,
/// .99, .999, .95, .78, .73, .56, .37, .24, .10 of it: deep in such a gap light falls off as in a
/// scattering half space, by √(1 − ρ); in wider ones less, .49 for .97 at .03, .23 for .999 at .01.
Rgb share_lost(const Rgb& rho, double gap) {
  const Rgb s = ((1 - rho).max(0) + std::pow(6 * gap, 2)).sqrt();
  return (4 * s / (1 + 3 * s)).min(1);
}

class GapSearch {
 public:
  GapSearch(const ReflectedSystem& system, const ReflectingScene& scene)
      : system_(system), scene_(scene) {
    const std::vector<int>& surface = system.light.surface;
    for (std::size_t r = 0; r < surface.size(); ++r) {
      if (at(surface[r]) >= roots_.size()) roots_.resize(at(surface[r]) + 1);
      roots_[at(surface[r])].push_back(static_cast<int>(r));
    }
  }

  /// Without what backs before the element hide.
  UnsureLoss operator()(int element) const {
    UnsureLoss loss;
    const auto& [mesh, light, exchange, systems] = system_;
    const Rgb rho = light.mean_rho(mesh, element);
    const double size = std::sqrt(mesh.area(element));
    for (const int surface : seen_surfaces(element)) {
      const Rgb both = (rho * light.rho[at(roots_[at(surface)].front())]).sqrt();
      const double height = gap(element, size, surface);
      const double absorbed = std::max(1 - both.maxCoeff(), 0.);
      if (height < 0 || height * absorbed > nearest_black * size ||
          lost_at_most * height < hardly_lost * absorbed * size)
        continue;
      loss.factor += share_lost(both, height / size) * std::abs(missed(element, surface));
      if (absorbed <= hardly_absorbed && size > long_gaps * height) loss.within = grow_within;
      loss.parts = std::max(loss.parts, size / (seen_gaps * std::max(height, least_gap * size)));
    }
    return loss;
  }

 private:
  std::vector<int> seen_surfaces(int element) const {
    const ReflectedMesh& mesh = system_.mesh;
    std::vector<int> surfaces;
    for (const int e : system_.exchange.seen_from(mesh, element))
      surfaces.push_back(system_.light.surface[at(mesh.root(e))]);
    std::sort(surfaces.begin(), surfaces.end());
    surfaces.erase(std::unique(surfaces.begin(), surfaces.end()), surfaces.end());
    return surfaces;
  }

  const std::array<Vec3, 3>& corners_of(int element) const {
    return system_.mesh.forest.corners(system_.mesh.triangle[at(element)]);
  }

  /// The height of the lowest corner above a surface, or −1 if the element does not lie near before
  /// it.
  double gap(int element, double size, int surface) const {
    const int root = roots_[at(surface)].front();
    const Vec3& normal = scene_.roots.normal[at(root)];
    if (!(normal.dot(scene_.roots.normal[at(system_.mesh.root(element))]) < 0)) return -1;
    const std::array<Vec3, 3>& corners = corners_of(element);
    const Vec3 foot = system_.mesh.forest.corners(root)[0];
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const Vec3& p : corners) {
      low = std::min(low, normal.dot(p - foot));
      high = std::max(high, normal.dot(p - foot));
    }
    return high < nearest * size ? low : -1;
  }

  /// What nodes see of a surface less than the element does.
  double missed(int element, int surface) const {
    const ReflectedMesh& mesh = system_.mesh;
    const double area = mesh.area(element);
    FormFactorOptions options;
    options.tolerance = factor_tolerance;
    options.floor = factor_tolerance * area;
    const ElementNodes& nodes = element_nodes_of(mesh.order[at(mesh.triangle[at(element)])]);
    const Vec3& normal = scene_.roots.normal[at(mesh.root(element))];
    double mean = 0, by_nodes = 0;
    for (const int root : roots_[at(surface)]) {
      const std::array<Vec3, 3>& target = mesh.forest.corners(root);
      mean += mutual_area(corners_of(element), target, options).value / area;
      for (std::size_t n = 0; n < nodes.places.size(); ++n)
        by_nodes += nodes.fit(0, static_cast<Eigen::Index>(n)) *
                    point_to_polygon(mesh.position(element, nodes.places[n]), normal, target);
    }
    return mean - by_nodes;
  }

  const ReflectedSystem& system_;
  const ReflectingScene& scene_;
  std::vector<std::vector<int>> roots_;  ///< of each surface
};

double looks_for(double tolerance, const Rgb& rho) {
  const double matters = tolerance * std::max(1 - rho.maxCoeff(), 0.);
  return std::clamp(looks_at_backs / matters, fewest_looks, looks_to_put_right);
}

/// Of an element of some size; of what is missed, this part is not known.
void add_shadow(const BackShadow& shadow, double part, double size, UnsureLoss& loss) {
  if (shadow.share == 0) return;
  loss.factor += part * std::abs(shadow.share);
  loss.parts = std::max(loss.parts, size / (seen_gaps * std::max(shadow.height, least_gap * size)));
}

}  // namespace

std::vector<UnsureLoss> UnsureLosses::find(const ReflectedSystem& system, double tolerance,
                                           const Progress& progress) {
  const auto& [mesh, light, exchange, systems] = system;
  const GapSearch search(system, scene_);
  of_triangle_.resize(at(mesh.forest.count()));
  std::vector<UnsureLoss> unsure(at(mesh.count()));
  parallel_for(
      unsure.size(),
      [&](std::size_t i) {
        const int e = static_cast<int>(i);
        const Rgb rho = light.mean_rho(mesh, e);
        if ((rho == 0).all()) return;
        const std::size_t t = at(mesh.triangle[i]);
        KeptLoss& kept = of_triangle_[t];
        if (kept.order != mesh.order[t]) kept = {mesh.order[t], search(e), {}};
        UnsureLoss& loss = unsure[i] = kept.in_gaps;
        const BackShadow* const known = exchange.shadow(e);
        if (!known && !kept.shadow) kept.shadow = backs_.shadow(mesh, e, looks_for(tolerance, rho));
        add_shadow(known ? *known : *kept.shadow, known ? known->unsure : 1,
                   std::sqrt(mesh.area(e)), loss);
        loss.factor += exchange.unsure_loss(e);
      },
      progress, "error of reflected light");
  return unsure;
}

}  // namespace halfshade
