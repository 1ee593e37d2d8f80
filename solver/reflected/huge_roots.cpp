#include "solver/reflected/huge_roots.h"

#include <algorithm>
#include <numeric>

namespace halfshade {
namespace {

/// Times the area of all that is smaller.
constexpr double far_larger = 30;

}  // namespace

HugeRoots find_huge(const ElementTable& roots, const std::vector<bool>& counted) {
  HugeRoots result;
  result.is_huge.assign(roots.area.size(), false);
  const int last =
      roots.surface.empty() ? -1 : *std::max_element(roots.surface.begin(), roots.surface.end());
  std::vector<double> area(at(last + 1), 0.);
  std::vector<bool> is_huge(area.size(), false);
  for (std::size_t s = 0; s < area.size(); ++s) is_huge[s] = !counted.empty() && !counted[s];
  for (std::size_t r = 0; r < roots.area.size(); ++r)
    if (!is_huge[at(roots.surface[r])]) area[at(roots.surface[r])] += roots.area[r];
  std::vector<int> by_area(area.size());
  std::iota(by_area.begin(), by_area.end(), 0);
  std::stable_sort(by_area.begin(), by_area.end(),
                   [&](int a, int b) { return area[at(a)] < area[at(b)]; });
  // Up to the last surface that is not far larger than what is below it; above are huge ones.
  std::vector<double> below(by_area.size() + 1, 0.);
  for (std::size_t k = 0; k < by_area.size(); ++k) below[k + 1] = below[k] + area[at(by_area[k])];
  std::size_t usual = by_area.size();
  while (usual > 1 && below[usual - 1] > 0 &&
         area[at(by_area[usual - 1])] > far_larger * below[usual - 1])
    --usual;
  for (std::size_t k = usual; k < by_area.size(); ++k) is_huge[at(by_area[k])] = true;
  for (std::size_t r = 0; r < roots.area.size(); ++r) {
    result.is_huge[r] = is_huge[at(roots.surface[r])];
    result.others += result.is_huge[r] ? 0 : 1;
  }
  result.area = below[usual];
  return result;
}

}  // namespace halfshade
