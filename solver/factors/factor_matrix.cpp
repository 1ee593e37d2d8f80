#include "solver/factors/factor_matrix.h"

#include "meshing/core/error.h"
#include "solver/factors/exchange_work.h"
#include "solver/factors/finished_matrix.h"
#include "solver/factors/surface_exchange.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <unistd.h>
#include <utility>

namespace halfshade {
namespace {

/// The part of the machine's memory that matrices may fill, and how many of them there are.
constexpr double memory_share = 0.7;
constexpr double matrices = 4;
/// Pairs whose factors are exact: with more, days would pass. Of rays only their number counts.
constexpr double most_exact_pairs = 2e8;

/// As much exact work, in CPU seconds, is done without asking whether rays do it, too; and if they
/// do with such a part of it, they are taken.
constexpr double little_work = 20;
constexpr double clearly_less = 0.5;

double pairs_of(const FactorScene& scene) {
  return 0.5 * std::pow(static_cast<double>(scene.sound.surfaces.size()), 2);
}

void require_few_pairs(const FactorScene& scene) {
  const std::size_t surfaces = scene.sound.surfaces.size();
  const double pairs = pairs_of(scene);
  if (pairs > most_exact_pairs)
    throw Error(ErrorCode::too_large, {},
                fmt::format("exact factors of {} surfaces would take {:.2g} pairs, which is more "
                            "than a day of work; --method rays takes minutes",
                            surfaces, pairs));
}

RowExchange exact_unless_rays_do(const FactorScene& scene, const FactorOptions& options,
                                 const Progress& progress) {
  if (pairs_of(scene) > most_exact_pairs)
    return sampled_exchange(scene, make_reflecting_scene(scene.sound, progress), options, progress);
  const SightScene sight = make_sight_scene(scene.sound, progress);
  const double seconds = exact_seconds(scene, sight);
  if (seconds > little_work) {
    auto sampled = sampled_exchange_within(rays_in(clearly_less * seconds), scene, sight.reflecting,
                                           options, progress);
    if (sampled) return std::move(*sampled);
  }
  return exact_exchange(scene, sight, options, progress);
}

RowExchange exchange_of(const FactorScene& scene, const FactorOptions& options,
                        const Progress& progress) {
  if (options.method == FactorMethod::automatic)
    return exact_unless_rays_do(scene, options, progress);
  if (options.method == FactorMethod::exact) {
    require_few_pairs(scene);
    return exact_exchange(scene, make_sight_scene(scene.sound, progress), options, progress);
  }
  const ReflectingScene reflecting = make_reflecting_scene(scene.sound, progress);
  return options.method == FactorMethod::rays
             ? sampled_exchange(scene, reflecting, options, progress)
             : hemicube_exchange(scene, reflecting, options, progress);
}

}  // namespace

const char* name_of(FactorMethod method) {
  constexpr std::array names{"auto", "exact", "rays", "hemicube"};
  return names.at(static_cast<std::size_t>(method));
}

void require_factor_memory(int rows) {
  const double bytes = matrices * sizeof(double) * std::pow(static_cast<double>(rows), 2);
  const double machine =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (bytes > memory_share * machine)
    throw Error(ErrorCode::too_large, {},
                fmt::format("a matrix of {} rows takes {:.3g} GB, and the machine has {:.3g} GB",
                            rows, bytes * 1e-9, machine * 1e-9));
}

FactorMatrix form_factor_matrix(const Scene& scene, const FactorOptions& options,
                                const Progress& progress) {
  const FactorScene sound = make_factor_scene(scene, options.unit);
  require_factor_memory(sound.rows());
  RowExchange exchange = exchange_of(sound, options, progress);
  if (!exchange.report.is_complete) {
    FactorMatrix nothing;
    nothing.report = exchange.report;
    return nothing;
  }
  const bool is_number_of_rays = exchange.report.method == FactorMethod::hemicube ||
                                 (exchange.report.method == FactorMethod::rays && options.rays > 0);
  FactorMatrix result = finished_matrix(sound, std::move(exchange),
                                        is_number_of_rays ? HUGE_VAL : options.tolerance, options);
  if (options.unit == FactorUnit::face) result.places = row_places(sound);
  return result;
}

}  // namespace halfshade
