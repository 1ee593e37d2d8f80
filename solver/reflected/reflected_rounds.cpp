#include "solver/reflected/reflected_rounds.h"

#include "meshing/core/free_memory.h"
#include "solver/reflected/allowed_error.h"
#include "solver/reflected/exact_estimate.h"
#include "solver/reflected/exact_exchange.h"
#include "solver/reflected/loss_balance.h"
#include "solver/reflected/near_factors.h"
#include "solver/reflected/quiet_field.h"
#include "solver/reflected/ray_passes.h"
#include "solver/reflected/refinement.h"
#include "solver/reflected/reflected_on.h"
#include "solver/reflected/stagnation.h"
#include "solver/reflected/unstable_elements.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Rays from a node that are kept are two halves of strata², fewer where so much may be off that
/// their noise matters less than elements; not of many, which have fewer as it is (RayExchange).
constexpr int usual_strata = 7, few_strata = 5, hurried_strata = 4;
constexpr double much_off = 0.025;
constexpr int many_to_solve = 20000;

int strata_for(double tolerance, int elements) {
  if (tolerance >= any_error) return hurried_strata;
  return tolerance < much_off || elements > many_to_solve ? usual_strata : few_strata;
}

/// Errors that the estimate sees are reflected on, too: a little more than that is claimed.
/// Where the solver amplifies by more, that is solved for.
constexpr double comes_back = 1.2, much_comes_back = 4;

/// Elements that may be added to see how light gets out of narrow gaps. More are slow to solve for:
/// only by rays, and only as long as rounds help much.
constexpr double most_for_gaps = 2000;
constexpr int points_of_projection = 20000;
/// So many take hundreds of megabytes in each round that the next does not need.
constexpr int many_to_free = 100000;
/// Light of which not more than this share of the goal may get lost unseen is not looked into.
constexpr double negligible = 0.01;
/// Of the tolerance: what open systems lose may be off, relatively.
constexpr double loss_share = 0.15;

constexpr double share_of_noise = 0.45;                // of the goal
constexpr int most_passes = 5, surest = 16, sure = 3;  // times as many points as usual
/// Deviation of the estimate above which it may be off by so much that it asks for too much.
constexpr double unsure = 0.1, much_noise = 0.6;
/// Noise of more than `hides` times what elements are off hides which of them are; of `unseen`
/// times it does not.
constexpr double hides = 2.5, unseen = 0.6;

/// As many points that noise of the rays from each may be this share of the goal in their mean.
constexpr double noise_of_estimate = 0.1;

class Rounds {
 public:
  Rounds(ReflectedLight::State& state, const ReflectedOptions& options, const Progress& progress)
      : state_(state),
        options_(options),
        progress_(progress),
        mesh_(state.mesh),
        direct_(state.report.is_exact ? points_of_exact_projection : points_of_projection),
        losses_(state.reflecting) {
    if (state.sight && options.visibility != ReflectedVisibility::sampled)
      parts_ = std::make_unique<ExactExchange>(*state.sight, state.reflecting, state.light, direct_,
                                               state.accuracy);
    else
      kept_rays_ = std::make_unique<RayExchange>(state.reflecting, state.light,
                                                 strata_for(options.tolerance, mesh_.count()));
  }

  bool run(const GiveUp& give_up) {
    give_up_ = give_up;
    while (run_once())
      if (mesh_.count() > many_to_free) return_free_memory();
    if (kept_rays_) state_.report.rays += kept_rays_->rays();
    return !is_amplified() && !(give_up_.stagnant && is_stagnant(rounds_));
  }

 private:
  /// K (S + leaving) = irradiance.
  struct Found {
    SplitIrradiance base;            ///< what `leaving` leaves for
    ElementField leaving;            ///< without S
    ElementField rest;               ///< what arrives of it by all rays so far, as they found it
    FieldNoise noise;                ///< of `rest`
    SplitIrradiance irradiance;      ///< the same with balanced power and less noise
    ElementField reflected;          ///< what leaves for it; what the estimate looks from
    std::vector<double> noise_left;  ///< weighted, as the next
    std::vector<double> noise_kept;  ///< of RayExchange::most_rays from each node alone
    std::vector<double> weight;
    std::vector<UnsureLoss> unsure;
    int passes = 0;  ///< on these elements
    ElementField ambient;
  };
  enum class Next { end, refine, points, pass };

  /// False if it was the last.
  bool run_once() {
    ReflectedReport& report = state_.report;
    report.end = ReflectedEnd::interrupted;
    if (kept_rays_ && !kept_rays_->lower_orders_in_gaps(mesh_, progress_)) return false;
    direct_.update(mesh_, state_.light);
    state_.light.painted.update(mesh_, state_.light.rho);
    IrradianceOperator& kept = parts_ ? static_cast<IrradianceOperator&>(*parts_) : *kept_rays_;
    if (!kept.update(mesh_, progress_)) return false;
    if (parts_) {
      report.moments = parts_->moments();
      report.row_error = parts_->row_error();
    }
    LightSystems systems = find_systems(state_.reflecting, state_.light, mesh_, kept);
    systems.power = power_put_in(mesh_, state_.light, direct_, systems);
    const ReflectedSystem system{mesh_, state_.light, kept, systems};
    if (kept_rays_ && all_bounces() && make_stable(system, mesh_)) return true;
    Found found;
    found.weight = element_weights(mesh_, state_.light, options_.weight);
    if (!kept.find_losses(mesh_, systems, loss_share * options_.tolerance, progress_)) return false;
    found.unsure = losses_.find(system, options_.tolerance, progress_);
    solve(system, found);
    if (is_amplified()) return false;
    ++report.rounds;
    return improve(system, found);
  }

  /// The same elements, until more rays or points do not help. False if nothing else does.
  bool improve(const ReflectedSystem& system, Found& found) {
    ReflectionEstimate estimate;
    for (;;) {
      if (!look(system, found, estimate)) return false;
      const Next next = judge(system, found, reflected_within(estimate, found.unsure));
      if (next == Next::end || next == Next::refine) return next == Next::refine;
      if (next == Next::points) continue;
      if (!pass_once_more(system, found)) return false;
      points_ = 0;
    }
  }

  void keep(const ReflectedSystem& system, const SplitIrradiance& irradiance) {
    state_.field = irradiance.whole(system.mesh, system.systems);
    state_.mesh = system.mesh;
    state_.by_bounce = parts_by_bounce(system);
  }

  /// What is told apart of the field that is kept.
  std::vector<ElementField> parts_by_bounce(const ReflectedSystem& system) const {
    if (options_.each_bounce) return split_by_bounce(system, options_.bounces, state_.field);
    if (parts_ && options_.through_operator)
      return {arriving_by_rows(system, zero_field(system.mesh))};
    return {};
  }

  void solve(const ReflectedSystem& system, Found& found) {
    const auto& [mesh, light, exchange, systems] = system;
    ReflectedReport& report = state_.report;
    ReflectedSolution solution = all_bounces() ? solve_for(system, parts_ ? 0 : options_.tolerance)
                                               : sum_bounces(system, options_.bounces);
    if (all_bounces())
      balance_loss(system, direct_.leaving(mesh, light), found.unsure, solution.irradiance.rest);
    report.systems = systems.count();
    report.closed_systems =
        static_cast<int>(std::count(systems.closed.begin(), systems.closed.end(), true));
    report.iterations = solution.iterations;
    report.residual = solution.residual;
    report.amplification = solution.amplification;
    if (report.rounds == 0) keep(system, solution.irradiance);
    found.leaving = leaving_rest(mesh, light, systems, solution.irradiance);
    found.base = std::move(solution.irradiance);
    found.ambient = std::move(solution.ambient);
    found.noise.resize(at(mesh.count()));
    if (kept_rays_) found.noise = kept_rays_->noise(mesh, found.leaving);
    found.noise_kept = noise_of_elements(found.noise, found.weight);
    if (kept_rays_) kept_rays_->scale_to_all_rays(mesh, found.noise_kept);
    found.rest = arriving_by_rows(system, found.leaving);
    passes_.correct(mesh, found.rest, found.noise);
    balance(system, found);
  }

  bool all_bounces() const { return options_.bounces < 0; }
  bool is_amplified() const { return state_.report.amplification >= give_up_.amplified; }

  /// What rays have found so far, as well as it is known.
  void balance(const ReflectedSystem& system, Found& found) const {
    const auto& [mesh, light, exchange, systems] = system;
    found.irradiance = {found.base.constant, found.rest};
    conserve_power(mesh, systems, found.leaving, systems.power, found.irradiance);
    if (all_bounces() && passes_.count() > 0)
      reflect_change(system, found.base.rest, found.ambient, found.irradiance);
    if (!kept_rays_) {
      found.noise_left.assign(at(mesh.count()), 0);
    } else {
      QuietField quiet =
          without_noise(mesh, noisy_forest(mesh, found.irradiance.rest, found.noise), found.weight);
      found.irradiance.rest = std::move(quiet.field);
      found.noise_left = std::move(quiet.noise);
    }
    found.reflected = all_bounces() && kept_rays_
                          ? leaving_rest(mesh, light, systems, found.irradiance)
                          : found.leaving;
  }

  /// K once more, by rays that are not kept; what was found before counts as what its noise allows.
  bool pass_once_more(const ReflectedSystem& system, Found& found) {
    const auto& [mesh, light, exchange, systems] = system;
    if (all_bounces()) {
      found.leaving = found.reflected;
      found.base = found.irradiance;
    }
    const ElementField kept = arriving_by_rows(system, found.leaving);
    const FinalPass pass =
        final_pass(state_.reflecting, mesh, light, found.leaving, strata_, ++use_, progress_);
    state_.report.rays += pass.rays;
    if (!pass.complete) return false;
    found.rest = kept;
    found.noise = kept_rays_->noise(mesh, found.leaving);
    passes_.add(mesh, pass, strata_, found.weight, kept, found.noise);
    passes_.correct(mesh, found.rest, found.noise);
    ++found.passes;
    balance(system, found);
    return true;
  }

  double goal_square(double all) const {
    return allowed_square(options_, state_.scale, all) / std::pow(comes_back, 2);
  }

  /// The strata of either half of the rays from a point of each element: as many rays as keep the
  /// noise of the estimate low, more where there is more noise.
  std::vector<int> strata_of_estimate(const ReflectedSystem& system, const Found& found,
                                      const std::vector<double>& shares, int points) const {
    const double all =
        rough_square(system, found.irradiance, options_.through_operator ? nullptr : &direct_);
    const double goal = goal_square(norm_square(options_, state_.scale, all));
    const double allowed = noise_of_estimate * goal * std::sqrt(points);
    return share_probe_rays(mesh_, found.noise_kept, shares, kept_rays_->most_rays(), allowed);
  }

  /// Looks at points, more of them if there were some already. False if stopped.
  bool look(const ReflectedSystem& system, const Found& found, ReflectionEstimate& estimate) {
    const int unknowns = static_cast<int>(found.rest.first.back());
    const int usual =
        parts_ ? std::clamp(unknowns / 3, 800, 4000) : std::clamp(unknowns / 2, 2000, 6000);
    const int points = std::max(usual, points_);
    ++use_;
    std::vector<double> expected = tails(mesh_, found.irradiance.rest, found.weight);
    for (std::size_t e = 0; e < expected.size(); ++e) expected[e] += found.noise_left[e];
    const std::vector<double> shares = shares_of_probes(mesh_, expected);
    ReflectionEstimate more;
    if (parts_) {
      more = estimate_exactly(
          *state_.sight,
          ExactGather(*state_.sight, state_.reflecting, state_.light, mesh_, found.reflected,
                      state_.accuracy, points_of_exact_projection),
          system, found.irradiance, spread_probes(mesh_, found.weight, shares, points, use_),
          progress_);
    } else {
      const std::vector<int> strata = strata_of_estimate(system, found, shares, points);
      more =
          estimate_error(state_.reflecting, system, found.irradiance,
                         {found.reflected, found.weight, shares, strata, points, use_}, progress_);
    }
    if (!more.complete) return false;
    state_.report.rays += more.rays;
    if (points_ == 0)
      estimate = std::move(more);
    else
      estimate.join(more, static_cast<double>(points) / (points + points_));
    points_ += points;
    surer_ = points_ / usual;
    return true;
  }

  Next judge(const ReflectedSystem& system, Found& found, const ReflectionEstimate& estimate) {
    const SplitIrradiance& irradiance = found.irradiance;
    keep(system, irradiance);
    ReflectedReport& report = state_.report;
    const double square = std::max(estimate.sum, 0.) + 2 * estimate.deviation;
    const double scale = state_.scale.minCoeff();  // of the channels that count
    const double all = norm_square(options_, state_.scale, estimate.square_total);
    const double goal = goal_square(all);
    const auto share = [&](double x) { return all > 0 ? std::sqrt(x / all) : 0; };
    const BalanceEstimate unbalanced =
        estimate_balance(system, direct_.leaving(mesh_, state_.light), irradiance, found.unsure,
                         found.weight, report.amplification, negligible * goal);
    // While there is more to do anyway, about how much is reflected on is enough.
    const double allowed = allowed_square(options_, state_.scale, all);
    const double off = std::pow(comes_back, 2) * square;
    const bool is_last_doubt = off + unbalanced.square <= allowed;
    const ReflectedOn reflected =
        report.amplification >= much_comes_back
            ? reflected_on(system, irradiance, estimate, found.unsure, found.weight,
                           is_last_doubt ? PointParts::all : PointParts::one)
            : ReflectedOn{};
    if (progress_.stopped()) return Next::end;
    const double on = reflected.at_most();
    report.error =
        std::hypot(share(off + unbalanced.square + on), report.residual * report.amplification);
    report.noise = share(summed(found.noise_left));
    report.mean_square_total = estimate.square_total / system.systems.area.sum() / (scale * scale);
    report.end = ReflectedEnd::accurate;
    if (std::pow(report.error, 2) * all <= allowed) return Next::end;
    if (parts_) rounds_.push_back({mesh_.count(), report.error});
    report.end = ReflectedEnd::rounds;
    if (is_stagnant(rounds_)) return Next::end;
    // More elements do not show what so many rays do not find.
    unbalanced_.resize(at(report.rounds), unbalanced.square);
    const bool cannot_show = unbalanced.elements == 0 || (unbalanced.elements > most_for_gaps &&
                                                          !(kept_rays_ && is_falling(unbalanced_)));
    report.end = kept_rays_ ? ReflectedEnd::rays : ReflectedEnd::elements;
    if (unbalanced.in_gaps > goal) report.end = ReflectedEnd::gaps;
    if (unbalanced.square > goal && cannot_show) return Next::end;
    const bool could_be_little = off + unbalanced.square + reflected.square <= allowed;
    if (is_last_doubt && could_be_little && surer_ < surest) return Next::points;
    // What is reflected on shrinks as what is off does, elements or noise.
    const double share_left = off + on > 0 ? (allowed - unbalanced.square) / (off + on) : 1;
    return decide({mesh_, irradiance.rest, found.noise_left, found.weight, estimate, unbalanced},
                  is_last_doubt ? share_left * square : goal, found);
  }

  Next decide(const RefinementInput& input, double goal, const Found& found) {
    ReflectedReport& report = state_.report;
    RefinementPlan plan = plan_refinement(input, goal);
    const bool is_coarse = !plan.elements.empty();
    const bool is_last = report.rounds == options_.max_rounds;
    std::size_t fits = 0;
    for (int made = 0; fits < plan.elements.size() && !is_last; ++fits)
      if ((made += (1 << plan.times[fits]) - 1) > options_.max_elements - mesh_.count()) break;
    const ReflectedEnd end = is_coarse && !is_last ? ReflectedEnd::elements : ReflectedEnd::rounds;
    report.end = ReflectedEnd::interrupted;
    const double noise = summed(found.noise_left);
    const double of_elements = std::max(input.estimate.sum - noise, 0.);
    const bool is_hidden = noise > std::max(hides * of_elements, share_of_noise * goal);
    const bool can_pass = kept_rays_ && found.passes < most_passes && noise > least_noise * goal;
    const bool could_be_surer = !is_coarse && surer_ < surest;
    // More points take less than what an outlier among a few may ask for.
    if (noise <= much_noise * goal && surer_ < sure && input.estimate.deviation > unsure * goal &&
        input.estimate.sum - 2 * input.estimate.deviation < goal)
      return Next::points;
    if (fits > 0 && is_hidden && can_pass && plan_pass(input, goal, unseen * of_elements, found))
      return Next::pass;
    if (fits > 0) {
      plan.elements.resize(fits);
      refine(mesh_, plan.elements, plan.times);
      points_ = 0;
      return Next::refine;
    }
    if (can_pass && (noise > share_of_noise * goal || !could_be_surer) &&
        plan_pass(input, goal, 0, found))
      return Next::pass;
    if (could_be_surer) return Next::points;
    report.end = kept_rays_ && !is_coarse ? ReflectedEnd::rays : end;
    return Next::end;
  }

  /// Rays that bring the noise down to what suits the goal, or to `enough`. False if there may be
  /// no more.
  bool plan_pass(const RefinementInput& input, double goal, double enough, const Found& found) {
    const double wanted = noise_after_pass(input.estimate, summed(found.noise_left), goal, enough);
    const double more =
        rays_for(mesh_, noisy_forest(mesh_, found.rest, found.noise), found.weight, wanted);
    const double all = summed(noise_of_elements(found.noise, found.weight));
    strata_ =
        share_rays(mesh_, found.noise_kept, found.weight,
                   {kept_rays_->most_rays(), passes_.sent(mesh_, kept_rays_->rays_of_nodes(mesh_)),
                    all / more, static_cast<double>(options_.max_rays)});
    return std::any_of(strata_.begin(), strata_.end(), [](int n) { return n > 0; });
  }

  ReflectedLight::State& state_;
  const ReflectedOptions& options_;
  GiveUp give_up_;
  const Progress& progress_;
  ReflectedMesh mesh_;
  DirectProjection direct_;
  UnsureLosses losses_;
  std::unique_ptr<RayExchange> kept_rays_;  ///< either these
  std::unique_ptr<ExactExchange> parts_;    ///< or exact parts
  std::vector<RoundError> rounds_;          ///< of exact parts
  std::vector<double> unbalanced_;          ///< BalanceEstimate::square of each round
  int use_ = 0;
  int points_ = 0;  ///< of the estimate so far
  int surer_ = 1;   ///< times as many of them as usual
  RayPasses passes_;
  std::vector<int> strata_;  ///< of each element in the next pass
};

}  // namespace

bool run_rounds(ReflectedLight::State& state, const ReflectedOptions& options,
                const GiveUp& give_up, const Progress& progress) {
  return Rounds(state, options, progress).run(give_up);
}

}  // namespace halfshade
