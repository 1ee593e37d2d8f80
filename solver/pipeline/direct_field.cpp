#include "solver/pipeline/direct_field.h"

#include "meshing/core/parallel.h"
#include "solver/adapt/noisy_field.h"
#include "solver/elements/quadrature.h"
#include "solver/pipeline/blockers.h"
#include "solver/pipeline/corner_places.h"
#include "solver/pipeline/direct_meshes.h"
#include "solver/pipeline/direct_work.h"
#include "solver/pipeline/lit_surfaces.h"
#include "solver/pipeline/narrow_places.h"
#include "solver/pipeline/near_features.h"
#include "solver/pipeline/shadow_places.h"
#include "solver/pipeline/solve_mesh.h"
#include "solver/pipeline/spot_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace halfshade {
namespace {

/// Finding curves and light along them take as long as so many times the samples of direct light
/// that the search's work is worth. Measured from 4 to 11 in seven scenes of all sizes; towards
/// curves, for elements along them are fewer.
constexpr double times_the_search = 5;
/// Of the tolerance: what curves may do that are left out.
constexpr double share_of_curves = 0.5;
/// Of the elements and unknowns that there may be, where light is reflected: the rest is for parts
/// of elements that are large because direct light is dark or even there, and reflected light is
/// not.
constexpr double share_of_direct = 0.85;

std::optional<RayLight> rays_of(const PreparedScene& prepared, const Plan& plan) {
  if (!(plan.rays.deviation > 0)) return std::nullopt;
  return RayLight(prepared.scene(), prepared.direct_light(), prepared.visibility(), plan.rays);
}

class DirectFieldSearch {
 public:
  DirectFieldSearch(const PreparedScene& prepared, const Plan& plan, const SolveOptions& options,
                    const Progress& progress, Stages& stages, const GoalWeights* goal)
      : prepared_(prepared),
        plan_(plan),
        options_(options),
        progress_(progress),
        stages_(stages),
        goal_(goal),
        blockers_(
            blocking_surfaces(prepared.scene(), plan.lit, prepared.direct_light().emitters())),
        direct_light_(direct_light_at(prepared.scene(), prepared.direct_light(), work_)),
        rays_(rays_of(prepared, plan)) {}

  DirectField run() {
    const bool no_curves = !plan_.no_discontinuities.empty();
    if (no_curves) {
      stages_.leave_out_if(true, "discontinuities", plan_.no_discontinuities);
      fit_without_curves(0);
    } else if (!try_without_curves()) {
      fit_along_curves();
    }
    stages_.leave_out_if(plan_.weak_sources > 0, "curves of weak sources",
                         fmt::format("{} of them give too little", plan_.weak_sources));
    stages_.leave_out_if(rays_.has_value(), "exactly visible parts of emitters",
                         "rays take less and are as good as the tolerance");
    find_regions();
    return std::move(found_);
  }

 private:
  const SoundScene& scene() const { return prepared_.scene(); }

  /// What samples of exact light may overlook.
  const Watched& watched() {
    if (watched_) return *watched_;
    const auto emitters = prepared_.direct_light().emitters();
    watched_ = near_features(scene(), emitters, blockers_);
    for (const auto& more : {shadow_places(scene(), emitters, blockers_),
                             narrow_places(scene(), emitters, blockers_, progress_),
                             corner_places(scene(), emitters), spot_places(scene(), emitters)})
      watched_->places.insert(watched_->places.end(), more.begin(), more.end());
    return *watched_;
  }

  DiscontinuityOptions curves_that_count() const {
    DiscontinuityOptions events = options_.events;
    events.eee = events.eee && plan_.no_eee.empty();
    events.irradiance_tolerance = share_of_curves * options_.tolerance * plan_.mean_irradiance;
    events.max_length = length_of_elements(scene(), options_);
    return events;
  }

  /// What finding curves and following them takes, in samples of direct light.
  double samples_for_curves() const {
    if (rays_) return 0;  // which take much less than samples do
    const SearchForecast forecast = forecast_search(scene(), prepared_.opaque(), plan_.sources,
                                                    plan_.lit, curves_that_count(), progress_);
    return std::max(times_the_search * forecast.work / forecast.look, 1.);
  }

  /// False if curves are likely to pay.
  bool try_without_curves() {
    if (options_.refine != Refinement::adaptive || options_.force.discontinuities) return false;
    const double for_curves = samples_for_curves();
    fit_without_curves(for_curves);
    const FieldLimit limit = found_.light.report.limit;
    if (limit == FieldLimit::samples) return false;
    const bool is_full = limit == FieldLimit::elements || limit == FieldLimit::unknowns;
    if (is_full && for_curves > 0 && places_left(work_, options_.max_unknowns) > for_curves) {
      fit_better_along_curves();
      return true;
    }
    stages_.leave_out_if(
        true, "discontinuities",
        limit == FieldLimit::none      ? "the tolerance takes less work than finding them"
        : limit == FieldLimit::stopped ? "interrupted before it was known if they pay"
                                       : "limits were reached before it was known if they pay");
    return true;
  }

  /// Where the scene alone takes more elements than were asked for.
  void warn_of_excess(int plain_elements, bool is_searched) {
    if (has_budget(options_))
      add(mesh_warnings({scene(), 0, plain_elements, options_.elements, 0, 0, is_searched}),
          found_.warnings);
  }

  void fit_without_curves(double samples_for_curves) {
    stages_.run("mesh", [&] {
      found_.patches = std::make_shared<PatchMesh>(
          mesh_without_curves(scene(), options_, rays_.has_value(), progress_));
      return static_cast<std::size_t>(found_.patches->element_count());
    });
    warn_of_excess(found_.patches->element_count(), true);
    AdaptiveFieldOptions fit = field_options(scene(), plan_, options_, goal_);
    fit.samples_of_other_way = samples_for_curves;
    fit_on_patches(fit);
  }

  /// Along curves fewer elements do: whichever comes closer is kept.
  void fit_better_along_curves() {
    DirectField plain = std::exchange(found_, {});
    fit_along_curves(false);
    const bool is_worse =
        !found_.patches || (found_.light.report.limit != FieldLimit::none &&
                            found_.light.report.relative_error > plain.light.report.relative_error);
    if (!is_worse) return;
    plain.discontinuities = found_.discontinuities;
    found_ = std::move(plain);
  }

  /// If that takes more elements than there may be, either without curves or not at all.
  void fit_along_curves(bool may_fall_back = true) {
    SolveMesh plain;
    if (has_budget(options_))
      stages_.run("mesh", [&] {
        plain = make_solve_mesh(scene(), options_, progress_, least_angle_of_direct);
        return plain.elements.corners.size();
      });
    const std::string no_room =
        has_budget(options_) ? no_elements_for_curves(plain.elements.count(), options_) : "";
    warn_of_excess(plain.elements.count(), no_room.empty());
    if (!no_room.empty()) return fit_on_plain(std::move(plain), no_room);
    DiscontinuityOptions events = curves_that_count();
    rays_.reset();  // what follows curves is meant to be exact
    if (options_.force.discontinuities)
      events.most_work = 0;
    else if (!(events.most_work > 0))
      events.most_work = affordable_work(options_.tolerance);
    Discontinuities curves;
    stages_.run("discontinuities", [&] {
      curves = find_discontinuities(scene(), prepared_.opaque(), plan_.sources, events, progress_);
      return curves.curves.size();
    });
    stages_.leave_out_if(!plan_.no_eee.empty(), "curves at three edges", plan_.no_eee);
    DiscontinuityMeshOptions mesh_options;
    mesh_options.max_length = events.max_length;
    mesh_options.min_angle = least_angle_of_direct;
    mesh_options.max_triangles = static_cast<std::size_t>(options_.max_elements);
    mesh_options.irradiance_tolerance = events.irradiance_tolerance;
    mesh_options.deviation = options_.deviation;
    found_.discontinuities = curves.report;
    found_.curves = curves.curves.size();
    add(search_warnings(curves.report, options_.tolerance), found_.warnings);
    if (has_budget(options_)) return fit_some_curves(curves, std::move(plain));
    // Reflected light gets worse in narrow ones.
    const bool may_be_narrow =
        options_.refine == Refinement::adaptive && options_.order < 0 && !plan_.no_factors.empty();
    std::optional<DiscontinuityMesh> mesh;
    stages_.run("mesh along curves", [&] {
      mesh = mesh_along_curves(scene(), curves, mesh_options, may_be_narrow, progress_);
      return mesh ? static_cast<std::size_t>(mesh->patches.element_count()) : 0;
    });
    if (!mesh) {
      found_.mesh.culled = found_.curves;
      found_.warnings.push_back(
          {Warning::Kind::curves_left_out,
           fmt::format("elements do not follow the {} curves, for that would take more than the {} "
                       "that --max-elements allows",
                       found_.curves, options_.max_elements)});
      return may_fall_back ? fit_without_curves(0) : void();
    }
    found_.mesh = mesh->report;
    found_.patches = std::make_shared<PatchMesh>(std::move(mesh->patches));
    found_.discontinuity_tolerance = share_of_curves * options_.tolerance;
    fit_on_patches(field_options(scene(), plan_, options_, goal_));
  }

  void fit_on_plain(SolveMesh plain, const std::string& no_curves) {
    stages_.leave_out_if(true, "discontinuities", no_curves);
    found_.patches = std::make_shared<PatchMesh>(*std::move(plain.patches));
    fit_on_patches(field_options(scene(), plan_, options_, goal_));
  }

  /// As many of the strongest as suit the number of elements asked for.
  void fit_some_curves(const Discontinuities& curves, SolveMesh plain) {
    SolveOptions mesh_options = options_;
    mesh_options.tolerance *= share_of_curves;
    stages_.run("mesh along curves", [&] {
      SolveMesh mesh = make_solve_mesh(scene(), curves, std::move(plain), mesh_options,
                                       plan_.mean_irradiance, progress_);
      found_.mesh = mesh.report;
      found_.discontinuity_tolerance = mesh.tolerance;
      found_.patches = std::make_shared<PatchMesh>(*std::move(mesh.patches));
      return mesh.elements.corners.size();
    });
    if (found_.discontinuity_tolerance > mesh_options.tolerance)
      found_.warnings.push_back(
          {Warning::Kind::curves_left_out,
           fmt::format("elements follow only {} of the {} curves, for more take more than the {} "
                       "elements asked for with --elements",
                       found_.mesh.kept, found_.curves, options_.elements)});
    fit_on_patches(field_options(scene(), plan_, options_, goal_));
  }

  void fit_on_patches(AdaptiveFieldOptions fit) {
    if (plan_.no_factors.empty()) {
      fit.max_elements = std::max(1, static_cast<int>(share_of_direct * fit.max_elements));
      fit.max_unknowns = std::max(1, static_cast<int>(share_of_direct * fit.max_unknowns));
    }
    fit.samples_left = [this] { return places_left(work_, options_.max_unknowns); };
    fit.work_done = [this] { return work_done(work_, options_.max_unknowns); };
    fit.balance = true;
    // Without curves most splits are needed: what is merged there is soon split again.
    fit.merge = fit.split && found_.discontinuity_tolerance > 0;
    stages_.run("direct light", [&] {
      if (!rays_) try_middles(found_.patches->elements(), direct_light_, progress_);
      if (rays_)
        found_.light = fit_noisy(
            *found_.patches, direct_light_at(prepared_.scene(), *rays_, work_),
            [this](const FieldPoint& place) { return rays_->unobstructed(place.point); }, fit,
            progress_);
      else
        found_.light = fit_adaptively(*found_.patches, direct_light_, fit, progress_, watched());
      return found_.light.report.unknowns;
    });
  }

  /// In penumbra are elements whose places do not agree.
  void find_regions() {
    const ElementTable& elements = found_.light.elements;
    found_.region.assign(elements.corners.size(), Region::away);
    std::vector<TrianglePlace> places = {TrianglePlace(1. / 3, 1. / 3)};
    for (const TrianglePlace& place : gauss_rule(2).places) places.push_back(place);
    stages_.run("regions", [&] {
      parallel_for(
          elements.corners.size(),
          [&](std::size_t e) {
            const auto triangle = elements.triangle(static_cast<int>(e));
            Region& region = found_.region[e];
            if (rays_) {
              region = rays_->region(triangle, elements.normal[e], elements.surface[e]);
              return;
            }
            // Where the light hardly changes, one place will do.
            const std::size_t count = found_.light.field.order[e] == 0 ? 1 : places.size();
            for (std::size_t k = 0; k < count; ++k) {
              const PlaneFrame& frame = prepared_.scene().surfaces[at(elements.surface[e])].frame;
              const Region here = prepared_.direct_light().region(
                  {frame.foot(position(triangle, places[k])), elements.normal[e]});
              region = k == 0 || here == region ? here : Region::penumbra;
            }
          },
          progress_, "regions");
      return elements.corners.size();
    });
  }

  const PreparedScene& prepared_;
  const Plan& plan_;
  const SolveOptions& options_;
  const Progress& progress_;
  Stages& stages_;
  const GoalWeights* goal_;
  const std::vector<int> blockers_;  ///< but for those that light hardly reaches
  DirectWork work_;
  FieldAt direct_light_;
  std::optional<RayLight> rays_;    ///< that look at direct light instead
  std::optional<Watched> watched_;  ///< once it is known
  DirectField found_;
};

}  // namespace

AdaptiveFieldOptions field_options(const SoundScene& scene, const Plan& plan,
                                   const SolveOptions& options, const GoalWeights* goal) {
  AdaptiveFieldOptions result;
  result.tolerance = options.tolerance;
  result.order = options.order;
  result.split = options.refine == Refinement::adaptive;
  result.max_elements = options.max_elements;
  result.max_unknowns = options.max_unknowns;
  result.counted = mark_surfaces(scene, plan.lit);
  if (goal && goal->weight) {
    result.weight = goal->weight;
    result.norm = goal->norm;
  }
  return result;
}

DirectField find_direct_field(const PreparedScene& prepared, const Plan& plan,
                              const SolveOptions& options, const Progress& progress, Stages& stages,
                              const GoalWeights* goal) {
  return DirectFieldSearch(prepared, plan, options, progress, stages, goal).run();
}

DirectField no_direct_field(const SoundScene& scene, const SolveOptions& options,
                            const Progress& progress, Stages& stages) {
  DirectField none;
  stages.run("mesh", [&] {
    none.patches =
        std::make_shared<PatchMesh>(mesh_without_curves(scene, options, false, progress));
    none.light.elements = none.patches->elements();
    return none.light.elements.corners.size();
  });
  none.light.field = zero_field(std::vector<int>(none.light.elements.corners.size(), 0));
  none.light.error = Eigen::ArrayXd::Zero(none.light.elements.count());
  return none;
}

}  // namespace halfshade
