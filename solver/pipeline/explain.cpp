#include "solver/pipeline/explain.h"

#include "meshing/patches/patch_mesh.h"
#include "solver/exchange/cells.h"
#include "solver/pipeline/blockers.h"
#include "solver/pipeline/limits.h"
#include "solver/pipeline/lit_backs.h"
#include "solver/pipeline/solve_fields.h"
#include "solver/pipeline/solve_mesh.h"
#include "solver/reflected/reflected_cost.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace halfshade {
namespace {

/// About how many elements tell which parts of space there are; so many surfaces do by themselves,
/// whatever elements they take.
constexpr int elements_for_parts = 2000;
constexpr std::size_t any_number = 1'000'000'000;
/// Measured on two cores: points with exact direct light a second from an emitter in penumbra, form
/// factors a second, rays a second.
constexpr double points_rate = 2e5, factors_rate = 8e5, rays_rate = 6e6;

std::vector<SpacePart> find_parts(const SoundScene& scene, const Progress& progress) {
  PlanarMeshOptions coarse;
  if (scene.surfaces.size() > at(elements_for_parts))
    coarse.min_angle = 0;
  else
    coarse.max_length = length_for_count(scene, elements_for_parts);
  coarse.max_triangles = any_number;
  const ElementTable elements = PatchMesh(scene, coarse, progress).elements();
  const SpaceCells cells = find_cells(scene, elements);
  std::vector<std::set<std::string>> groups(at(cells.count()));
  std::vector<SpacePart> all(groups.size());
  std::vector<std::set<int>> fronts(groups.size()), backs(groups.size());
  for (int e = 0; e < elements.count(); ++e) {
    const std::size_t cell = at(cells.before(e));
    fronts[cell].insert(elements.surface[at(e)]);
    backs[at(cells.of_side[at(e)][1])].insert(elements.surface[at(e)]);
    groups[cell].insert(scene.groups[at(elements.group[at(e)])]);
    all[cell].area += elements.area[at(e)];
    const Material& material = scene.materials[at(elements.material[at(e)])];
    all[cell].lit = all[cell].lit || (material.exitance > 0).any();
  }
  std::vector<SpacePart> parts;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (groups[k].empty()) continue;
    all[k].groups.assign(groups[k].begin(), groups[k].end());
    all[k].closed = cells.closed[k];
    const int surface = first_lit_back(
        scene, {{fronts[k].begin(), fronts[k].end()}, {backs[k].begin(), backs[k].end()}});
    if (surface >= 0) all[k].swallowing = scene.groups[at(scene.surfaces[at(surface)].group)];
    parts.push_back(std::move(all[k]));
  }
  return parts;
}

/// Pairs of elements that face each other, if all surfaces are meshed alike.
double count_factors(const SoundScene& scene, int elements) {
  double all = 0, squares = 0;
  for (const Surface& surface : scene.surfaces) {
    all += area(surface);
    squares += std::pow(area(surface), 2);
  }
  return std::pow(elements, 2) * (1 - squares / (all * all)) / 2;
}

std::string rays_needless(const ExchangeOptions& options, bool is_clear) {
  if (options.factors == FactorsBy::exact) return "visible parts are exact";
  const bool is_by_pairs = options.factors == FactorsBy::rays;
  return is_by_pairs && is_clear ? "no surface can come between two others" : "";
}

double count_rays(const SolveOptions& options, double factors) {
  if (options.exchange.factors == FactorsBy::rays) return factors * options.exchange.rays_per_pair;
  return 3. * options.elements * std::pow(options.exchange.hemicube_pixels, 2);
}

PlannedStage plan_reflected_light(const SoundScene& scene, const Plan& plan,
                                  const SolveOptions& options) {
  constexpr double cores = 2;
  PlannedStage stage{"reflected light", plan.no_factors, "factors", 0, "", 0, ""};
  if (!plan.no_factors.empty()) return stage;
  const ReflectedCost cost =
      reflected_cost(static_cast<int>(scene.surfaces.size()),
                     reflected_options(scene, plan, options, options.tolerance, nullptr));
  stage.seconds = cost.cpu_seconds / cores;
  stage.how = cost.is_exact ? "by exactly visible parts" : "by rays over hemispheres";
  return stage;
}

/// Whether curves are only looked for where elements without them are too many.
bool tells_if_they_pay(const SolveOptions& options) {
  return options.method == SolveMethod::fields && options.refine == Refinement::adaptive &&
         !options.force.discontinuities;
}

std::vector<PlannedStage> plan_stages(const SoundScene& scene, const Plan& plan,
                                      const SolveOptions& options, bool any_closed) {
  const double n = options.elements, factors = count_factors(scene, options.elements);
  const bool is_clear = blocking_surfaces(scene).empty();
  double emitters = 0;
  for (const Surface& surface : scene.surfaces)
    emitters += (scene.materials[at(surface.material)].exitance > 0).any();
  const double points = n * emitters * options.direct_points;
  std::vector<PlannedStage> stages;
  stages.push_back({"discontinuities", plan.no_discontinuities, "discontinuities",
                    static_cast<double>(plan.sources.size()), "sources", 0,
                    tells_if_they_pay(options) ? "if direct light tells that they pay" : ""});
  if (plan.weak_sources > 0)
    stages.push_back({"curves of weak sources",
                      fmt::format("{} of them give too little", plan.weak_sources),
                      "discontinuities", static_cast<double>(plan.weak_sources), "sources", 0});
  if (plan.no_discontinuities.empty())
    stages.push_back({"curves at three edges", plan.no_eee, "eee", 0, "", 0});
  if (options.method == SolveMethod::fields) {
    stages.push_back({"mesh", "", "", 0, "as many elements as the tolerance takes", 0});
    stages.push_back({"exact direct light", plan.no_exact_direct_light, "direct-light", emitters,
                      "emitters", 0});
    if (plan.rays.deviation > 0)
      stages.push_back({"exactly visible parts of emitters",
                        "rays take less and are as good as the tolerance", "direct-light", 0, "",
                        0});
    stages.push_back(plan_reflected_light(scene, plan, options));
    stages.push_back({"second and third channel", plan.no_channels, "channels", 0, "", 0});
    return stages;
  }
  stages.push_back({"mesh", "", "", n, "elements", 0});
  stages.push_back({"exact direct light", plan.no_exact_direct_light, "direct-light", points,
                    "points", points / points_rate});
  stages.push_back(
      {"form factors", plan.no_factors, "factors", factors, "pairs", factors / factors_rate});
  if (plan.no_factors.empty()) {
    const std::string needless = rays_needless(options.exchange, is_clear);
    const double rays = needless.empty() ? count_rays(options, factors) : 0;
    stages.push_back({"visibility rays", needless, "", rays, "rays at most", rays / rays_rate});
    stages.push_back({"closure", any_closed ? "" : "light can leave the scene", "", 0, "", 0});
  }
  stages.push_back({"second and third channel", plan.no_channels, "channels", 0, "", 0});
  return stages;
}

}  // namespace

Explanation explain(const PreparedScene& prepared, const SolveOptions& given,
                    const Progress& progress) {
  const SolveOptions options = with_limits(given, prepared.scene().surfaces.size());
  require_few_surfaces(prepared.scene(), options);  // as solve does
  Explanation explanation;
  explanation.scene = prepared.scene();
  explanation.unit = prepared.unit();
  explanation.warnings = prepared.warnings();
  if (!has_emitter(prepared.scene())) {
    explanation.parts = find_parts(prepared.scene(), progress);
    explanation.stages = {{"all light",
                           "no face emits any; give a material an exitance (Ke in an MTL file, or "
                           "'exitance' or 'temperature' in a materials file)",
                           "", 0, "", 0}};
    return explanation;
  }
  std::vector<StageReport> reports;
  Stages stages(reports);
  explanation.plan = make_plan(prepared, options, progress, stages);
  explanation.parts = find_parts(prepared.scene(), progress);
  bool any_closed = false;
  for (const SpacePart& part : explanation.parts) any_closed = any_closed || part.closed;
  explanation.stages = plan_stages(prepared.scene(), explanation.plan, options, any_closed);
  return explanation;
}

}  // namespace halfshade
