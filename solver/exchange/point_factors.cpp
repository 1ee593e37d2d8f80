#include "solver/exchange/point_factors.h"

#include "meshing/core/parallel.h"
#include "solver/direct/direct_light.h"
#include "solver/elements/quadrature.h"
#include "solver/exchange/element_soup.h"
#include "solver/exchange/form_factor.h"
#include "solver/exchange/hemicube.h"
#include "solver/exchange/surface_pairs.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

namespace halfshade {
namespace {

/// Of the rule that averages exact factors over an element: six points.
constexpr int rule_degree = 4;

/// Adds the factors from one element to all, zero on entry.
using RowFiller = std::function<void(int element, std::span<double> factors)>;

RowFiller hemicube_rows(const SoundScene& scene, const ElementTable& elements, int pixels) {
  const auto cube = std::make_shared<const Hemicube>(make_hemicube(pixels));
  const auto items = std::make_shared<const VisibilityIndex>(element_soup(scene, elements));
  return [cube, items, &elements](int element, std::span<double> factors) {
    const auto t = elements.triangle(element);
    add_hemicube(*cube, {(t[0] + t[1] + t[2]) / 3, elements.normal[at(element)], t[1] - t[0]},
                 *items, elements.normal, factors);
  };
}

/// Exact factors from points to elements.
class ExactFactors {
 public:
  ExactFactors(const SoundScene& scene, const ElementTable& elements,
               const VisibilityIndex& visibility, const Progress& progress)
      : scene_(scene),
        elements_(elements),
        sight_(scene),
        pairs_(scene, visibility, progress),
        of_surface_(scene.surfaces.size()) {
    for (int e = 0; e < elements.count(); ++e)
      of_surface_[at(elements.surface[at(e)])].push_back(e);
  }

  void add_row(int element, std::span<double> factors) const {
    const auto [a, b, c] = elements_.triangle(element);
    const int r = elements_.surface[at(element)];
    for (const TriangleNode& node : triangle_rule(rule_degree)) {
      const SurfacePoint point{a + node.u * (b - a) + node.v * (c - a),
                               elements_.normal[at(element)]};
      for (int s = 0; s < static_cast<int>(of_surface_.size()); ++s)
        if (s != r && pairs_.sight(r, s) != Sight::none)
          add_surface(point, s, pairs_.sight(r, s), node.weight, factors);
    }
  }

 private:
  void add_surface(const SurfacePoint& point, int s, Sight sight, double weight,
                   std::span<double> factors) const {
    VisiblePart part;
    if (sight == Sight::sampled) {
      sight_.visible_part(point, s, part);
      if (part.region == Region::umbra || part.region == Region::away) return;
    }
    if (sight == Sight::clear || part.region == Region::lit) {
      for (const int e : of_surface_[at(s)])
        factors[at(e)] +=
            weight * point_to_polygon(point.position, point.normal, elements_.triangle(e));
      return;
    }
    const auto rings = visible_rings(part, point.position, scene_.surfaces[at(s)].frame);
    for (const int e : of_surface_[at(s)])
      factors[at(e)] += weight * std::max(0., seen_of(point, e, rings));
  }

  /// Lambert's sum over what of an element lies in rings. Cutting rings that are not convex leaves
  /// edges there and back along the cut, which add nothing.
  double seen_of(const SurfacePoint& point, int element,
                 const std::vector<std::vector<Vec3>>& rings) const {
    const auto t = elements_.triangle(element);
    double sum = 0;
    for (std::vector<Vec3> ring : rings) {
      for (std::size_t k = 0; k < 3 && !ring.empty(); ++k)
        ring =
            clip_to_front(ring, t[k], elements_.normal[at(element)].cross(t[(k + 1) % 3] - t[k]));
      if (!ring.empty()) sum += lambert_sum(point.position, point.normal, ring);
    }
    return sum;
  }

  const SoundScene& scene_;
  const ElementTable& elements_;
  DirectLightIndex sight_;
  SurfacePairs pairs_;
  std::vector<std::vector<int>> of_surface_;
};

struct PointFactorEntry {
  int column;
  double value;
};
using FactorRows = std::vector<std::vector<PointFactorEntry>>;

/// The mean of the matrix of these rows, which are sorted, and its transpose.
ExchangeMatrix reciprocal(FactorRows rows) {
  const auto n = static_cast<Eigen::Index>(rows.size());
  std::size_t count = 0;
  for (const auto& row : rows) count += row.size();
  ExchangeMatrix one_way(n, n);
  one_way.reserve(static_cast<Eigen::Index>(count));
  for (Eigen::Index i = 0; i < n; ++i) {
    one_way.startVec(i);
    for (const PointFactorEntry& entry : rows[static_cast<std::size_t>(i)])
      one_way.insertBack(i, entry.column) = entry.value;
    rows[static_cast<std::size_t>(i)] = {};
  }
  one_way.finalize();
  const ExchangeMatrix other_way = one_way.transpose();
  return 0.5 * (one_way + other_way);
}

}  // namespace

AssembledFactors factors_from_points(const SoundScene& scene, const ElementTable& elements,
                                     const SpaceCells& cells, const VisibilityIndex& visibility,
                                     const ExchangeOptions& options, const Progress& progress) {
  const bool is_hemicube = options.factors == FactorsBy::hemicube;
  RowFiller fill;
  std::unique_ptr<ExactFactors> exact;
  if (is_hemicube) {
    fill = hemicube_rows(scene, elements, options.hemicube_pixels);
  } else {
    exact = std::make_unique<ExactFactors>(scene, elements, visibility, progress);
    fill = [&exact](int element, std::span<double> factors) { exact->add_row(element, factors); };
  }
  const std::size_t n = elements.corners.size();
  FactorRows rows(n);
  const auto fill_row = [&](std::size_t i) {
    const int element = static_cast<int>(i);
    std::vector<double> factors(n, 0);
    fill(element, factors);
    for (int j = 0; j < static_cast<int>(n); ++j)
      if (factors[at(j)] > 0 && cells.before(j) == cells.before(element))
        rows[i].push_back({j, elements.area[i] * factors[at(j)]});
  };
  AssembledFactors result;
  result.complete = parallel_for(n, fill_row, progress, "form factors");
  result.is_missing.assign(n, result.complete ? 0 : 1);
  if (!result.complete) rows.assign(n, {});
  result.matrix = reciprocal(std::move(rows));
  if (is_hemicube)
    result.rays = n * static_cast<std::size_t>(options.hemicube_pixels) *
                  static_cast<std::size_t>(options.hemicube_pixels) * 3;
  return result;
}

}  // namespace halfshade
