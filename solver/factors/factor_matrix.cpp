#include "solver/factors/factor_matrix.h"

#include "meshing/core/error.h"
#include "solver/factors/finished_matrix.h"
#include "solver/factors/surface_exchange.h"

#include <fmt/format.h>

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

void require_few_pairs(std::size_t surfaces) {
  const double pairs = 0.5 * std::pow(static_cast<double>(surfaces), 2);
  if (pairs > most_exact_pairs)
    throw Error(ErrorCode::too_large, {},
                fmt::format("exact factors of {} surfaces would take {:.2g} pairs, which is more "
                            "than a day of work; --method rays takes minutes",
                            surfaces, pairs));
}

}  // namespace

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
  if (options.method == FactorMethod::exact) require_few_pairs(sound.sound.surfaces.size());
  const SightScene sight = make_sight_scene(sound.sound, progress);
  RowExchange exchange = options.method == FactorMethod::exact
                             ? exact_exchange(sound, sight, options, progress)
                         : options.method == FactorMethod::rays
                             ? sampled_exchange(sound, sight.reflecting, options, progress)
                             : hemicube_exchange(sound, sight.reflecting, options, progress);
  // What rays were asked for is a number of them.
  const double tolerance = options.method == FactorMethod::exact ? options.tolerance : HUGE_VAL;
  FactorMatrix result = finished_matrix(sound, std::move(exchange), tolerance, options);
  if (options.unit == FactorUnit::face) result.places = row_places(sound);
  return result;
}

}  // namespace halfshade
