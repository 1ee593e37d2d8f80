#include "solver/reflected/ray_exchange.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "meshing/geometry/triangle_height.h"
#include "solver/elements/triangle_key.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace halfshade {
namespace {

constexpr int most_uses = 1024;
/// Of seeds, see ray_seed: those of the rays that are kept.
constexpr std::array<int, 2> uses_of_kept = {0, most_uses - 1};

/// With so many elements, those of less than the mean area have fewer rays. Noise falls with n rays
/// as n^-1.3: it is least for all of them with n as the area to the power of 1 / 2.3, which leaves
/// less than twice as much of it as the same number everywhere.
constexpr int many_elements = 20000, fewest_kept_strata = 3;
constexpr double power_of_rays = 1 / (1 + noise_exponent);

/// Of an element in a gap; with a quarter light was still amplified by up to 35 where it may be
/// by 5.
constexpr double share_of_width = 0.5;
/// Light that goes to and fro in a gap between polynomials falls by 1.3 times the reflectance with
/// each bounce, or grows. Below this one it falls soon enough, and polynomials of what comes in at
/// the border take fewer elements than constants do.
constexpr double amplified_reflectance = 0.65;

/// Of the mean area, if elements are so many that it matters; else 0.
double area_of_all_rays(const ReflectedMesh& mesh) {
  if (mesh.count() < many_elements) return 0;
  double area = 0;
  for (int e = 0; e < mesh.count(); ++e) area += mesh.area(e);
  return area / mesh.count();
}

int strata_for(double area, double area_of_all, int most) {
  if (area >= area_of_all) return most;
  const double share = std::pow(area / area_of_all, power_of_rays);
  return std::clamp(static_cast<int>(std::lround(most * std::sqrt(share))),
                    std::min(fewest_kept_strata, most), most);
}

}  // namespace

std::uint64_t ray_seed(const ReflectedMesh& mesh, int element, int node, int use) {
  return mix_bits(triangle_key(mesh.forest.corners(mesh.triangle[at(element)])) +
                  static_cast<std::uint64_t>(node * most_uses + use));
}

RayOrigin ray_origin(const ReflectingScene& scene, const ReflectedMesh& mesh, int element,
                     const TrianglePlace& place) {
  const int root = mesh.root(element), cell = scene.cells.before(root);
  return {mesh.position(element, place), scene.roots.normal[at(root)], cell,
          static_cast<bool>(scene.cells.closed[at(cell)]), scene.visibility.soup().plane[at(root)]};
}

std::vector<RayHemisphere> halves_of_nodes(const ReflectingScene& scene, const ReflectedMesh& mesh,
                                           int element, int strata, std::array<int, 2> uses) {
  const auto& places = element_nodes_of(mesh.order[at(mesh.triangle[at(element)])]).places;
  std::vector<RayHemisphere> halves;
  for (int node = 0; node < static_cast<int>(places.size()); ++node)
    for (const int use : uses)
      halves.push_back({ray_origin(scene, mesh, element, places[at(node)]), strata,
                        ray_seed(mesh, element, node, use)});
  return halves;
}

ElementField reflected_part(const ReflectedMesh& mesh, const FirstLight& light,
                            const ElementField& field) {
  ElementField result = field;
  for (int e = 0; e < field.count(); ++e) result.of(e) = light.reflected(mesh, e, field.of(e));
  return result;
}

bool RayExchange::update(const ReflectedMesh& mesh, const Progress& progress) {
  stop_ = progress.stop;
  of_triangle_.resize(at(mesh.forest.count()));
  const double area_of_all = area_of_all_rays(mesh);
  for (int t = 0; t < mesh.forest.count(); ++t)
    if (!mesh.forest.is_leaf(t)) of_triangle_[at(t)].reset();
  std::vector<int> missing, strata;
  for (int e = 0; e < mesh.count(); ++e) {
    const int t = mesh.triangle[at(e)];
    const auto& rays = of_triangle_[at(t)];
    const std::size_t nodes = element_nodes_of(mesh.order[at(t)]).places.size();
    if (rays && rays->halves.traced.of_each.size() == 2 * nodes) continue;
    missing.push_back(e);
    strata.push_back(strata_for(mesh.forest.area(t), area_of_all, strata_));
    traced_ += 2 * nodes * rays_of_hemisphere(light_, strata.back());
  }
  const bool complete = parallel_for(
      missing.size(),
      [&](std::size_t i) {
        const int e = missing[i];
        const auto halves = halves_of_nodes(scene_, mesh, e, strata[i], uses_of_kept);
        auto& kept = of_triangle_[at(mesh.triangle[at(e)])];
        kept = std::make_unique<NodeRays>(
            NodeRays{gather_rays(scene_, light_, Looks::quick, halves), strata[i]});
        kept->halves.traced.ends.shrink_to_fit();
      },
      progress, "rays of reflected light");
  if (complete)
    parallel_for(at(mesh.count()), [&](std::size_t e) {
      settle(mesh.forest, of_triangle_[at(mesh.triangle[e])]->halves.traced);
    });
  return complete;
}

bool RayExchange::is_in_gap(const ReflectedMesh& mesh, int element) const {
  const int t = mesh.triangle[at(element)];
  const double reach = share_of_width * shortest_height(mesh.forest.corners(t));
  const auto& places = element_nodes_of(mesh.order[at(t)]).places;
  const TracedHemispheres& traced = of_triangle_[at(t)]->halves.traced;
  const Rgb rho = light_.rho[at(mesh.root(element))];
  constexpr double least = amplified_reflectance * amplified_reflectance;
  std::size_t near = 0;
  for (std::size_t h = 0; h < traced.of_each.size(); ++h) {
    const Vec3 from = mesh.position(element, places[h / 2]);
    for (const RayEnd& end : traced.ends_of(h)) {
      const Vec3 to = position(mesh.forest.corners(end.triangle), end.place());
      const Rgb both = rho * light_.rho[at(mesh.forest.root(end.triangle))];
      near += (to - from).squaredNorm() < reach * reach && both.maxCoeff() > least ? 1 : 0;
    }
  }
  return 2 * near > traced.ends.size();
}

bool RayExchange::lower_orders_in_gaps(ReflectedMesh& mesh, const Progress& progress) {
  if (!update(mesh, progress)) return false;
  std::vector<std::uint8_t> lowers(at(mesh.count()), 0);
  parallel_for(lowers.size(), [&](std::size_t e) {
    lowers[e] = !mesh.stays_constant[at(mesh.triangle[e])] && is_in_gap(mesh, static_cast<int>(e));
  });
  std::vector<int> elements;
  for (std::size_t e = 0; e < lowers.size(); ++e)
    if (lowers[e]) elements.push_back(static_cast<int>(e));
  make_constant(mesh, elements);
  return true;
}

bool RayExchange::find_losses(const ReflectedMesh& mesh, const LightSystems& systems, double enough,
                              const Progress& progress) {
  std::vector<Eigen::VectorXd> told;
  std::vector<double> cast;
  for (const int t : mesh.triangle) {
    const TracedHemispheres& traced = of_triangle_[at(t)]->halves.traced;
    const std::size_t nodes = traced.of_each.size() / 2;
    Eigen::VectorXd seen(static_cast<Eigen::Index>(nodes));
    cast.push_back(0);
    for (std::size_t n = 0; n < nodes; ++n) {
      const double rays = traced.of_each[2 * n].rays + traced.of_each[2 * n + 1].rays;
      const std::size_t ends = traced.ends_of(2 * n).size() + traced.ends_of(2 * n + 1).size();
      seen[static_cast<Eigen::Index>(n)] = rays > 0 ? static_cast<double>(ends) / rays : 0;
      cast.back() += rays;
    }
    told.push_back(element_nodes_of(mesh.order[at(t)]).fit * seen);
  }
  losses_ = halfshade::find_losses(scene_, light_, mesh, systems, std::move(told), cast, enough,
                                   progress);
  traced_ += losses_.rays;
  return !progress.stopped();
}

const BackShadow* RayExchange::shadow(int element) const {
  const std::optional<BackShadow>& shadow = losses_.shadow[at(element)];
  return shadow ? &*shadow : nullptr;
}

ElementField RayExchange::source(const ReflectedMesh& mesh) const {
  ElementField result = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e) {
    const int t = mesh.triangle[at(e)];
    result.of(e) = (element_nodes_of(mesh.order[at(t)]).fit *
                    means_of_halves(of_triangle_[at(t)]->halves.first).matrix())
                       .array();
  }
  return result;
}

ElementField RayExchange::apply(const ReflectedMesh& mesh, const ElementField& leaving) const {
  const LeavingField field(mesh, leaving);
  ElementField result = zero_field(mesh);
  parallel_for(at(mesh.count()), [&](std::size_t e) {
    const int t = mesh.triangle[e];
    const ChannelArray values =
        means_of_halves(irradiance(of_triangle_[at(t)]->halves.traced, field));
    result.of(static_cast<int>(e)) =
        (element_nodes_of(mesh.order[at(t)]).fit * values.matrix()).array();
  });
  return result;
}

FieldNoise RayExchange::noise(const ReflectedMesh& mesh, const ElementField& leaving) const {
  const LeavingField field(mesh, leaving);
  FieldNoise noise(at(mesh.count()));
  parallel_for(noise.size(), [&](std::size_t e) {
    const int t = mesh.triangle[e];
    const GatheredRays& halves = of_triangle_[at(t)]->halves;
    noise[e] = noise_of_halves(element_nodes_of(mesh.order[at(t)]), mesh.forest.area(t),
                               halves.first + irradiance(halves.traced, field));
  });
  return noise;
}

void RayExchange::scale_to_all_rays(const ReflectedMesh& mesh, std::vector<double>& noise) const {
  const std::vector<double> rays = rays_of_nodes(mesh);
  for (std::size_t e = 0; e < noise.size(); ++e)
    noise[e] *= std::pow(rays[e] / most_rays(), noise_exponent);
}

std::vector<double> RayExchange::rays_of_nodes(const ReflectedMesh& mesh) const {
  std::vector<double> rays;
  for (const int t : mesh.triangle) rays.push_back(2 * std::pow(of_triangle_[at(t)]->strata, 2));
  return rays;
}

std::vector<int> RayExchange::seen_from(const ReflectedMesh& mesh, int element) const {
  std::vector<int> seen;
  for (const RayEnd& end : of_triangle_[at(mesh.triangle[at(element)])]->halves.traced.ends)
    seen.push_back(mesh.element[at(end.triangle)]);
  return seen;
}

}  // namespace halfshade
