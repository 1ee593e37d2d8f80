#include "solver/pipeline/direct_rays.h"

#include "meshing/core/error.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/lit_places.h"
#include "solver/pipeline/lit_surfaces.h"
#include "solver/pipeline/spread_places.h"

#include <fmt/format.h>

#include <algorithm>

namespace halfshade {
namespace {

/// Fewer surfaces are looked through as quickly as by rays; at smaller tolerances polynomials
/// of higher orders need fewer places.
constexpr std::size_t many_surfaces = 100;
constexpr double loose = 0.01;
constexpr int tried_places = 100;
/// Looks from a few small surfaces may take most of the time.
constexpr int tried_surfaces = 1000;
/// Of the places: so many with light tell its mean, or rather less, which is on the safe side.
constexpr double enough_lit = 3;
/// In rays: exact looks that take more than this are not worth trying more of; about a second.
constexpr double most_to_tell = 5e6;
/// The same where no light was found yet.
constexpr double most_in_the_dark = 2e7;
constexpr std::size_t places_at_once = 10;
constexpr std::size_t first_places = 2;  ///< each may take seconds
/// Looks that a surface takes, at least. In nets and railings most are small and close to each
/// other, and looks from there take a thousand times as long as from a wall.
constexpr double looks_of_surface = 6;
/// Looks that are taken where light varies, about.
constexpr double looks_where_it_varies = 1e4;
constexpr double rays_of_hour = 3600 * most_to_tell;  ///< about
/// Of the tolerance: standard deviation of a value, relative to the mean irradiance.
constexpr double deviation_for_tolerance = 1.5;
/// A place may take so much of what an exact look takes: rays do with about as many places. Where
/// most places take more by rays they are looked at exactly all the same, which must not make it a
/// draw: polynomials that are fitted to noise are of low orders.
constexpr double as_quick = 0.8;

/// The first few of them are spread like all.
std::vector<SurfacePoint> mixed(const std::vector<SurfacePoint>& points) {
  std::vector<SurfacePoint> result;
  for (std::size_t first = 0; first < places_at_once; ++first)
    for (std::size_t k = first; k < points.size(); k += places_at_once) result.push_back(points[k]);
  return result;
}

/// What exact looks take.
struct ExactWork {
  SightEffort effort;
  double crowd_work = 0;
  double irradiance = 0, reached = 0;  ///< sum, and at how many places there is any

  double rays() const { return in_rays(effort, crowd_work); }
};

/// Looks at the points, or at as many as tell enough where each takes very long: the others are
/// dropped. Some light has to be among them, or it took far too long.
ExactWork look_exactly(const DirectLightIndex& index, std::vector<SurfacePoint>& points,
                       const Progress& progress) {
  ExactWork work;
  for (std::size_t first = 0, count = first_places; first < points.size() && !progress.stopped();
       first += count, count = places_at_once) {
    if (work.rays() > (work.reached > 0 ? most_to_tell : most_in_the_dark)) {
      points.resize(first);
      break;
    }
    count = std::min(count, points.size() - first);
    for (const DirectLight& light :
         index.irradiance(std::span(points).subspan(first, count), progress)) {
      work.effort += light.effort;
      work.crowd_work += static_cast<double>(light.crowd_work);
      const double irradiance = light.irradiance.mean();
      if (!(irradiance > 0)) continue;
      work.irradiance += irradiance;
      ++work.reached;
    }
  }
  return work;
}

/// W/m²: the mean of those of the places that are reached, or, if hardly any are, where light
/// falls.
double mean_where_lit(const PreparedScene& prepared, const ExactWork& exact,
                      const Progress& progress) {
  const double mean = exact.reached > 0 ? exact.irradiance / exact.reached : 0;
  if (exact.reached >= enough_lit) return mean;
  const double found = mean_over_lit_area(
      prepared, [](const Rgb& light) { return light.mean(); }, progress);
  return found > 0 ? found : mean;
}

/// Rays follow light that arrives. Throws Error(too_large) where none was found, and exact looks
/// would take hours.
void require_light(const SoundScene& scene, const ExactWork& work, std::size_t places) {
  const double hours = work.rays() / static_cast<double>(places) * looks_of_surface *
                       static_cast<double>(scene.surfaces.size()) / rays_of_hour;
  if (work.rays() <= most_in_the_dark || hours < 1) return;
  throw Error(ErrorCode::too_large, {},
              fmt::format("exact direct light past {} surfaces takes some {:.0f} hours, and none "
                          "arrives at {} places; --visibility exact takes all the time there is",
                          scene.surfaces.size(), hours, places));
}

/// Places of one kind, and what exact looks take at some of them.
struct TriedPlaces {
  std::vector<SurfacePoint> points;
  ExactWork exact = {};

  double exact_rays() const { return exact.rays() / static_cast<double>(points.size()); }
  double rays(const RayLight& light) const {
    double sum = 0;
    for (const SurfacePoint& point : points) sum += light.cost(point);
    return sum / static_cast<double>(points.size());
  }
  /// For each emitter that is looked at.
  double exact_rays_of_look() const {
    return exact.effort.looks > 0 ? exact.rays() / static_cast<double>(exact.effort.looks) : 0;
  }
};

/// At how many places of both kinds light is looked for, about.
struct ExpectedLooks {
  double by_area = 0, by_surface = 0;

  double sum(double of_area, double of_surface) const {
    return by_area * of_area + by_surface * of_surface;
  }
};

/// Elements gather where light varies, on the largest surfaces or on all the small ones: both count
/// the same.
ExpectedLooks expected_looks(std::size_t surfaces) {
  return {looks_where_it_varies,
          looks_where_it_varies + looks_of_surface * static_cast<double>(surfaces)};
}

}  // namespace

RayLightOptions direct_rays(const PreparedScene& prepared, const SolveOptions& options,
                            const Progress& progress) {
  const SoundScene& scene = prepared.scene();
  if (options.method != SolveMethod::fields || options.refine != Refinement::adaptive ||
      options.visibility == ReflectedVisibility::exact || !options.goal.empty() ||
      options.force.discontinuities || options.force.exact_direct_light || options.order >= 0 ||
      options.tolerance < loose || scene.surfaces.size() < many_surfaces)
    return {};
  const std::vector<int> ids = lit_surfaces(scene, unnoticed_of_tolerance * options.tolerance);
  TriedPlaces by_area{mixed(spread_places(scene, ids, tried_places).points)};
  TriedPlaces by_surface{mixed(places_of_surfaces(scene, ids, tried_surfaces))};
  by_area.exact = look_exactly(prepared.direct_light(), by_area.points, progress);
  if (progress.stopped() || by_area.points.empty()) return {};
  const double irradiance = mean_where_lit(prepared, by_area.exact, progress);
  if (!(irradiance > 0)) require_light(scene, by_area.exact, by_area.points.size());
  by_surface.exact = look_exactly(prepared.direct_light(), by_surface.points, progress);
  // Places that lie before no emitter take nothing.
  if (!(irradiance > 0) || by_area.exact.effort.looks == 0 || progress.stopped()) return {};
  RayLightOptions rays;
  rays.deviation = deviation_for_tolerance * options.tolerance * irradiance;
  rays.most_rays = std::max({by_area.exact_rays_of_look(), by_surface.exact_rays_of_look(), 1.});
  const ExpectedLooks looks = expected_looks(ids.size());
  const RayLight light(scene, prepared.direct_light(), prepared.visibility(), rays);
  const bool are_better = looks.sum(by_area.rays(light), by_surface.rays(light)) <
                          as_quick * looks.sum(by_area.exact_rays(), by_surface.exact_rays());
  return are_better ? rays : RayLightOptions{};
}

}  // namespace halfshade
