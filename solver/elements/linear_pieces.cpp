#include "solver/elements/linear_pieces.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr int most_along_edge = 16;

/// Pieces along an edge that do: straight ones are off by the square of their length.
int pieces_along_edge(const ElementField& field, int element, double allowed) {
  const auto coefficients = field.of(element).matrix();
  if (coefficients.rows() <= basis_size(1)) return 1;
  // By how much a straight triangle misses the polynomials of a degree, at most, in the mean.
  constexpr std::array<double, max_order + 1> bends = {0, 0, 3, 7, 14, 25, 41, 57, 86};
  double square = 0;
  for (int degree = 2; degree <= field.order[at(element)]; ++degree)
    square += std::pow(bends[at(degree)], 2) *
              coefficients.middleRows(basis_size(degree - 1), degree + 1).squaredNorm();
  const double bent = std::sqrt(square);
  if (!(bent > allowed)) return 1;
  return static_cast<int>(
      std::clamp(std::ceil(std::sqrt(bent / allowed)), 1., static_cast<double>(most_along_edge)));
}

}  // namespace

LinearPieces linear_pieces(std::span<const std::array<Vec3, 3>> triangles,
                           const ElementField& field, std::span<const int> along_edge) {
  LinearPieces out;
  for (int e = 0; e < field.count(); ++e) {
    const int n = along_edge[at(e)];
    const int first = static_cast<int>(out.points.size());
    const auto point = [&](int i, int j) { return first + j * (n + 1) - j * (j - 1) / 2 + i; };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i + j <= n; ++i) {
        const TrianglePlace place = TrianglePlace(i, j) / n;
        out.points.push_back(position(triangles[at(e)], place));
        out.value.push_back(value_at(field, e, place));
        out.element_of_point.push_back(e);
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i + j < n; ++i) {
        out.corners.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
        out.is_border.push_back({j == 0, i + j + 1 == n, i == 0});
        if (i + j + 1 == n) continue;
        out.corners.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
        out.is_border.push_back({false, false, false});
      }
    out.pieces.push_back(n * n);
    out.element.resize(out.corners.size(), e);
  }
  return out;
}

LinearPieces linear_pieces(std::span<const std::array<Vec3, 3>> triangles,
                           const ElementField& field, double allowed) {
  std::vector<int> along_edge;
  for (int e = 0; e < field.count(); ++e)
    along_edge.push_back(pieces_along_edge(field, e, allowed));
  return linear_pieces(triangles, field, along_edge);
}

}  // namespace halfshade
