#include "solver/pipeline/require_limits.h"

#include "meshing/core/error.h"
#include "solver/linear/radiosity.h"
#include "solver/pipeline/fewest_elements.h"
#include "solver/pipeline/first_few.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace halfshade {
namespace {

/// Stands for the reflectance of what is painted: less than 1.
constexpr double of_paint = 0.5;

bool reflects_everything(const SoundScene& scene, const Surface& surface) {
  return surface.paint < 0 && (scene.materials[at(surface.material)].rho >= 1).any();
}

bool may_have_no_limit(const SoundScene& scene) {
  return std::any_of(scene.surfaces.begin(), scene.surfaces.end(),
                     [&](const Surface& surface) { return reflects_everything(scene, surface); });
}

}  // namespace

void require_limits(const std::vector<std::string>& group_names, std::span<const int> group,
                    const Exchange& exchange, const MaterialArrays& materials,
                    const RadiosityOptions& options) {
  if (options.bounces >= 0) return;
  const auto unlimited =
      find_unlimited(light_exchange(exchange), materials.rho, materials.exitance);
  if (!unlimited) return;
  std::set<int> groups;
  for (std::size_t e = 0; e < group.size(); ++e)
    if (exchange.enclosures.of_element[e] == unlimited->system) groups.insert(group[e]);
  std::vector<std::string> names;
  for (const int g : groups) names.push_back(group_names[at(g)]);
  const bool is_one = names.size() == 1;
  throw Error(
      ErrorCode::invalid_input, {},
      fmt::format("the group{} {} close{} in a space that reflects everything (reflectance "
                  "1) and emits {} W, so its radiosity has no limit; lower a reflectance",
                  is_one ? "" : "s", first_few(names), is_one ? "s" : "", unlimited->power));
}

void require_limits(const PreparedScene& prepared, const RadiosityOptions& options,
                    const Progress& progress) {
  const SoundScene& scene = prepared.scene();
  if (options.bounces >= 0 || !may_have_no_limit(scene)) return;
  const ElementTable elements = fewest_elements(scene, progress);
  if (progress.stopped()) return;
  MaterialArrays materials = material_arrays(scene, elements);
  for (int e = 0; e < elements.count(); ++e)
    if (scene.surfaces[at(elements.surface[at(e)])].paint >= 0)
      materials.rho.row(e) = materials.rho.row(e).min(of_paint);
  require_limits(scene.groups, elements.group, enclosures_alone(scene, elements), materials,
                 options);
}

}  // namespace halfshade
