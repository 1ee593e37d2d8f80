#include "solver/pipeline/measured_error.h"

#include "meshing/geometry/mix_bits.h"
#include "solver/elements/element_field.h"

#include <algorithm>
#include <vector>

namespace halfshade {
namespace {

constexpr int fewest_places = 6000, most_of_element = 40;

/// Spread evenly over the triangle.
TrianglePlace random_place(std::uint64_t number) {
  const double u = unit_share(mix_bits(2 * number)), v = unit_share(mix_bits(2 * number + 1));
  return u + v <= 1 ? TrianglePlace(u, v) : TrianglePlace(1 - u, 1 - v);
}

}  // namespace

Eigen::ArrayXd measured_error(const PreparedScene& prepared, const ElementTable& elements,
                              const ChannelArray& direct_irradiance, const Progress& progress) {
  const int count = elements.count();
  Eigen::ArrayXd error = Eigen::ArrayXd::Zero(count);
  if (count == 0) return error;
  const int of_each = std::clamp((fewest_places + count - 1) / count, 1, most_of_element);
  std::vector<SurfacePoint> places;
  for (int e = 0; e < count; ++e)
    for (int k = 0; k < of_each; ++k) {
      const PlaneFrame& frame = prepared.scene().surfaces[at(elements.surface[at(e)])].frame;
      const TrianglePlace place = random_place(at(e) * at(of_each) + at(k));
      places.push_back({frame.foot(position(elements.triangle(e), place)), frame.normal});
    }
  const std::vector<DirectLight> light = prepared.direct_light().irradiance(places, progress);
  if (progress.stopped()) return error;
  for (std::size_t k = 0; k < light.size(); ++k) {
    const auto e = static_cast<Eigen::Index>(k / at(of_each));
    const Rgb off = light[k].irradiance - direct_irradiance.row(e).transpose();
    error[e] += off.square().mean() / of_each;
  }
  return error.sqrt();
}

}  // namespace halfshade
