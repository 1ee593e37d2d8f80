#include "solver/pipeline/subdivide.h"

#include "meshing/core/error.h"
#include "solver/direct/direct_light.h"
#include "solver/elements/material_arrays.h"
#include "solver/linear/two_levels.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// Which patch each element is a part of. Patches are the roots, in the order of the elements that
/// they were.
std::vector<int> patches_of(const PatchHierarchy& hierarchy, const std::vector<int>& patch_of_root,
                            int elements) {
  std::vector<int> patch_of(at(elements));
  for (std::size_t node = 0; node < hierarchy.element.size(); ++node) {
    if (hierarchy.element[node] < 0) continue;
    std::size_t root = node;
    while (hierarchy.parent[root] >= 0) root = at(hierarchy.parent[root]);
    patch_of[at(hierarchy.element[node])] = patch_of_root[root];
  }
  return patch_of;
}

double mean_irradiance(const ElementTable& elements, const ChannelArray& irradiance) {
  const Eigen::Map<const Eigen::ArrayXd> area(elements.area.data(), elements.count());
  return (area * irradiance.rowwise().mean()).sum() / area.sum();
}

void require_room(int elements, std::size_t steep, int most) {
  // Three more for each, without what neighbours take.
  if (elements + 3 * static_cast<double>(steep) > most)
    throw Error(ErrorCode::too_large, {},
                fmt::format("{} of {} elements are to be split in four, which makes more than {}; "
                            "--max-elements allows more, a larger --gradient takes fewer",
                            steep, elements, most));
}

/// The light on elements that patches send; false if stopped.
bool light_elements(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                    const ElementTable& patches, const ElementTable& elements,
                    const std::vector<int>& patch_of, const Progress& progress,
                    SolvedLight& light) {
  const SoundScene& scene = prepared.scene();
  ChannelArray direct;
  std::vector<Region> region;
  if (plan.no_exact_direct_light.empty()) {
    ElementDirectLight found = element_direct_light(scene, elements, prepared.direct_light(),
                                                    options.direct_points, progress);
    direct = irradiance_of(found, scene);
    region = std::move(found.region);
  }
  PatchFactors factors(elements.count(), patches.count());
  if (plan.no_factors.empty())
    factors =
        patch_factors(scene, patches, elements, prepared.visibility(), options.exchange, progress);
  if (factors.rows() == 0 || progress.stopped()) return false;
  const MaterialArrays materials = material_arrays(scene, elements);
  light.solution = solve_two_levels({elements.area, patch_of, factors}, materials.rho,
                                    materials.exitance, direct, options.radiosity, light.radiosity);
  light.solution.region = std::move(region);
  return true;
}

}  // namespace

std::vector<int> steep_elements(const ElementTable& elements, const ChannelArray& irradiance,
                                double step) {
  std::vector<int> steep;
  const Eigen::ArrayXd H = irradiance.rowwise().mean();
  for (int e = 0; e < elements.count(); ++e)
    for (const int n : elements.neighbours[at(e)])
      if (n >= 0 && std::abs(H[e] - H[n]) > step) {
        steep.push_back(e);
        break;
      }
  return steep;
}

SubdividedLight subdivide(const PreparedScene& prepared, const Plan& plan,
                          const SolveOptions& options, PatchMesh mesh, SolvedLight light,
                          const Progress& progress, Stages& stages) {
  SubdividedLight result{mesh.elements(), std::move(light), {}};
  const ElementTable patches = result.elements;
  const Eigen::ArrayXd patch_error = result.light.exchange_error;
  const std::vector<int> patch_of_root = mesh.hierarchy().element;
  result.report.patches = patches.count();
  for (int round = 0; round < options.subdivision.rounds && !progress.stopped(); ++round) {
    const ElementTable& old = result.elements;
    const ChannelArray& irradiance = result.light.solution.irradiance;
    const std::vector<int> steep = steep_elements(
        old, irradiance, options.subdivision.gradient * mean_irradiance(old, irradiance));
    if (steep.empty()) break;
    require_room(old.count(), steep.size(), options.max_elements);
    stages.run("subdivision", [&] {
      mesh.split_in_four(steep);
      ElementTable elements = mesh.elements();
      const std::vector<int> patch_of =
          patches_of(mesh.hierarchy(), patch_of_root, elements.count());
      if (!light_elements(prepared, plan, options, patches, elements, patch_of, progress,
                          result.light))
        return result.elements.corners.size();
      result.light.exchange_error = patch_error(patch_of);
      result.elements = std::move(elements);
      result.report.elements.push_back(result.elements.count());
      return result.elements.corners.size();
    });
  }
  return result;
}

}  // namespace halfshade
