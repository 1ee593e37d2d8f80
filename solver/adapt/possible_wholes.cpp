#include "solver/adapt/possible_wholes.h"

#include "meshing/core/rounded.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace halfshade {
namespace {

/// Errors that differ by this share of them, or by this share of the light, are equal: rounding
/// must not choose.
constexpr double differs = 1e-9, rounding = 1e-12;

/// The best fit of that order to the polynomials of the parts.
ElementFit fit_to_parts(const std::array<Vec3, 3>& triangle,
                        std::span<const FittedElement> elements, std::span<const int> parts,
                        int order) {
  ElementFit fit;
  fit.order = order;
  fit.coefficients = ChannelArray::Zero(basis_size(order), 3);
  double area = 0;
  for (const int e : parts) area += elements[at(e)].area;
  std::vector<Eigen::MatrixXd> to_part;
  for (const int e : parts) {
    const FittedElement& part = elements[at(e)];
    std::array<TrianglePlace, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = place_of(triangle, part.triangle[k]);
    to_part.push_back(restriction(order, corners));
    const ChannelArray& own = part.fit.coefficients;  // of no higher order
    fit.coefficients +=
        part.area / area * (to_part.back().topRows(own.rows()).transpose() * own.matrix()).array();
  }
  double square = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const FittedElement& part = elements[at(parts[k])];
    ChannelArray off = (to_part[k] * fit.coefficients.matrix()).array();
    off.topRows(part.fit.coefficients.rows()) -= part.fit.coefficients;
    square += part.area / area * (off.square().sum() + part.fit.error * part.fit.error);
  }
  fit.error = std::sqrt(square);
  return fit;
}

}  // namespace

std::vector<PossibleWhole> possible_wholes(const PatchMesh& mesh,
                                           std::span<const FittedElement> elements, int order,
                                           int highest_order) {
  const PatchHierarchy hierarchy = mesh.hierarchy();
  std::map<int, std::vector<int>> parts_of;
  std::vector<bool> has_others(hierarchy.parent.size(), false);
  for (std::size_t node = 0; node < hierarchy.parent.size(); ++node) {
    const int whole = hierarchy.parent[node], e = hierarchy.element[node];
    if (whole < 0) continue;
    if (e >= 0 && elements[at(e)].is_checked && !elements[at(e)].is_broken)
      parts_of[whole].push_back(e);
    else
      has_others[at(whole)] = true;
  }
  std::vector<PossibleWhole> wholes;
  for (auto& [node, parts] : parts_of) {
    if (has_others[at(node)]) continue;
    int highest = 0, unknowns = 0;
    double before = 0, area = 0, weight = 0;
    for (const int e : parts) {
      const FittedElement& part = elements[at(e)];
      highest = std::max(highest, part.fit.order);
      unknowns += basis_size(part.fit.order);
      before += part.square_error();
      area += part.area;
      weight += part.area * part.weight;
    }
    if (!(area > 0)) continue;
    PossibleWhole best{node, parts, {}, 0, 0};
    for (int p = highest; p <= (order >= 0 ? order : std::min(highest + 1, highest_order)); ++p) {
      const int fewer = unknowns - basis_size(p);
      if (fewer <= 0) break;
      ElementFit fit = fit_to_parts(mesh.triangle(node), elements, parts, p);
      const double excess = weight * fit.error * fit.error - before;
      const double unknown =
          differs * before + weight * std::pow(rounding, 2) * fit.coefficients.square().sum();
      const double more = excess > unknown ? excess : 0;
      if (best.fewer > 0 && rounded(more * best.fewer) >= rounded(best.more * fewer)) continue;
      best.fit = std::move(fit);
      best.more = more;
      best.fewer = fewer;
    }
    if (best.fewer > 0) wholes.push_back(std::move(best));
  }
  std::stable_sort(wholes.begin(), wholes.end(), [](const auto& a, const auto& b) {
    return rounded(a.more / a.fewer) < rounded(b.more / b.fewer);
  });
  return wholes;
}

}  // namespace halfshade
