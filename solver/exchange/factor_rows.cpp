#include "solver/exchange/factor_rows.h"

#include "solver/direct/direct_light.h"
#include "solver/elements/quadrature.h"
#include "solver/exchange/element_soup.h"
#include "solver/exchange/form_factor.h"
#include "solver/exchange/hemicube.h"
#include "solver/exchange/surface_pairs.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

FactorRowFiller hemicube_rows(const SoundScene& scene, const ElementTable& elements, int pixels) {
  const auto cube = std::make_shared<const Hemicube>(make_hemicube(pixels));
  const auto items = std::make_shared<const VisibilityIndex>(element_soup(scene, elements));
  return [cube, items, &elements](const FactorViewer& viewer, std::span<double> factors) {
    const auto& t = viewer.triangle;
    add_hemicube(*cube, {(t[0] + t[1] + t[2]) / 3, viewer.normal, t[1] - t[0]}, *items,
                 elements.normal, factors);
  };
}

/// Exact factors from points to elements.
class ExactFactors {
 public:
  ExactFactors(const SoundScene& scene, const ElementTable& elements,
               const VisibilityIndex& visibility, int degree, const Progress& progress)
      : scene_(scene),
        elements_(elements),
        degree_(degree),
        sight_(scene),
        pairs_(scene, visibility, progress),
        of_surface_(scene.surfaces.size()) {
    for (int e = 0; e < elements.count(); ++e)
      of_surface_[at(elements.surface[at(e)])].push_back(e);
  }

  void add_row(const FactorViewer& viewer, std::span<double> factors) const {
    const auto& [a, b, c] = viewer.triangle;
    const int r = viewer.surface;
    for (const TriangleNode& node : triangle_rule(degree_)) {
      const SurfacePoint point{a + node.u * (b - a) + node.v * (c - a), viewer.normal};
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
  int degree_;
  DirectLightIndex sight_;
  SurfacePairs pairs_;
  std::vector<std::vector<int>> of_surface_;
};

}  // namespace

FactorRowFiller make_row_filler(const SoundScene& scene, const ElementTable& elements,
                                const VisibilityIndex& visibility, const ExchangeOptions& options,
                                int degree, const Progress& progress) {
  if (options.factors == FactorsBy::hemicube)
    return hemicube_rows(scene, elements, options.hemicube_pixels);
  const auto exact =
      std::make_shared<const ExactFactors>(scene, elements, visibility, degree, progress);
  return [exact](const FactorViewer& viewer, std::span<double> factors) {
    exact->add_row(viewer, factors);
  };
}

}  // namespace halfshade
