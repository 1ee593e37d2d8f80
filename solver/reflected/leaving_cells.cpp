#include "solver/reflected/leaving_cells.h"

#include "meshing/core/parallel.h"
#include "meshing/core/rounded.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/elements/element_field.h"
#include "solver/elements/triangle_key.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Points of each cell.
constexpr int looks = 4;

/// Cells before row j of a triangle cut in columns²: the rows are as long as 2 columns − 1, two
/// less each.
int before_row(int j, int columns) { return j * (2 * columns - j); }

double square_of_longest_edge(const std::array<Vec3, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  return std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
}

}  // namespace

TrianglePlace place_in(const std::array<TrianglePlace, 3>& corners, double u, double v) {
  const double across = std::sqrt(u);
  return corners[0] + across * (1 - v) * (corners[1] - corners[0]) +
         across * v * (corners[2] - corners[0]);
}

LeavingCells::LeavingCells(const ReflectingScene& scene, const HugeRoots& huge, double wanted,
                           const Leaving& leaving) {
  const ElementTable& roots = scene.roots;
  double area = 0;
  for (int r = 0; r < roots.count(); ++r) area += huge(r) ? 0 : roots.area[at(r)];
  std::vector<int> root;  // of each cell
  for (int r = 0; r < roots.count(); ++r) {
    const double share = std::sqrt(wanted * std::min(roots.area[at(r)] / area, 1.));
    const int columns = std::max(1, static_cast<int>(std::lround(rounded(share))));
    columns_.push_back(columns);
    first_.push_back(static_cast<int>(root.size()));
    square_size_.push_back(square_of_longest_edge(roots.triangle(r)) / (columns * columns));
    root.resize(root.size() + at(columns * columns), r);
  }
  first_.push_back(static_cast<int>(root.size()));
  mean_.resize(root.size());
  parallel_for(root.size(), [&](std::size_t c) {
    const int r = root[c], cell = static_cast<int>(c);
    const std::array<Vec3, 3> triangle = roots.triangle(r);
    const std::array<TrianglePlace, 3> corner = corners(r, cell);
    const std::uint64_t seed =
        mix_bits(triangle_key(triangle) + static_cast<std::uint64_t>(cell - first(r)));
    Rgb sum = Rgb::Zero();
    for (std::uint64_t k = 0; k < 2 * looks; k += 2) {
      const TrianglePlace place =
          place_in(corner, random_number(seed, k), random_number(seed, k + 1));
      sum += leaving(r, position(triangle, place));
    }
    mean_[c] = (sum / looks).cast<float>();
  });
}

int LeavingCells::find(int root, const TrianglePlace& place) const {
  const int columns = columns_[at(root)];
  const double s = columns * place.x(), t = columns * place.y();
  const int j = std::clamp(static_cast<int>(t), 0, columns - 1);
  const int i = std::clamp(static_cast<int>(s), 0, columns - 1 - j);
  const bool turned = s - i + t - j > 1 && i + j < columns - 1;
  return first(root) + before_row(j, columns) + 2 * i + (turned ? 1 : 0);
}

std::array<TrianglePlace, 3> LeavingCells::corners(int root, int cell) const {
  const int columns = columns_[at(root)];
  int in_row = cell - first(root), j = 0;
  for (; in_row >= 2 * (columns - j) - 1; ++j) in_row -= 2 * (columns - j) - 1;
  const int i = in_row / 2;
  const auto at_node = [&](int k, int l) {
    return TrianglePlace(static_cast<double>(k) / columns, static_cast<double>(l) / columns);
  };
  if (in_row % 2 == 1) return {at_node(i + 1, j + 1), at_node(i, j + 1), at_node(i + 1, j)};
  return {at_node(i, j), at_node(i + 1, j), at_node(i, j + 1)};
}

}  // namespace halfshade
