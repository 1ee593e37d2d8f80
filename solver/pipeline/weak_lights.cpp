#include "solver/pipeline/weak_lights.h"

#include <set>

namespace halfshade {

std::vector<std::string> weak_lights(const SoundScene& scene, const ElementTable& elements,
                                     const Solution& solution) {
  constexpr double weakest = 0x1p-480;  // its square, with areas and factors, is still a double
  const Rgb least = weakest * solution.exitance.colwise().maxCoeff().transpose();
  std::set<std::string> names;
  for (int e = 0; e < elements.count(); ++e) {
    const Rgb sent = solution.exitance.row(e), arriving = solution.irradiance.row(e);
    if ((sent > 0 && sent < least && arriving < least).any())
      names.insert(scene.groups[at(elements.group[at(e)])]);
  }
  return {names.begin(), names.end()};
}

}  // namespace halfshade
