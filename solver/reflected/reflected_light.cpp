#include "solver/reflected/reflected_light.h"

#include "meshing/core/error.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/elements/balancing_scale.h"
#include "solver/reflected/exact_estimate.h"
#include "solver/reflected/exact_exchange.h"
#include "solver/reflected/refinement.h"
#include "solver/reflected/reflected_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>
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
  std::unique_ptr<const SoundScene> scene;  ///< for exact parts, as the next two
  std::unique_ptr<const ExactSight> sight;
  RowAccuracy accuracy;
  Rgb scale = Rgb::Ones();  ///< of light while it is solved for: no size of it over- or underflows
  ReflectedMesh mesh;
  ElementTable elements;
  ElementField field;
  ElementField leaving_rest;  ///< what leaves, without S
  std::optional<QuickField> irradiance, leaving;
  ReflectedReport report;
  mutable std::once_flag gather_made;
  mutable std::optional<ExactGather> gather;  ///< made when it is asked for
};

namespace {

/// Rays from a node that are kept: strata².
constexpr int kept_strata = 10;
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
double first_length(double area, const ReflectedOptions& options) {
  constexpr double mean_area = 0.3;  // of elements that are at most 1 long, see make_reflected_mesh
  constexpr double fewest = 50;
  const double wanted =
      options.weight  // most elements do not matter then
          ? fewest
          : std::clamp(usual_elements * std::pow(usual_error / options.tolerance, 2. / 3), fewest,
                       5000.);
  const double length = std::sqrt(area / (mean_area * wanted));
  return options.max_length > 0 ? std::min(options.max_length, length) : length;
}

int first_rays(const ReflectedOptions& options) {
  const double rays = usual_rays * std::pow(usual_error / options.tolerance, 1.5);
  return std::min(options.max_rays, std::max(48, static_cast<int>(rays)));
}

/// How exact rows have to be for a tolerance, in a scene of some area.
RowAccuracy row_accuracy(double tolerance, double area) {
  return {0.003 * tolerance, 0.3 * tolerance, 0.35 * std::sqrt(area)};
}

/// Elements that may be added to see how light gets out of narrow gaps. More are slow to solve for.
constexpr double most_for_gaps = 2000;

// Points at which direct light is asked for in a round.
constexpr int few_direct_points = 20000, many_direct_points = 100000;

bool reflects_nothing(const FirstLight& light) {
  const auto is_zero = [](const Rgb& x) { return (x == 0).all(); };
  return std::all_of(light.exitance.begin(), light.exitance.end(), is_zero) ||
         (!light.through_operator && std::all_of(light.rho.begin(), light.rho.end(), is_zero));
}

/// Brings the strongest exitance to about 1.
void scale_light(ReflectedLight::State& state) {
  state.scale = balancing_scale(state.light.exitance);
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
        direct_(state.report.is_exact ? many_direct_points : few_direct_points),
        rays_(first_rays(options)) {
    if (state.sight)
      parts_ = std::make_unique<ExactExchange>(*state.sight, state.reflecting, state.light, direct_,
                                               state.accuracy);
    else
      kept_rays_ = std::make_unique<RayExchange>(state.reflecting, state.light, kept_strata);
  }

  void run() {
    while (run_once()) {
    }
    if (kept_rays_) state_.report.rays += kept_rays_->rays();
  }

 private:
  struct Found {
    SplitIrradiance irradiance;
    ElementField leaving;       ///< what it is compared with came from, see estimate_error
    std::vector<double> noise;  ///< weighted, as all square errors
  };

  /// False if it was the last.
  bool run_once() {
    ReflectedReport& report = state_.report;
    report.end = ReflectedEnd::interrupted;
    direct_.update(mesh_, state_.light);
    IrradianceOperator& kept = parts_ ? static_cast<IrradianceOperator&>(*parts_) : *kept_rays_;
    if (!kept.update(mesh_, progress_)) return false;
    if (parts_) {
      report.moments = parts_->moments();
      report.row_error = parts_->row_error();
    }
    LightSystems systems = find_systems(state_.reflecting, state_.light, mesh_, kept);
    systems.power = power_put_in(mesh_, state_.light, direct_, systems);
    const ReflectedSystem system{mesh_, state_.light, kept, systems};
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
    if (!pass_once_more(system, solution, found)) return false;
    conserve_power(mesh, systems, found.leaving, systems.power, found.irradiance);
    if (!all || parts_) return true;
    correct(system, solution, found.irradiance);
    found.leaving = leaving_rest(mesh, light, systems, found.irradiance);
    return true;
  }

  /// K (S + leaving), as exactly as it gets.
  bool pass_once_more(const ReflectedSystem& system, const ReflectedSolution& solution,
                      Found& found) {
    const auto& [mesh, light, exchange, systems] = system;
    found.irradiance.constant = solution.irradiance.constant;
    if (parts_) {
      found.irradiance.rest = exchange.source(mesh);
      found.irradiance.rest.coefficients += exchange.apply(mesh, found.leaving).coefficients;
      found.noise.assign(at(mesh.count()), 0);
      ++use_;
      return true;
    }
    FinalPass pass =
        final_pass(state_.reflecting, mesh, light, found.leaving, {rays_, ++use_}, progress_);
    state_.report.rays += pass.rays;
    found.noise = std::move(pass.noise);
    found.irradiance.rest = std::move(pass.rest);
    return pass.complete;
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

  std::vector<double> element_weights() const {
    std::vector<double> weights;
    for (int e = 0; e < mesh_.count(); ++e)
      weights.push_back(mean_weight(options_.weight, state_.light.surface[at(mesh_.root(e))],
                                    mesh_.forest.corners(mesh_.triangle[at(e)])));
    return weights;
  }

  bool judge(const ReflectedSystem& system, Found& now) {
    const SplitIrradiance& irradiance = now.irradiance;
    const std::vector<double> weight = element_weights();
    std::vector<double>& noise = now.noise;
    for (std::size_t e = 0; e < noise.size(); ++e) noise[e] *= weight[e];
    ReflectedReport& report = state_.report;
    const int nodes = static_cast<int>(irradiance.rest.first.back());
    const int points = std::clamp(nodes / 3, 800, 4000);
    const ReflectionEstimate estimate =
        parts_ ? estimate_exactly(*state_.sight,
                                  ExactGather(*state_.sight, state_.reflecting, state_.light, mesh_,
                                              now.leaving, state_.accuracy, many_direct_points),
                                  system, irradiance,
                                  spread_probes(mesh_, weight, surer_ * points, use_), progress_)
               : estimate_error(state_.reflecting, system, irradiance,
                                {now.leaving, weight, (report.rounds + 1) * points, rays_, use_},
                                progress_);
    if (!estimate.complete) return false;
    keep(system, irradiance);
    ++report.rounds;
    report.rays += estimate.rays;
    const double found = std::max(estimate.sum, 0.);
    const double scale = state_.scale.minCoeff();  // of the channels that count
    const double all = options_.weight ? std::pow(scale * options_.norm, 2) : estimate.square_total;
    const auto share = [&](double square) { return all > 0 ? std::sqrt(square / all) : 0; };
    const BalanceEstimate balance = estimate_balance(
        system, direct_.leaving(mesh_, state_.light), irradiance.rest,
        parts_ ? parts_->unsure() : unsure_by_rays(system, kept_strata * kept_strata), weight);
    report.error = std::hypot(comes_back * share(found + 2 * estimate.deviation),
                              share(balance.square), report.residual * report.amplification);
    report.noise = share(std::accumulate(noise.begin(), noise.end(), 0.));
    report.mean_square_total = estimate.square_total / system.systems.area.sum() / (scale * scale);
    if (report.error <= options_.tolerance) {
      report.end = ReflectedEnd::accurate;
      return false;
    }
    const double goal = std::pow(options_.tolerance / comes_back, 2) * all;
    if (balance.square > goal && (kept_rays_ || balance.elements > most_for_gaps)) {
      report.end = kept_rays_ ? ReflectedEnd::rays : ReflectedEnd::elements;
      return false;
    }
    return prepare_next({mesh_, irradiance.rest, noise, weight, estimate, balance}, goal);
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
    if (parts_ && plan.elements.empty()) return ask_more_points();
    const int rays = std::min(options_.max_rays, static_cast<int>(plan.more_rays * rays_));
    report.end = fits < plan.elements.size() ? ReflectedEnd::elements : ReflectedEnd::rays;
    if (fits == 0 && rays == rays_) return false;
    plan.elements.resize(fits);
    refine(mesh_, plan.elements, plan.twice);
    rays_ = rays;
    return true;
  }

  /// Where the estimate without its uncertainty is small enough.
  bool ask_more_points() {
    constexpr int most = 16;
    surer_ *= 4;
    return surer_ <= most;
  }

  ReflectedLight::State& state_;
  const ReflectedOptions& options_;
  const Progress& progress_;
  ReflectedMesh mesh_;
  DirectProjection direct_;
  std::unique_ptr<RayExchange> kept_rays_;  ///< either these
  std::unique_ptr<ExactExchange> parts_;    ///< or exact parts
  int rays_;
  int use_ = 0;
  int surer_ = 1;  ///< times as many points of the estimate
};

void finish(ReflectedLight::State& state) {
  if (state.field.count() != state.mesh.count()) state.field = zero_field(state.mesh);
  state.leaving_rest = reflected_part(state.mesh, state.light, state.field);
  state.leaving.emplace(state.leaving_rest);
  state.field.coefficients.rowwise() /= state.scale.transpose();
  state.irradiance.emplace(state.field);
  state.elements = element_table(state.mesh, state.reflecting.roots);
  state.report.elements = state.mesh.count();
  state.report.unknowns = static_cast<std::size_t>(state.field.coefficients.rows());
}

}  // namespace

Rgb ReflectedLight::irradiance(int surface, const Vec3& position) const {
  const ForestPlace leaf = state_->mesh.forest.leaf_at(surface, position);
  if (leaf.triangle < 0) return Rgb::Zero();
  return state_->irradiance->value(state_->mesh.element[at(leaf.triangle)], leaf.place);
}

Rgb ReflectedLight::gather(const SurfacePoint& point, int rays) const {
  if (state_->sight) {
    const State& state = *state_;
    std::call_once(state.gather_made, [&] {
      state.gather.emplace(*state.sight, state.reflecting, state.light, state.mesh,
                           state.leaving_rest, state.accuracy, many_direct_points);
    });
    return state.gather->irradiance(point) / state.scale;
  }
  std::uint64_t seed = 0;
  int exponent = 0;  // which changes with the unit
  for (const double x : point.position)
    seed = mix_bits(seed ^ std::bit_cast<std::uint64_t>(std::frexp(x, &exponent)));
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
  const ElementTable& roots = state->reflecting.roots;
  const HugeRoots huge = find_huge(roots);
  const double length = nothing ? HUGE_VAL : first_length(huge.area, options);
  state->mesh = make_reflected_mesh(roots, length, options.order, options.max_elements, huge);
  scale_light(*state);
  const int surfaces = static_cast<int>(scene.surfaces.size());
  state->report.is_exact = reflected_cost(surfaces, options).is_exact;
  state->report.through_operator = options.through_operator;
  if (state->report.is_exact && !nothing) {
    state->scene = std::make_unique<const SoundScene>(scene);
    state->sight = std::make_unique<const ExactSight>(*state->scene, state->reflecting);
    state->accuracy = row_accuracy(options.tolerance, huge.area);
  }
  if (!nothing) {
    state->report.error = 1;  // G = 0 if it is stopped in the first round
    Rounds(*state, options, progress).run();
  }
  finish(*state);
  return ReflectedLight(std::move(state));
}

}  // namespace halfshade
