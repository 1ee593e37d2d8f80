#include "solver/pipeline/measured_error.h"

#include "solver/elements/balancing_scale.h"
#include "solver/exchange/ray_sequence.h"
#include "solver/pipeline/direct_work.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <vector>

namespace halfshade {
namespace {

constexpr double usual_places = 6000;

/// Those of an element follow each other.
struct Places {
  std::vector<FieldPoint> points;
  std::vector<int> count;  ///< element → how many
};

/// Half of them as many for equal areas, half as many for an equal part of the square of the light,
/// which a few small elements may hold; at least one on each element.
Places spread_over(const ElementTable& elements, const Eigen::ArrayXd& light) {
  const Eigen::Map<const Eigen::ArrayXd> area(elements.area.data(), elements.count());
  const Eigen::ArrayXd squares = area * (light / std::max(light.maxCoeff(), DBL_MIN)).square();
  const Eigen::ArrayXd share =
      area / (2 * area.sum()) + squares / (2 * std::max(squares.sum(), DBL_MIN));
  Places places;
  for (int e = 0; e < elements.count(); ++e) {
    places.count.push_back(std::max(1, static_cast<int>(std::lround(usual_places * share[e]))));
    const RaySequence sequence(at(e));
    for (int k = 0; k < places.count.back(); ++k) {
      const auto u = sequence[k];
      places.points.push_back({{point_on(elements.triangle(e), u[0], u[1]), elements.normal[at(e)]},
                               elements.surface[at(e)]});
    }
  }
  return places;
}

}  // namespace

Eigen::ArrayXd measured_error(const PreparedScene& prepared, const ElementTable& elements,
                              const ChannelArray& direct_irradiance, const Progress& progress) {
  Eigen::ArrayXd error = Eigen::ArrayXd::Zero(elements.count());
  const Places places = spread_over(elements, direct_irradiance.rowwise().maxCoeff());
  DirectWork work;
  const std::vector<Rgb> exact =
      direct_light_at(prepared.scene(), prepared.direct_light(), work)(places.points, progress);
  if (progress.stopped()) return error;
  double largest = direct_irradiance.maxCoeff();
  for (const Rgb& light : exact) largest = std::max(largest, light.maxCoeff());
  // Squares of light of any size must not over- or underflow.
  const double scale = balancing_scale(largest);
  auto light = exact.begin();
  for (int e = 0; e < elements.count(); ++e)
    for (int k = 0; k < places.count[at(e)]; ++k, ++light) {
      const Rgb off = scale * (*light - direct_irradiance.row(e).transpose());
      error[e] += off.square().mean() / places.count[at(e)];
    }
  return error.sqrt() / scale;
}

}  // namespace halfshade
