#include "solver/exchange/enclosures.h"

#include <vector>

namespace halfshade {
namespace {

/// Gives `enclosure` to everything that is connected with `start`.
void flood(const ExchangeMatrix& matrix, int start, int enclosure, std::vector<int>& of_element) {
  std::vector<int> front = {start};
  of_element[at(start)] = enclosure;
  while (!front.empty()) {
    const int e = front.back();
    front.pop_back();
    for (ExchangeMatrix::InnerIterator entry(matrix, e); entry; ++entry) {
      int& other = of_element[at(static_cast<int>(entry.col()))];
      if (other >= 0) continue;
      other = enclosure;
      front.push_back(static_cast<int>(entry.col()));
    }
  }
}

}  // namespace

Enclosures find_enclosures(const SoundScene& scene, const ElementTable& elements,
                           const SpaceCells& cells, const ExchangeMatrix& matrix) {
  Enclosures enclosures;
  enclosures.of_element.assign(elements.corners.size(), -1);
  std::vector<int> of_cell(at(cells.count()), -1);
  for (int e = 0; e < elements.count(); ++e) {
    int& enclosure = enclosures.of_element[at(e)];
    const int cell = cells.before(e);
    const bool closed = cells.closed[at(cell)];
    if (closed && of_cell[at(cell)] >= 0) enclosure = of_cell[at(cell)];
    if (enclosure >= 0) continue;
    if (closed)
      enclosure = of_cell[at(cell)] = enclosures.count();
    else
      flood(matrix, e, enclosures.count(), enclosures.of_element);
    enclosures.closed.push_back(closed);
    enclosures.lit.push_back(false);
  }
  for (int e = 0; e < elements.count(); ++e)
    if ((scene.materials[at(elements.material[at(e)])].exitance > 0).any())
      enclosures.lit[at(enclosures.of_element[at(e)])] = true;
  return enclosures;
}

}  // namespace halfshade
