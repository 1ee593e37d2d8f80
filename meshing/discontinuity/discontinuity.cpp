#include "meshing/discontinuity/discontinuity.h"

#include "meshing/core/parallel.h"
#include "meshing/discontinuity/curve_search.h"
#include "meshing/discontinuity/merge_curves.h"
#include "meshing/discontinuity/predict_jump.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace halfshade {
namespace {

using Curves = std::vector<DiscontinuityCurve>;

// A forecast looks at so many sources.
constexpr std::size_t most_sources_in_forecast = 4;

void sort_by_receiver(Curves& curves) {
  std::stable_sort(curves.begin(), curves.end(),
                   [](const DiscontinuityCurve& a, const DiscontinuityCurve& b) {
                     return a.receiver < b.receiver;
                   });
}

/// Receiver by receiver, each with its own idea of what is the same. Returns the curves that are
/// left, by receiver, and adds to `merged` how many are not.
Curves merge(const SoundScene& scene, Curves curves, std::size_t& merged) {
  sort_by_receiver(curves);
  Curves left;
  for (auto begin = curves.begin(); begin != curves.end();) {
    const int receiver = begin->receiver;
    const auto end = std::find_if(begin, curves.end(), [&](const DiscontinuityCurve& curve) {
      return curve.receiver != receiver;
    });
    Curves own(std::make_move_iterator(begin), std::make_move_iterator(end));
    merged += merge_coincident(own, tolerance_of(scene.surfaces[at(receiver)]).length);
    std::move(own.begin(), own.end(), std::back_inserter(left));
    begin = end;
  }
  return left;
}

void predict_jumps(const LitFromOne& lit, const Progress& progress, Curves& curves) {
  tbb::enumerable_thread_specific<JumpPredictor> predictors(
      [&] { return JumpPredictor(lit.scene, lit.opaque, lit.emitter_scene); });
  parallel_for(
      curves.size(),
      [&](std::size_t i) {
        predictors.local().predict(curves[i]);
        for (double& jump : curves[i].jump) jump *= lit.exitance;
      },
      progress, "jumps");
}

}  // namespace

Discontinuities find_discontinuities(const SoundScene& scene, const OpaqueScene& opaque,
                                     std::span<const LightSource> sources,
                                     const DiscontinuityOptions& options,
                                     const Progress& progress) {
  Discontinuities result;
  DiscontinuityReport& report = result.report;
  result.sources.assign(sources.begin(), sources.end());
  report.most_work = options.most_work;
  std::vector<int> receivers(scene.surfaces.size());
  std::iota(receivers.begin(), receivers.end(), 0);
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const double share =
        (options.most_work - report.work) / static_cast<double>(sources.size() - k);
    const double most_work = options.most_work > 0 ? std::max(share, 1.) : HUGE_VAL;
    const EmitterScene emitter_scene(scene, opaque, sources[k].surface);
    const LitFromOne lit{scene, opaque, emitter_scene, sources[k].exitance, receivers};
    Curves curves =
        merge(scene, search_curves(lit, options, most_work, progress, report), report.merged);
    predict_jumps(lit, progress, curves);
    std::move(curves.begin(), curves.end(), std::back_inserter(result.curves));
  }
  sort_by_receiver(result.curves);
  report.interrupted = progress.stopped();
  return result;
}

SearchForecast forecast_search(const SoundScene& scene, const OpaqueScene& opaque,
                               std::span<const LightSource> sources, std::span<const int> among,
                               const DiscontinuityOptions& options, const Progress& progress) {
  std::vector<bool> is_among(scene.surfaces.size(), false);
  for (const int s : among) is_among[at(s)] = true;
  const std::size_t asked = std::min(most_sources_in_forecast, sources.size());
  SearchForecast sum;
  for (std::size_t k = 0; k < asked; ++k) {
    const LightSource& source = sources[k * sources.size() / asked];
    const EmitterScene emitter_scene(scene, opaque, source.surface, is_among);
    const SearchForecast one =
        forecast_curves({scene, opaque, emitter_scene, source.exitance, among}, options, progress);
    const double stands_for = static_cast<double>(sources.size()) / static_cast<double>(asked);
    sum.work += stands_for * one.work;
    sum.look += one.look / static_cast<double>(asked);
    sum.curves += stands_for * one.curves;
  }
  return sum;
}

}  // namespace halfshade
