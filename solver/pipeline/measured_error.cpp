#include "solver/pipeline/measured_error.h"

#include "solver/elements/balancing_scale.h"
#include "solver/exchange/ray_sequence.h"
#include "solver/pipeline/direct_work.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace halfshade {
namespace {

constexpr double usual_places = 6000;

/// Those of an element follow each other.
struct Places {
  std::vector<FieldPoint> points;
  std::vector<int> count;  ///< element → how many
};

/// Spread evenly, as many for equal areas, at least one on each element.
Places spread_over(const ElementTable& elements) {
  const double area = std::accumulate(elements.area.begin(), elements.area.end(), 0.);
  Places places;
  for (int e = 0; e < elements.count(); ++e) {
    const double share = elements.area[at(e)] / area;
    places.count.push_back(std::max(1, static_cast<int>(std::lround(usual_places * share))));
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
  const Places places = spread_over(elements);
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
