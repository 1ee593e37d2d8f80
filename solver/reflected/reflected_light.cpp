#include "solver/reflected/reflected_light.h"

#include "meshing/core/error.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/reflected/refinement.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>

namespace halfshade {

struct ReflectedLight::State {
  State(const SoundScene& scene, const DirectIrradiance& direct, const ReflectedOptions& options,
        const Progress& progress)
      : reflecting(make_reflecting_scene(scene, progress)),
        light(first_light(scene, reflecting.roots, direct, options.through_operator)),
        mesh(reflecting.roots) {}

  ReflectingScene reflecting;
  FirstLight light;
  double scale = 1;  ///< of all light while it is solved for: no size of it over- or underflows
  ReflectedMesh mesh;
  ElementTable elements;
  ElementField field;
  std::optional<QuickField> irradiance, leaving;
  ReflectedReport report;
};

namespace {

/// Rays from a node that are kept: strata².
constexpr int kept_strata = 10;
/// With these many elements of order 2 plain rooms come to this error.
constexpr double usual_elements = 200, usual_error = 0.01;
constexpr double usual_rays = 300;

/// Errors that the estimate sees are reflected on, too: a little more than that is claimed.
constexpr double comes_back = 1.2;

void check(const ReflectedOptions& options) {
  if (options.order < 0 || options.order > max_reflected_order)
    throw Error(ErrorCode::contract, "reflected_light",
                fmt::format("order {} must lie in [0, {}]", options.order, max_reflected_order));
  if (!(options.tolerance > 0) || !(options.max_length >= 0) || options.max_rays < 32 ||
      options.max_elements < 1 || options.max_rounds < 1)
    throw Error(ErrorCode::contract, "reflected_light",
                "the tolerance must be > 0, max_length ≥ 0, max_rays ≥ 32, and elements and rounds "
                "at least 1");
}

/// Elements as long as this to begin with.
double first_length(const ElementTable& roots, const ReflectedOptions& options) {
  constexpr double mean_area = 0.3;  // of elements that are at most 1 long, see make_reflected_mesh
  const double wanted =
      std::clamp(usual_elements * std::pow(usual_error / options.tolerance, 2. / 3), 50., 5000.);
  const double area = std::accumulate(roots.area.begin(), roots.area.end(), 0.);
  const double length = std::sqrt(area / (mean_area * wanted));
  return options.max_length > 0 ? std::min(options.max_length, length) : length;
}

int first_rays(const ReflectedOptions& options) {
  const double rays = usual_rays * std::pow(usual_error / options.tolerance, 1.5);
  return std::min(options.max_rays, std::max(48, static_cast<int>(rays)));
}

bool reflects_nothing(const FirstLight& light) {
  const auto is_zero = [](const Rgb& x) { return (x == 0).all(); };
  return std::all_of(light.exitance.begin(), light.exitance.end(), is_zero) ||
         (!light.through_operator && std::all_of(light.rho.begin(), light.rho.end(), is_zero));
}

/// Brings the strongest exitance to about 1, by a power of two.
void scale_light(ReflectedLight::State& state) {
  double largest = 0;
  for (const Rgb& e : state.light.exitance) largest = std::max(largest, e.maxCoeff());
  if (!(largest > 0)) return;
  state.scale = std::ldexp(1., -std::ilogb(largest));
  for (Rgb& e : state.light.exitance) e *= state.scale;
  state.light.direct = [direct = std::move(state.light.direct), scale = state.scale](
                           int surface, const Vec3& p) { return Rgb(scale * direct(surface, p)); };
}

/// The rounds of solving, estimating and refining.
class Rounds {
 public:
  Rounds(ReflectedLight::State& state, const ReflectedOptions& options, const Progress& progress)
      : state_(state),
        options_(options),
        progress_(progress),
        mesh_(state.mesh),
        kept_(state.reflecting, state.light, kept_strata),
        rays_(first_rays(options)) {}

  void run() {
    while (run_once()) {
    }
    state_.report.rays += kept_.rays();
  }

 private:
  struct Found {
    SplitIrradiance irradiance;
    ElementField leaving;  ///< what it is compared with came from, see estimate_error
    std::vector<double> noise;
  };

  /// False if it was the last.
  bool run_once() {
    ReflectedReport& report = state_.report;
    report.end = ReflectedEnd::interrupted;
    if (!kept_.update(mesh_, progress_)) return false;
    means_.update(mesh_, state_.light);
    LightSystems systems = find_systems(state_.reflecting, state_.light, mesh_, kept_);
    systems.power = means_.power(mesh_, state_.light, systems);
    const ReflectedSystem system{mesh_, state_.light, kept_, systems};
    Found found;
    return solve(system, found) && judge(system, found);
  }

  void keep(const ReflectedSystem& system, const SplitIrradiance& irradiance) {
    state_.field = irradiance.whole(system.mesh, system.systems);
    state_.mesh = system.mesh;
  }

  bool solve(const ReflectedSystem& system, Found& found) {
    const auto& [mesh, light, exchange, systems] = system;
    ReflectedReport& report = state_.report;
    const bool all = options_.bounces < 0;
    const ReflectedSolution solution =
        all ? solve_reflected(system, exchange.source(mesh), systems.power)
            : sum_bounces(system, options_.bounces);
    report.systems = systems.count();
    report.closed_systems =
        static_cast<int>(std::count(systems.closed.begin(), systems.closed.end(), true));
    report.iterations = solution.iterations;
    report.residual = solution.residual;
    report.amplification = solution.amplification;
    if (report.rounds == 0) keep(system, solution.irradiance);
    found.leaving = leaving_rest(mesh, light, systems, solution.irradiance);
    FinalPass pass =
        final_pass(state_.reflecting, mesh, light, found.leaving, {rays_, ++use_}, progress_);
    if (!pass.complete) return false;
    report.rays += pass.rays;
    found.noise = std::move(pass.noise);
    found.irradiance = {solution.irradiance.constant, std::move(pass.rest)};
    conserve_power(mesh, systems, found.leaving, systems.power, found.irradiance);
    if (!all) return true;
    correct(system, solution, found.irradiance);
    found.leaving = leaving_rest(mesh, light, systems, found.irradiance);
    return true;
  }

  /// What the final pass changes is reflected on, too, by the rays that are kept. Only its means:
  /// the rest of it is mostly noise.
  void correct(const ReflectedSystem& system, const ReflectedSolution& solution,
               SplitIrradiance& irradiance) const {
    const auto& [mesh, light, exchange, systems] = system;
    ElementField change = irradiance.rest;
    change.coefficients -= solution.irradiance.rest.coefficients;
    for (int e = 0; e < change.count(); ++e)
      change.of(e).bottomRows(change.of(e).rows() - 1).setZero();
    const std::vector<Rgb> absorbed = absorptances(light);
    const ChannelArray power = -integrals(mesh, systems, change, &absorbed);
    const ElementField arriving = exchange.apply(mesh, reflected_part(mesh, light, change));
    const ReflectedSolution more = solve_reflected(system, arriving, power, &solution.ambient);
    irradiance.constant += more.irradiance.constant;
    irradiance.rest.coefficients += more.irradiance.rest.coefficients;
  }

  bool judge(const ReflectedSystem& system, const Found& now) {
    const SplitIrradiance& irradiance = now.irradiance;
    const std::vector<double>& noise = now.noise;
    ReflectedReport& report = state_.report;
    const int nodes = static_cast<int>(irradiance.rest.first.back());
    const ReflectionProbes probes{
        now.leaving, (report.rounds + 1) * std::clamp(nodes / 3, 800, 4000), rays_, use_};
    const ReflectionEstimate estimate =
        estimate_error(state_.reflecting, system, irradiance, probes, progress_);
    if (!estimate.complete) return false;
    keep(system, irradiance);
    ++report.rounds;
    report.rays += estimate.rays;
    const double all = estimate.square_total, found = std::max(estimate.sum, 0.);
    const auto share = [&](double square) { return all > 0 ? std::sqrt(square / all) : 0; };
    report.error = comes_back * share(found + 2 * estimate.deviation);
    report.noise = share(std::accumulate(noise.begin(), noise.end(), 0.));
    report.mean_square_total = all / system.systems.area.sum() / (state_.scale * state_.scale);
    if (report.error <= options_.tolerance) {
      report.end = ReflectedEnd::accurate;
      return false;
    }
    return prepare_next({mesh_, irradiance.rest, noise, estimate},
                        std::pow(options_.tolerance / comes_back, 2) * all);
  }

  bool prepare_next(const RefinementInput& input, double goal) {
    ReflectedReport& report = state_.report;
    report.end = ReflectedEnd::rounds;
    if (report.rounds == options_.max_rounds) return false;
    RefinementPlan plan = plan_refinement(input, goal);
    const int room = options_.max_elements - mesh_.count();
    std::size_t fits = 0;
    for (int made = 0; fits < plan.elements.size(); ++fits)
      if ((made += plan.twice[fits] ? 3 : 1) > room) break;
    const int rays = std::min(options_.max_rays, static_cast<int>(plan.more_rays * rays_));
    report.end = fits < plan.elements.size() ? ReflectedEnd::elements : ReflectedEnd::rays;
    if (fits == 0 && rays == rays_) return false;
    plan.elements.resize(fits);
    refine(mesh_, plan.elements, plan.twice);
    rays_ = rays;
    return true;
  }

  ReflectedLight::State& state_;
  const ReflectedOptions& options_;
  const Progress& progress_;
  ReflectedMesh mesh_;
  RayExchange kept_;
  DirectMeans means_;
  int rays_;
  int use_ = 0;
};

void finish(ReflectedLight::State& state) {
  if (state.field.count() != state.mesh.count()) state.field = zero_field(state.mesh);
  state.leaving.emplace(reflected_part(state.mesh, state.light, state.field));
  state.field.coefficients /= state.scale;
  state.irradiance.emplace(state.field);
  state.elements = element_table(state.mesh, state.reflecting.roots);
  state.report.elements = state.mesh.count();
}

}  // namespace

Rgb ReflectedLight::irradiance(int surface, const Vec3& position) const {
  const ForestPlace leaf = state_->mesh.forest.leaf_at(surface, position);
  if (leaf.triangle < 0) return Rgb::Zero();
  return state_->irradiance->value(state_->mesh.element[at(leaf.triangle)], leaf.place);
}

Rgb ReflectedLight::gather(const SurfacePoint& point, int rays) const {
  std::uint64_t seed = 0;
  for (const double x : point.position) seed = mix_bits(seed ^ std::bit_cast<std::uint64_t>(x));
  thread_local std::vector<RayEnd> ends;
  ends.clear();
  HemisphereRays caster(state_->reflecting);
  const int strata = std::max(1, static_cast<int>(std::lround(std::sqrt(rays))));
  const int cast = caster.cast({point.position, point.normal}, strata, seed, ends);
  return gathered(state_->light, state_->mesh, *state_->leaving, ends, cast) / state_->scale;
}

const ReflectedReport& ReflectedLight::report() const { return state_->report; }
const ElementTable& ReflectedLight::elements() const { return state_->elements; }
const ElementField& ReflectedLight::field() const { return state_->field; }

ReflectedLight reflected_light(const SoundScene& scene, const DirectIrradiance& direct,
                               const ReflectedOptions& options, const Progress& progress) {
  check(options);
  auto state = std::make_shared<ReflectedLight::State>(scene, direct, options, progress);
  const bool nothing = reflects_nothing(state->light) || options.bounces == 0;
  const double length = nothing ? HUGE_VAL : first_length(state->reflecting.roots, options);
  state->mesh =
      make_reflected_mesh(state->reflecting.roots, length, options.order, options.max_elements);
  scale_light(*state);
  if (!nothing) Rounds(*state, options, progress).run();
  finish(*state);
  return ReflectedLight(std::move(state));
}

}  // namespace halfshade
