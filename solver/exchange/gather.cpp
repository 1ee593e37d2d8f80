#include "solver/exchange/gather.h"

#include "meshing/core/parallel.h"
#include "solver/elements/quadrature.h"
#include "solver/exchange/form_factor.h"

#include <cmath>

namespace halfshade {
namespace {

/// One point's view of all elements; keeps its buffers.
class Gatherer {
 public:
  Gatherer(const SolvedElements& solved, const VisibilityIndex& visibility)
      : solved_(solved), visibility_(visibility) {}

  Rgb gather(const SurfacePoint& point) {
    segments_.clear();
    terms_.clear();
    for (int e = 0; e < solved_.elements.count(); ++e) add_element(point, e);
    blocked_.resize(segments_.size());
    visibility_.blocked(segments_, blocked_);
    Rgb sum = Rgb::Zero();
    for (std::size_t k = 0; k < terms_.size(); ++k)
      if (!blocked_[k]) sum += terms_[k];
    return sum;
  }

 private:
  void add_element(const SurfacePoint& point, int e) {
    const auto row = static_cast<std::size_t>(e);
    const Solution& solution = solved_.solution;
    const Rgb reflected = (solution.rho.row(e) * solution.irradiance.row(e)).transpose();
    if ((reflected == 0).all()) return;
    const ElementTable& elements = solved_.elements;
    const auto corners = elements.triangle(e);
    const double height = elements.normal[row].dot(point.position - corners[0]);
    if (height < tolerance_of(solved_.scene.surfaces[at(elements.surface[row])]).length) return;
    const double factor = point_to_polygon(point.position, point.normal, corners);
    if (!(factor > 0)) return;
    const int plane = solved_.scene.surfaces[static_cast<std::size_t>(elements.surface[row])].plane;
    const auto rule = triangle_rule(2);
    const Vec3 b = corners[1] - corners[0], c = corners[2] - corners[0];
    for (const TriangleNode& node : rule) {
      segments_.push_back({point.position, corners[0] + node.u * b + node.v * c, -1, plane});
      terms_.push_back(node.weight * factor * reflected);
    }
  }

  SolvedElements solved_;
  const VisibilityIndex& visibility_;
  std::vector<Segment> segments_;
  std::vector<Rgb> terms_;
  std::vector<std::uint8_t> blocked_;
};

}  // namespace

std::vector<Rgb> reflected_irradiance(const SolvedElements& solved,
                                      const VisibilityIndex& visibility,
                                      std::span<const SurfacePoint> points,
                                      const Progress& progress) {
  std::vector<Rgb> result(points.size(), Rgb::Zero());
  constexpr std::size_t chunk = 16;
  parallel_for((points.size() + chunk - 1) / chunk,
               [&](std::size_t c) {
                 Gatherer gatherer(solved, visibility);
                 for (std::size_t k = c * chunk; k < std::min(points.size(), (c + 1) * chunk); ++k)
                   result[k] = gatherer.gather(points[k]);
               },
               progress, "gather");
  return result;
}

}  // namespace halfshade
