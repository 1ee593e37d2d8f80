#include "meshing/discontinuity/discontinuity.h"

#include "meshing/core/parallel.h"
#include "meshing/discontinuity/border_events.h"
#include "meshing/discontinuity/merge_curves.h"
#include "meshing/discontinuity/predict_jump.h"
#include "meshing/discontinuity/swath_tracer.h"
#include "meshing/events/events.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <iterator>

namespace halfshade {
namespace {

using Curves = std::vector<DiscontinuityCurve>;

void append(Curves&& more, Curves& curves) {
  curves.insert(curves.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
}

void sort_by_receiver(Curves& curves) {
  std::stable_sort(curves.begin(), curves.end(),
                   [](const DiscontinuityCurve& a, const DiscontinuityCurve& b) {
                     return a.receiver < b.receiver;
                   });
}

/// One worker a thread, made when it is first needed. Results do not depend on which thread has
/// done what, for workers keep nothing between jobs but buffers and counts.
template <class Worker>
using PerThread = tbb::enumerable_thread_specific<Worker>;

/// The search for one emitter's curves.
class Search {
 public:
  Search(const SoundScene& scene, const OpaqueScene& opaque, const LightSource& source,
         const DiscontinuityOptions& options, const Progress& progress, DiscontinuityReport& report)
      : scene_(scene),
        opaque_(opaque),
        emitter_scene_(scene, opaque, source.surface),
        exitance_(source.exitance),
        options_(options),
        progress_(progress),
        report_(report),
        tracers_([this] {
          return SwathTracer(scene_, opaque_, emitter_scene_,
                             {options_.irradiance_tolerance / exitance_, options_.max_length});
        }) {}

  Curves run() {
    report_.silhouette_edges += emitter_scene_.edges.size();
    const auto edge_count = emitter_scene_.edges.size();
    if (options_.ev) {
      trace(edge_count, "vertex and edge",
            [&](int e, const SwathSink& sink) { edge_swaths(emitter_scene_, e, sink); });
      trace(emitter_scene_.vertices.size(), "edge and vertex",
            [&](int v, const SwathSink& sink) { vertex_swaths(emitter_scene_, v, sink); });
    }
    if (options_.face)
      trace(scene_.surfaces.size(), "planes of faces", [&](int r, const SwathSink& sink) {
        if (r != emitter_scene_.emitter && !scene_.surfaces[at(r)].back)
          face_swaths(scene_, emitter_scene_, opaque_, r, sink);
      });
    if (options_.eee) find_triples();
    for (int r = 0; r < static_cast<int>(scene_.surfaces.size()); ++r) {
      if (progress_.stopped()) break;
      if (options_.face) emitter_plane_curves(scene_, opaque_, emitter_scene_, r, curves_);
      if (options_.contact) contact_curves(scene_, opaque_, emitter_scene_, r, curves_);
    }
    for (const SwathTracer& tracer : tracers_) {
      report_.swaths += tracer.counts().swaths;
      report_.pieces += tracer.counts().pieces;
    }
    for (const DiscontinuityCurve& curve : curves_)
      ++report_.found[static_cast<std::size_t>(curve.kind)];
    merge();
    predict_jumps();
    return std::move(curves_);
  }

 private:
  /// Traces the swaths of `count` generators, in parallel, and keeps the curves in their order.
  template <class Generate>
  void trace(std::size_t count, const char* name, const Generate& generate) {
    std::vector<Curves> found(count);
    parallel_for(
        count,
        [&](std::size_t i) {
          SwathTracer& tracer = tracers_.local();
          generate(static_cast<int>(i), [&](const Swath& swath) { tracer.trace(swath, found[i]); });
        },
        progress_, name);
    for (Curves& curves : found) append(std::move(curves), curves_);
  }

  void find_triples() {
    const std::size_t count = emitter_scene_.edges.size();
    std::vector<std::vector<int>> later(count);
    parallel_for(
        count,
        [&](std::size_t e) { later[e] = later_partners(emitter_scene_, static_cast<int>(e)); },
        progress_, "pairs of edges");
    trace(count, "three edges", [&](int a, const SwathSink& sink) {
      std::vector<int> common;
      for (const int b : later[at(a)]) {
        pair_swaths(emitter_scene_, a, b, sink);
        common.clear();
        std::set_intersection(later[at(a)].begin(), later[at(a)].end(), later[at(b)].begin(),
                              later[at(b)].end(), std::back_inserter(common));
        for (const int c : common) triple_swath(emitter_scene_, a, b, c, sink);
      }
    });
  }

  /// Receiver by receiver, each with its own idea of what is the same.
  void merge() {
    sort_by_receiver(curves_);
    Curves merged;
    for (auto begin = curves_.begin(); begin != curves_.end();) {
      const int receiver = begin->receiver;
      const auto end = std::find_if(begin, curves_.end(), [&](const DiscontinuityCurve& curve) {
        return curve.receiver != receiver;
      });
      Curves own(std::make_move_iterator(begin), std::make_move_iterator(end));
      report_.merged += merge_coincident(own, tolerance_of(scene_.surfaces[at(receiver)]).length);
      append(std::move(own), merged);
      begin = end;
    }
    curves_ = std::move(merged);
  }

  void predict_jumps() {
    PerThread<JumpPredictor> predictors(
        [this] { return JumpPredictor(scene_, opaque_, emitter_scene_); });
    parallel_for(
        curves_.size(),
        [&](std::size_t i) {
          predictors.local().predict(curves_[i]);
          for (double& jump : curves_[i].jump) jump *= exitance_;
        },
        progress_, "jumps");
  }

  const SoundScene& scene_;
  const OpaqueScene& opaque_;
  const EmitterScene emitter_scene_;
  double exitance_;
  const DiscontinuityOptions& options_;
  const Progress& progress_;
  DiscontinuityReport& report_;
  PerThread<SwathTracer> tracers_;
  Curves curves_;
};

}  // namespace

Discontinuities find_discontinuities(const SoundScene& scene, const OpaqueScene& opaque,
                                     std::span<const LightSource> sources,
                                     const DiscontinuityOptions& options,
                                     const Progress& progress) {
  Discontinuities result;
  result.sources.assign(sources.begin(), sources.end());
  for (const LightSource& source : sources) {
    append(Search(scene, opaque, source, options, progress, result.report).run(), result.curves);
  }
  sort_by_receiver(result.curves);
  result.report.interrupted = progress.stopped();
  return result;
}

}  // namespace halfshade
