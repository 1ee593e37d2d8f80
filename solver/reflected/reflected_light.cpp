#include "solver/reflected/reflected_light.h"

#include "meshing/core/error.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/elements/balancing_scale.h"
#include "solver/reflected/ray_exchange.h"
#include "solver/reflected/reflected_cost.h"
#include "solver/reflected/reflected_rounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <mutex>

namespace halfshade {

namespace {

void check(const ReflectedOptions& options) {
  if (options.order < 0 || options.order > max_reflected_order)
    throw Error(ErrorCode::contract, "reflected_light",
                fmt::format("order {} must lie in [0, {}]", options.order, max_reflected_order));
  if (options.each_bounce && options.bounces < 0)
    throw Error(ErrorCode::contract, "reflected_light", "each_bounce takes a number of bounces");
  if (!(options.tolerance > 0) || !(options.other_error >= 0) || !(options.direct_norm >= 0) ||
      !(options.gather_tolerance >= 0) || !(options.max_length >= 0) || options.max_rays < 32 ||
      options.max_elements < 1 || options.max_rounds < 1)
    throw Error(ErrorCode::contract, "reflected_light",
                "the tolerance must be > 0, norms, gather_tolerance and max_length ≥ 0, "
                "max_rays ≥ 32, and elements and rounds at least 1");
}

/// Elements as long as this to begin with.
double first_length(const HugeRoots& huge, bool is_exact, const ReflectedOptions& options) {
  constexpr double mean_area = 0.3;  // of elements that are at most 1 long, see make_reflected_mesh
  // Where furniture takes many elements, so much more for the room costs little.
  constexpr double share_of_roots = 0.04;
  // Other errors leave about so much of the tolerance: fewer elements show on dark surfaces.
  constexpr double usually_left = 0.8;
  // More are better added where light asks for them.
  constexpr double most = 1000;
  const double fewest = std::max(50., is_exact ? 0 : share_of_roots * huge.others);
  const double wanted =
      options.weight  // most elements do not matter then
          ? 50
          : std::clamp(
                usual_elements * std::pow(usual_error / (usually_left * options.tolerance), 2. / 3),
                fewest, std::max(fewest, most));
  const double length = std::sqrt(huge.area / (mean_area * wanted));
  return options.max_length > 0 ? std::min(options.max_length, length) : length;
}

/// How many times light is reflected in the mean, at most: where it gets lost, what rows are off
/// counts as often.
double reflected_at_most(const FirstLight& light, const ReflectedMesh& mesh) {
  double least = 1;
  for (int e = 0; e < mesh.count(); ++e)
    least = std::min(least, 1 - light.mean_rho(mesh, e).maxCoeff());
  constexpr double unbounded = 1e-4;
  return 1 / std::max(least, unbounded);
}

/// How exact rows have to be for a tolerance, in a scene of some area where light is reflected so
/// many times.
RowAccuracy row_accuracy(double tolerance, double times, double area) {
  constexpr double few_times = 8;
  const double off = tolerance * std::min(1., few_times / times);
  // Where little gets lost, a part that is dark because it is hidden, like a ceiling close above a
  // lamp, must not darken what is seen round it: light may change over any length.
  const double length = times > few_times ? 0 : 0.35 * std::sqrt(area);
  return {0.003 * off, 0.3 * off, length};
}

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

/// As many as suit the tolerance.
void find_hot_cells(ReflectedLight::State& state, const HugeRoots& huge, double tolerance) {
  constexpr double cells = 1000, fewest = 20000, most = 200000;
  const LeavingCells::Leaving leaving = [&](int root, const Vec3& p) {
    return state.light.leaving(root, p);
  };
  state.light.hot = HotCells(
      state.reflecting, huge,
      LeavingCells(state.reflecting, huge, std::clamp(cells / tolerance, fewest, most), leaving));
}

void finish(ReflectedLight::State& state) {
  if (state.field.count() != state.mesh.count()) state.field = zero_field(state.mesh);
  state.light.painted.update(state.mesh, state.light.rho);
  state.leaving_rest = reflected_part(state.mesh, state.light, state.field);
  state.leaving.emplace(state.mesh, state.leaving_rest);
  state.field.coefficients.rowwise() /= state.scale.transpose();
  state.irradiance.emplace(state.mesh, state.field);
  for (ElementField& part : state.by_bounce) {
    part.coefficients.rowwise() /= state.scale.transpose();
    state.irradiance_by_bounce.emplace_back(state.mesh, part);
  }
  state.elements = element_table(state.mesh, state.reflecting.roots);
  state.report.elements = state.mesh.count();
  state.report.unknowns = static_cast<std::size_t>(state.field.coefficients.rows());
}

const ExactGather& exact_gather(const ReflectedLight::State& state) {
  std::call_once(state.gather_made, [&] {
    state.gather.emplace(*state.sight, state.reflecting, state.light, state.mesh,
                         state.leaving_rest, state.gather_accuracy, points_of_exact_projection);
  });
  return *state.gather;
}

Rgb value_in(const ReflectedMesh& mesh, const QuickField& field, int surface,
             const Vec3& position) {
  const ForestPlace leaf = mesh.forest.leaf_at(surface, position);
  if (leaf.triangle < 0) return Rgb::Zero();
  return field.value(leaf.triangle, leaf.place);
}

Rgb gather_by_rays(const ReflectedLight::State& state, const RayOrigin& from, int rays,
                   std::uint64_t pattern) {
  std::uint64_t seed = pattern;
  int exponent = 0;  // which changes with the unit
  for (const double x : from.position)
    seed = mix_bits(seed ^ std::bit_cast<std::uint64_t>(std::frexp(x, &exponent)));
  const int strata = std::max(1, static_cast<int>(std::lround(std::sqrt(rays))));
  const RayHemisphere above{from, strata, seed};
  const ChannelArray found =
      gathered(gather_rays(state.reflecting, state.light, Looks::exact, {&above, 1}),
               state.mesh.forest, *state.leaving);
  return found.row(0).transpose() / state.scale;
}

}  // namespace

Rgb ReflectedLight::irradiance(int surface, const Vec3& position) const {
  return value_in(state_->mesh, *state_->irradiance, surface, position);
}

int ReflectedLight::bounces() const {
  return static_cast<int>(state_->irradiance_by_bounce.size());
}

Rgb ReflectedLight::irradiance_after(int reflections, int surface, const Vec3& position) const {
  return value_in(state_->mesh, state_->irradiance_by_bounce.at(at(reflections - 1)), surface,
                  position);
}

Rgb ReflectedLight::gather(const SurfacePoint& point, int rays, std::uint64_t pattern) const {
  if (state_->sight) return exact_gather(*state_).irradiance(point) / state_->scale;
  return gather_by_rays(*state_, {point.position, point.normal}, rays, pattern);
}

Rgb ReflectedLight::gather_on(int surface, const Vec3& position, int rays,
                              std::uint64_t pattern) const {
  const auto& [triangle, place] = state_->mesh.forest.leaf_at(surface, position);
  if (triangle < 0) return Rgb::Zero();
  const ReflectedMesh& mesh = state_->mesh;
  if (state_->sight)
    return gather(state_->sight->point_of(mesh.forest.root(triangle), position), rays, pattern);
  const int element = mesh.element[at(triangle)];
  return gather_by_rays(*state_, ray_origin(state_->reflecting, mesh, element, place), rays,
                        pattern);
}

std::optional<Rgb> ReflectedLight::gathered_from(int surface, const Vec3& position) const {
  if (!state_->sight) return std::nullopt;
  return exact_gather(*state_).leaving(surface, position) / state_->scale;
}

const ReflectedReport& ReflectedLight::report() const { return state_->report; }
const ElementTable& ReflectedLight::elements() const { return state_->elements; }
const ElementField& ReflectedLight::field() const { return state_->field; }

int gathering_rays(double noise) {
  constexpr double usual_rays = 1024, usual_noise = 0.0034, fewest = 256, most = 65536;
  const double ratio = usual_noise / noise;
  return static_cast<int>(std::clamp(usual_rays * ratio * ratio, fewest, most));
}

namespace {

struct OneWay {
  std::shared_ptr<ReflectedLight::State> state;  ///< with what is found
  bool is_given_up = false;
};

/// Elements that few rays from take a few seconds at most.
constexpr int quickly_found = 100000;

/// What is found quickly where the first round was stopped.
void find_coarsely(ReflectedLight::State& state, ReflectedOptions options) {
  options.visibility = ReflectedVisibility::sampled;
  options.tolerance = any_error;
  options.max_rounds = 1;
  state.report.is_exact = false;
  run_rounds(state, options, {}, {});
  state.report.end = ReflectedEnd::interrupted;
}

OneWay solve_one_way(const SoundScene& scene, const DirectIrradiance& direct,
                     const ReflectedOptions& options, bool is_exact, const GiveUp& give_up,
                     const Progress& progress) {
  ReflectingScene reflecting = make_reflecting_scene(scene, progress);
  const HugeRoots huge = find_huge(reflecting.roots, options.counted);
  FirstLight light = first_light(scene, reflecting.roots, direct, options.through_operator);
  const bool nothing = reflects_nothing(light) || options.bounces == 0;
  const double length = nothing ? HUGE_VAL : first_length(huge, is_exact, options);
  ReflectedMesh mesh =
      make_reflected_mesh(reflecting.roots, length, options.order, options.max_elements, huge);
  auto state = std::make_shared<ReflectedLight::State>(std::move(reflecting), std::move(light),
                                                       std::move(mesh));
  state->report.is_exact = is_exact;
  scale_light(*state);
  if (options.direct_norm > 0 && !options.through_operator)
    state->light.direct_square = std::pow(state->scale.minCoeff() * options.direct_norm, 2);
  state->report.through_operator = options.through_operator;
  if (is_exact && !nothing) {
    state->scene = std::make_unique<const SoundScene>(scene);
    state->sight = std::make_unique<const ExactSight>(*state->scene, state->reflecting);
    state->light.painted.update(state->mesh, state->light.rho);
    const double times = reflected_at_most(state->light, state->mesh);
    state->accuracy = row_accuracy(options.tolerance, times, huge.area);
    state->gather_accuracy = row_accuracy(
        options.gather_tolerance > 0 ? options.gather_tolerance : 0.1 * options.tolerance, times,
        huge.area);
  }
  if (!reflects_nothing(state->light) && !is_exact && !options.through_operator)
    find_hot_cells(*state, huge, options.tolerance);
  bool is_given_up = false;
  if (!nothing) {
    state->report.error = 1;  // G = 0 if it is stopped in the first round
    is_given_up = !run_rounds(*state, options, give_up, progress);
    if (progress.stopped() && state->report.rounds == 0 && state->mesh.count() <= quickly_found)
      find_coarsely(*state, options);
  }
  finish(*state);
  return {std::move(state), is_given_up};
}

}  // namespace

ReflectedLight reflected_light(const SoundScene& scene, const DirectIrradiance& direct,
                               const ReflectedOptions& options, const Progress& progress) {
  check(options);
  const ReflectedCost cost = reflected_cost(static_cast<int>(scene.surfaces.size()), options);
  OneWay way = solve_one_way(scene, direct, options, cost.is_exact, cost.give_up, progress);
  if (!way.is_given_up) return ReflectedLight(std::move(way.state));
  OneWay other = solve_one_way(scene, direct, options, !cost.is_exact, {}, progress);
  // Rays that were stopped may know less than what exact parts came to.
  ReflectedReport& report = way.state->report;
  if (!cost.is_exact || !progress.stopped() || other.state->report.error <= report.error)
    return ReflectedLight(std::move(other.state));
  report.end = ReflectedEnd::interrupted;
  return ReflectedLight(std::move(way.state));
}

}  // namespace halfshade
