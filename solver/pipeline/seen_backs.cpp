#include "solver/pipeline/seen_backs.h"

#include "solver/exchange/cells.h"
#include "solver/pipeline/fewest_elements.h"
#include "solver/pipeline/first_few.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

namespace halfshade {

namespace {

/// Cell → all its elements lie in one plane: they touch.
std::vector<bool> flat_cells(const ElementTable& elements, const SpaceCells& cells) {
  constexpr double rounding = 1e-9;
  std::vector<int> first(at(cells.count()), -1);
  std::vector<bool> is_flat(first.size(), true);
  for (int e = 0; e < elements.count(); ++e) {
    const std::size_t cell = at(cells.before(e));
    if (first[cell] < 0) first[cell] = e;
    const Vec3& normal = elements.normal[at(e)];
    const Vec3 from = elements.triangle(first[cell])[0], to = elements.triangle(e)[0];
    const double size = from.norm() + to.norm();
    is_flat[cell] = is_flat[cell] && std::abs(normal.dot(to - from)) <= rounding * size &&
                    normal.cross(elements.normal[at(first[cell])]).norm() <= rounding;
  }
  return is_flat;
}

}  // namespace

std::vector<Warning> back_warnings(const SoundScene& scene, const Heat& heat) {
  const ElementTable elements = fewest_elements(scene);
  const SpaceCells cells = find_cells(scene, elements);
  const std::vector<bool> is_flat = flat_cells(elements, cells);
  std::map<int, double> areas;  // by group
  double area = 0;
  for (int e = 0; e < elements.count(); ++e) {
    const int cell = cells.before(e);
    if (cell == cells.outside || (cells.swallowing[at(cell)] < 0 && !is_flat[at(cell)])) continue;
    areas[elements.group[at(e)]] += elements.area[at(e)];
    area += elements.area[at(e)];
  }
  if (areas.empty()) return {};
  std::vector<std::string> names;
  for (const auto& [group, part] : areas) names.push_back(scene.groups[at(group)]);
  return {
      {Warning::Kind::backs_exchange,
       fmt::format("an area of {:.3g} of {} lies inside of bodies or is covered by them, and "
                   "exchanges heat as with surroundings at {:g} K, which backs of one-sided faces "
                   "count as: cut it out, or leave a gap",
                   area, first_few(names), heat.surroundings.value_or(0))}};
}

}  // namespace halfshade
