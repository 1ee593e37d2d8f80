#include "io/files/consistency.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

namespace halfshade::detail {

void require_consistent(const ElementTable& elements, const char* caller) {
  const std::size_t n = elements.corners.size();
  for (const std::size_t size :
       {elements.normal.size(), elements.area.size(), elements.surface.size(), elements.face.size(),
        elements.group.size(), elements.material.size(), elements.level.size()})
    if (size != n)
      throw Error(ErrorCode::contract, caller,
                  fmt::format("an array of the {} elements has {} entries", n, size));
  const int points = static_cast<int>(elements.points.size());
  for (const auto& corners : elements.corners)
    for (const int p : corners)
      if (p < 0 || p >= points)
        throw Error(ErrorCode::contract, caller,
                    fmt::format("an element names point {} of {}", p, points));
}

void require_consistent(const SolveResult& result, const char* caller) {
  require_consistent(result.elements, caller);
  const auto n = static_cast<Eigen::Index>(result.elements.count());
  if (!result.regions.empty() &&
      result.regions.size() != result.elements.corners.size() * result.emitters.size())
    throw Error(ErrorCode::contract, caller,
                fmt::format("{} elements and {} emitters have {} regions", n,
                            result.emitters.size(), result.regions.size()));
  const Solution& s = result.solution;
  for (const ChannelArray* array :
       {&s.rho, &s.exitance, &s.radiosity, &s.irradiance, &s.direct_irradiance})
    if (array->rows() != n)
      throw Error(
          ErrorCode::contract, caller,
          fmt::format("the solution has {} rows for {} elements in an array", array->rows(), n));
}

}  // namespace halfshade::detail
