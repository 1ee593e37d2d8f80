#include "solver/reflected/near_slits.h"

#include "solver/elements/polynomial.h"
#include "solver/elements/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace halfshade {
namespace {

/// Surfaces that face an element, by the cosine between their normals, closer than this share of
/// its size: no slit but a gap.
constexpr double facing = -0.5, close = 0.5;
/// A slit shows if, so close to an edge or a corner, as a share of the way to what is before it, so
/// much less is seen than nodes tell.
constexpr double at_edge = 1e-9, slit_step = 0.02;
constexpr std::array<double, 3> along_edge = {0.15, 0.5, 0.85};
/// Strips halve until what is seen in the last one changes by less than this.
constexpr double even_strip = 1e-3;
constexpr int most_strips = 30;
constexpr int strip_degree = 6;
/// See unsure_part_of_slit.
constexpr double least_unsure = 0.01, unsure_of_width = 0.5;

const TrianglePlace centroid(1. / 3, 1. / 3);

class SlitIntegrals {
 public:
  SlitIntegrals(const ElementView& view, const Eigen::VectorXd& seen_at_nodes)
      : view_(view),
        order_(view.mesh.order[at(view.mesh.triangle[at(view.element)])]),
        polynomial_(element_nodes_of(order_).fit * seen_at_nodes),
        basis_(basis_size(order_)) {}

  double missed = 0;  ///< ∫ ω (ω − what nodes tell of it), in the mean over the element
  double height = HUGE_VAL;  ///< how far slits reach into the element, scene units

  /// The third of the element along one of its edges.
  void add_third(const TrianglePlace& from, const TrianglePlace& to) {
    if (is_slit({from, to, centroid, centroid})) return add({from, to, centroid, centroid});
    const TrianglePlace middle = (from + to) / 2;
    for (const TrianglePlace& corner : {from, to})
      if (const Fan fan{corner, corner, middle, centroid}; is_slit(fan)) add(fan);
  }

 private:
  /// Places between an edge, or a corner twice, and what is before it; either may have no length.
  struct Fan {
    TrianglePlace from, to, before_from, before_to;

    TrianglePlace place(double along, double depth) const {
      const TrianglePlace at_edge = from + along * (to - from),
                          before = before_from + along * (before_to - before_from);
      return at_edge + depth * (before - at_edge);
    }
  };

  /// ω
  double seen(const TrianglePlace& place) {
    const SurfacePoint point = view_.sight.point_of(view_.mesh.root(view_.element),
                                                    view_.mesh.position(view_.element, place));
    double sum = 0;
    for (const Sighted& target : view_.targets) {
      view_.sight.see(point, target, part_);
      sum += part_.factor;
    }
    return std::clamp(sum, 0., 1.);
  }

  double told_by_nodes(const TrianglePlace& place) {
    basis_at(order_, place, basis_);
    return basis_.dot(polynomial_);
  }

  bool is_slit(const Fan& fan) {
    return std::any_of(along_edge.begin(), along_edge.end(), [&](double along) {
      const TrianglePlace place = fan.place(along, at_edge);
      return seen(place) < told_by_nodes(place) - slit_step;
    });
  }

  void add(const Fan& fan) {
    const double least = seen(fan.place(0.5, at_edge)), most = seen(fan.place(0.5, 1));
    int strips = 1;
    double half = 1;  // depth at which half of the step is left
    for (; strips < most_strips; ++strips) {
      const double here = seen(fan.place(0.5, std::exp2(-strips)));
      if (here > (least + most) / 2) half = std::exp2(-strips);
      if (std::abs(here - least) < even_strip) break;
    }
    double low = 0;
    for (int k = strips; k >= 0; --k) {
      const double high = std::exp2(-k);
      const TrianglePlace a = fan.place(0, low), b = fan.place(1, low), c = fan.place(1, high),
                          d = fan.place(0, high);
      add(a, b, c);
      add(a, c, d);
      low = high;
    }
    const auto position = [&](double depth) {
      return view_.mesh.position(view_.element, fan.place(0.5, depth));
    };
    height = std::min(height, half * (position(1) - position(0)).norm());
  }

  void add(const TrianglePlace& a, const TrianglePlace& b, const TrianglePlace& c) {
    const TrianglePlace ab = b - a, ac = c - a;
    const double share = std::abs(ab.x() * ac.y() - ab.y() * ac.x());  // the element's is 1
    for (const TriangleNode& node : triangle_rule(strip_degree)) {
      const TrianglePlace place = a + node.u * ab + node.v * ac;
      const double omega = seen(place);
      missed += share * node.weight * omega * (omega - told_by_nodes(place));
    }
  }

  const ElementView& view_;
  int order_;
  Eigen::VectorXd polynomial_, basis_;
  SeenPart part_;
};

bool is_faced(const ElementView& view) {
  const double size = std::sqrt(view.mesh.area(view.element));
  return std::any_of(view.targets.begin(), view.targets.end(), [&](const Sighted& target) {
    const PlaneFrame& frame = view.sight.scene().surfaces[at(target.surface)].frame;
    if (frame.normal.dot(view.normal) > facing) return false;
    const Vec3 middle = view.mesh.position(view.element, centroid);
    return frame.height(middle) < close * size;
  });
}

}  // namespace

BackShadow slit_shadow(const ElementView& view, const Eigen::VectorXd& seen_at_nodes) {
  BackShadow shadow;
  if (is_faced(view)) return shadow;
  SlitIntegrals integrals(view, seen_at_nodes);
  const std::array<TrianglePlace, 3> corners = {TrianglePlace(0, 0), TrianglePlace(1, 0),
                                                TrianglePlace(0, 1)};
  for (std::size_t k = 0; k < 3; ++k) integrals.add_third(corners[k], corners[(k + 1) % 3]);
  if (integrals.missed == 0) return shadow;
  shadow.share = integrals.missed;
  shadow.height = integrals.height;
  shadow.unsure = unsure_part_of_slit(shadow.height / std::sqrt(view.mesh.area(view.element)));
  return shadow;
}

double unsure_part_of_slit(double width) {
  return std::min(1., least_unsure + unsure_of_width * width);
}

}  // namespace halfshade
