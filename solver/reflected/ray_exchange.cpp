#include "solver/reflected/ray_exchange.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/elements/triangle_key.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr int most_uses = 1024;
/// Uses of seeds, see ray_seed: the first half of the rays that are kept has 0.
constexpr int second_half = most_uses - 1;

/// With so many elements, those of less than the mean area have fewer rays. Noise falls with n rays
/// as n^-1.3: it is least for all of them with n as the area to the power of 1 / 2.3, which leaves
/// less than twice as much of it as the same number everywhere.
constexpr int many_elements = 20000, fewest_kept_strata = 3;
constexpr double power_of_rays = 1 / (1 + noise_exponent);

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

/// What arrives by each half of the rays of what leaves triangles.
ChannelArray arriving(const NodeRays& rays, const QuickField& leaving) {
  ChannelArray values(static_cast<Eigen::Index>(rays.rays.size()), 3);
  for (std::size_t k = 0; k < rays.rays.size(); ++k) {
    Rgb sum = Rgb::Zero();
    for (int i = rays.first[k]; i < rays.first[k + 1]; ++i) {
      const RayEnd& end = rays.ends[at(i)];
      sum += leaving.value(end.triangle, end.place());
    }
    values.row(static_cast<Eigen::Index>(k)) = (sum / rays.rays[k]).transpose();
  }
  return values;
}

std::unique_ptr<NodeRays> trace(const ReflectingScene& scene, const FirstLight& light,
                                const ReflectedMesh& mesh, int element, int strata) {
  std::vector<RayEnd> ends;
  const Gathering gathering{scene, light, Looks::quick};
  auto rays = std::make_unique<NodeRays>();
  const int triangle = mesh.triangle[at(element)];
  const ElementNodes& nodes = element_nodes_of(mesh.order[at(triangle)]);
  rays->strata = strata;
  rays->source = ChannelArray::Zero(2 * static_cast<Eigen::Index>(nodes.places.size()), 3);
  for (int i = 0; i < static_cast<int>(rays->source.rows()); ++i) {
    const int node = i / 2;
    const RayOrigin from = ray_origin(scene, mesh, element, nodes.places[at(node)]);
    const std::uint64_t seed = ray_seed(mesh, element, node, i % 2 == 0 ? 0 : second_half);
    const auto [first, count] = gathering(from, strata, seed, ends);
    rays->first.push_back(static_cast<int>(rays->ends.size()));
    rays->rays.push_back(count);
    rays->source.row(i) = first.transpose();
    rays->ends.insert(rays->ends.end(), ends.begin(), ends.end());
  }
  rays->first.push_back(static_cast<int>(rays->ends.size()));
  rays->ends.shrink_to_fit();
  return rays;
}

void settle(const TriangleForest& forest, NodeRays& rays) {
  for (RayEnd& end : rays.ends) {
    if (forest.is_leaf(end.triangle)) continue;
    const ForestPlace leaf = forest.leaf_at({end.triangle, end.place()});
    end = {leaf.triangle, static_cast<float>(leaf.place.x()), static_cast<float>(leaf.place.y())};
  }
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

Gathering::Result Gathering::operator()(const RayOrigin& from, int strata, std::uint64_t seed,
                                        std::vector<RayEnd>& ends) const {
  ends.clear();
  const int rays = HemisphereRays(scene).cast(from, strata, seed, ends);
  const auto leaving = [this](int root, const Vec3& p) { return light.leaving(root, p); };
  return {light.hot.irradiance(scene, leaving, looks, from, strata, rays, ends, seed), rays};
}

std::size_t Gathering::rays(int strata) const {
  return at(strata * strata + light.hot.count(strata * strata));
}

Rgb gathered(const Gathering& gathering, const ReflectedMesh& mesh, const QuickField& leaving,
             const RayOrigin& from, int strata, std::uint64_t seed) {
  std::vector<RayEnd> ends;
  const auto [first, rays] = gathering(from, strata, seed, ends);
  Rgb sum = Rgb::Zero();
  for (const RayEnd& end : ends) {
    const ForestPlace leaf = mesh.forest.leaf_at({end.triangle, end.place()});
    sum += leaving.value(leaf.triangle, leaf.place);
  }
  return first + sum / rays;
}

ElementField reflected_part(const ReflectedMesh& mesh, const FirstLight& light,
                            const ElementField& field) {
  ElementField result = field;
  for (int e = 0; e < field.count(); ++e) result.of(e) = light.reflected(mesh, e, field.of(e));
  return result;
}

bool RayExchange::update(const ReflectedMesh& mesh, const Progress& progress) {
  of_triangle_.resize(at(mesh.forest.count()));
  const double area_of_all = area_of_all_rays(mesh);
  std::vector<int> missing, strata;
  for (int t = 0; t < mesh.forest.count(); ++t) {
    auto& rays = of_triangle_[at(t)];
    if (!mesh.forest.is_leaf(t)) rays.reset();
    const std::size_t nodes = element_nodes_of(mesh.order[at(t)]).places.size();
    if (!mesh.forest.is_leaf(t) || (rays && rays->rays.size() == 2 * nodes)) continue;
    missing.push_back(mesh.element[at(t)]);
    strata.push_back(strata_for(mesh.forest.area(t), area_of_all, strata_));
    traced_ += 2 * nodes * Gathering{scene_, light_}.rays(strata.back());
  }
  const bool complete = parallel_for(
      missing.size(),
      [&](std::size_t i) {
        const int e = missing[i];
        of_triangle_[at(mesh.triangle[at(e)])] = trace(scene_, light_, mesh, e, strata[i]);
      },
      progress, "rays of reflected light");
  if (complete)
    parallel_for(at(mesh.count()),
                 [&](std::size_t e) { settle(mesh.forest, *of_triangle_[at(mesh.triangle[e])]); });
  return complete;
}

ElementField RayExchange::source(const ReflectedMesh& mesh) const {
  ElementField result = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e) {
    const int t = mesh.triangle[at(e)];
    result.of(e) = (element_nodes_of(mesh.order[at(t)]).fit *
                    means_of_halves(of_triangle_[at(t)]->source).matrix())
                       .array();
  }
  return result;
}

ElementField RayExchange::apply(const ReflectedMesh& mesh, const ElementField& leaving) const {
  const QuickField quick(mesh, leaving);
  ElementField result = zero_field(mesh);
  parallel_for(at(mesh.count()), [&](std::size_t e) {
    const int t = mesh.triangle[e];
    const ChannelArray values = means_of_halves(arriving(*of_triangle_[at(t)], quick));
    result.of(static_cast<int>(e)) =
        (element_nodes_of(mesh.order[at(t)]).fit * values.matrix()).array();
  });
  return result;
}

FieldNoise RayExchange::noise(const ReflectedMesh& mesh, const ElementField& leaving) const {
  const QuickField quick(mesh, leaving);
  FieldNoise noise(at(mesh.count()));
  parallel_for(noise.size(), [&](std::size_t e) {
    const int t = mesh.triangle[e];
    const NodeRays& rays = *of_triangle_[at(t)];
    noise[e] = noise_of_halves(element_nodes_of(mesh.order[at(t)]), mesh.forest.area(t),
                               rays.source + arriving(rays, quick));
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
  for (const RayEnd& end : of_triangle_[at(mesh.triangle[at(element)])]->ends)
    seen.push_back(mesh.element[at(end.triangle)]);
  return seen;
}

}  // namespace halfshade
