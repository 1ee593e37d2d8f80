#include "meshing/discontinuity/curve_search.h"

#include "meshing/core/parallel.h"
#include "meshing/discontinuity/border_events.h"
#include "meshing/discontinuity/horizon_events.h"
#include "meshing/discontinuity/search_budget.h"
#include "meshing/discontinuity/swath_tracer.h"
#include "meshing/events/events.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace halfshade {
namespace {

using Curves = std::vector<DiscontinuityCurve>;

// A forecast looks at so many jobs of a kind, and for so much work at each.
constexpr std::size_t most_jobs_in_forecast = 64;
constexpr double most_for_forecast = 3e4;

void append(Curves&& more, Curves& curves) {
  curves.insert(curves.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
}

/// One worker a thread, made when it is first needed. Results do not depend on which thread has
/// done what, for workers keep nothing between jobs but buffers and counts.
template <class Worker>
using PerThread = tbb::enumerable_thread_specific<Worker>;

/// The search for one emitter's curves.
class Search {
 public:
  Search(const LitFromOne& lit, const DiscontinuityOptions& options, double most_work,
         const Progress& progress)
      : scene_(lit.scene),
        opaque_(lit.opaque),
        emitter_scene_(lit.emitter_scene),
        receivers_(lit.receivers),
        options_(options),
        progress_(progress),
        budget_(most_work, emitter_scene_.edges.size()),
        tracers_([this, exitance = lit.exitance] {
          return SwathTracer(scene_, opaque_, emitter_scene_,
                             {options_.irradiance_tolerance / exitance, options_.max_length});
        }),
        borders_([this] { return BorderSearch(scene_, opaque_, emitter_scene_); }),
        horizons_([this] { return HorizonSearch(scene_, opaque_, emitter_scene_); }) {
    if (budget_.is_limited()) sampled_ = sample_lines();
  }

  Curves run(DiscontinuityReport& report) {
    report.silhouette_edges += emitter_scene_.edges.size();
    find();
    const TraceCounts counts = counts_so_far();
    report.swaths += counts.swaths;
    report.pieces += counts.pieces;
    report.work += budget_.used();
    for (std::size_t k = 0; k < report.left_out.size(); ++k)
      report.left_out[k] += budget_.left_out()[k];
    for (const DiscontinuityCurve& curve : curves_)
      ++report.found[static_cast<std::size_t>(curve.kind)];
    return std::move(curves_);
  }

  SearchForecast forecast() {
    forecasts_ = true;
    find();
    return {budget_.used(), look_work(counts_so_far(), emitter_scene_.edges.size()), expected_};
  }

 private:
  void find() {
    if (options_.ev) find_vertex_events();
    // They take little of ordinary scenes and matter most, so that they come before what may use up
    // the work; by now it is known how much is seen from a point.
    Curves on_borders = find_border_events();
    const auto edges = static_cast<double>(emitter_scene_.edges.size());
    const double for_each_face =
        SearchBudget::of_test * edges * edges / static_cast<double>(receivers_.size());
    if (options_.face)
      trace(CurveKind::face, {receivers_.size(), for_each_face, "planes of faces"},
            [&](int job, const SwathSink& sink) {
              const int r = receivers_[at(job)];
              if (r != emitter_scene_.emitter && !scene_.surfaces[at(r)].back)
                face_swaths(scene_, emitter_scene_, opaque_, r, sink);
            });
    if (options_.eee) find_triples();
    append(std::move(on_borders), curves_);
    if (options_.horizon && !(options_.irradiance_tolerance > 0)) append(find_horizons(), curves_);
  }

  void find_vertex_events() {
    const auto edges = emitter_scene_.edges.size(), vertices = emitter_scene_.vertices.size();
    trace(CurveKind::ev,
          {edges, SearchBudget::of_test * static_cast<double>(vertices), "vertex and edge"},
          [&](int e, const SwathSink& sink) { edge_swaths(emitter_scene_, e, sink); });
    trace(CurveKind::ev, {vertices, SearchBudget::of_test, "edge and vertex"},
          [&](int v, const SwathSink& sink) { vertex_swaths(emitter_scene_, v, sink); });
  }

  void find_triples() {
    const std::size_t count = emitter_scene_.edges.size();
    if (forecasts_)
      return trace(CurveKind::eee, {count, 0, "three edges"},
                   [&](int a, const SwathSink& sink) { triples_from(a, sink); });
    if (!budget_.allows(CurveKind::eee, work_on_pairs())) return;
    std::vector<std::vector<int>> later(count);
    parallel_for(
        count,
        [&](std::size_t e) { later[e] = later_partners(emitter_scene_, static_cast<int>(e)); },
        progress_, "pairs of edges");
    double triples = 0;
    for (const std::vector<int>& partners : later)
      triples += std::pow(static_cast<double>(partners.size()), 2) / 3;
    const double for_each =
        SearchBudget::of_swath * triples / static_cast<double>(std::max<std::size_t>(count, 1));
    trace(CurveKind::eee, {count, for_each, "three edges"}, [&](int a, const SwathSink& sink) {
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

  /// Told from some edges.
  double work_on_pairs() const {
    if (!budget_.is_limited()) return 0;
    const std::size_t count = emitter_scene_.edges.size();
    const std::vector<std::size_t> sample = budget_.sample(count);
    std::size_t pairs = 0;
    for (const std::size_t e : sample)
      pairs += 1 + later_partners(emitter_scene_, static_cast<int>(e)).size();
    return SearchBudget::of_pair * static_cast<double>(pairs * count) /
           static_cast<double>(std::max<std::size_t>(sample.size(), 1));
  }

  /// Those of an edge with later ones.
  void triples_from(int a, const SwathSink& sink) const {
    const auto front = [&](int e) { return emitter_scene_.edges[at(e)].front; };
    const std::vector<int> partners = later_partners(emitter_scene_, a);
    for (auto b = partners.begin(); b != partners.end(); ++b) {
      pair_swaths(emitter_scene_, a, *b, sink);
      for (auto c = b + 1; c != partners.end(); ++c)
        if (may_line_up(emitter_scene_, front(*b), front(*c)))
          triple_swath(emitter_scene_, a, *b, *c, sink);
    }
  }

  Curves find_border_events() {
    const double look = look_work(counts_so_far(), emitter_scene_.edges.size());
    // A method of BorderSearch as the job of each receiver.
    const auto find = [&](auto method) {
      return [this, method](std::size_t job, double most, Curves& found) {
        BorderSearch& borders = borders_.local();
        const SightEffort before = borders.effort();
        const bool is_done = (borders.*method)(receivers_[job], most, found);
        return Done{work_of(borders.effort() - before), is_done};
      };
    };
    const std::size_t count = receivers_.size();
    std::size_t contacts = 0;
    for (const int r : receivers_) contacts += scene_.surfaces[at(r)].contacts.size();
    // At least one look at each surface, and one on either side of a contact line.
    const double of_contacts =
        2 * look * static_cast<double>(contacts) / static_cast<double>(count);
    // They are of the whole scene, which a forecast among some surfaces is not to see.
    const double of_limits =
        forecasts_ ? 0
                   : SearchBudget::of_test * static_cast<double>(borders_.local().limit_tests());
    Curves found;
    if (options_.face)
      found = run_all(CurveKind::face, {count, look + of_limits, "plane of the light"},
                      find(&BorderSearch::add_plane_curves));
    if (options_.contact)
      append(run_all(CurveKind::contact, {count, of_contacts, "contact lines"},
                     find(&BorderSearch::add_contact_curves)),
             found);
    return found;
  }

  Curves find_horizons() {
    const std::size_t count = receivers_.size();
    std::size_t cut = 0;
    for (const int r : receivers_) cut += horizons_.local().is_cut(r) ? 1 : 0;
    const double for_each = SearchBudget::of_test *
                            static_cast<double>(cut * emitter_scene_.edges.size()) /
                            static_cast<double>(count);
    return run_all(CurveKind::horizon, {count, for_each, "horizon"},
                   [this](std::size_t job, double most, Curves& found) {
                     HorizonSearch& horizons = horizons_.local();
                     const double before = horizons.work();
                     const bool is_done = horizons.add_curves(receivers_[job], most, found);
                     return Done{horizons.work() - before, is_done};
                   });
  }

  /// What lines of sight from the emitter to some of the surfaces meet, so that it is known how
  /// deep the scene is before anything is traced.
  TraceCounts sample_lines() const {
    constexpr std::size_t most = 64;
    const std::size_t count = scene_.surfaces.size(), lines = std::min(most, count);
    SightCaster caster(scene_, opaque_);
    TraceCounts counts;
    for (std::size_t k = 0; k < lines; ++k) {
      const Surface& target = scene_.surfaces[k * count / lines];
      const Vec3 from = emitter_scene_.corners[k % emitter_scene_.corners.size()].position;
      const Vec3 to = target.frame.to_space(target.rings.front().front());
      if (emitter_scene_.frame.height(to) <= emitter_scene_.slack) continue;
      caster.cast({from, from, (to - from).normalized()});
      ++counts.pieces;
      counts.crossings += caster.crossing_count();
    }
    return counts;
  }

  TraceCounts counts_so_far() const {
    TraceCounts sum = sampled_;
    for (const SwathTracer& tracer : tracers_) sum += tracer.counts();
    return sum;
  }

  /// What is done one by one, in parallel.
  struct Jobs {
    std::size_t count;
    double work;  ///< of each, that is known before it is done
    const char* name;
  };
  /// What came of one of them.
  struct Done {
    double work;
    bool is_done;  ///< not ended early
  };

  /// Traces the swaths of all jobs and keeps the curves.
  template <class Generate>
  void trace(CurveKind kind, const Jobs& jobs, const Generate& generate) {
    append(run_all(kind, jobs,
                   [&](std::size_t i, double most, Curves& found) {
                     SwathTracer& tracer = tracers_.local();
                     tracer.begin();
                     const TraceCounts before = tracer.counts();
                     const auto work = [&] {
                       return budget_.work_of(tracer.counts() - before, found.size());
                     };
                     bool is_done = true;
                     const auto may_go_on = [&] { return work() <= most; };
                     generate(static_cast<int>(i), [&](const Swath& swath) {
                       if (progress_.stopped()) return;
                       is_done = is_done && tracer.trace(swath, found, may_go_on);
                     });
                     return Done{work(), is_done};
                   }),
           curves_);
  }

  /// Runs all jobs, in parallel, and returns the curves in the jobs' order. Does so with some of
  /// them first, and leaves the others out if all would take too much work: of a job that ends
  /// early it is only known that it takes more, so that it may go on until that decides. `run`
  /// appends a job's curves and ends it early, if it can, at the work given.
  template <class Run>
  Curves run_all(CurveKind kind, const Jobs& jobs, const Run& run) {
    const double known = jobs.work * static_cast<double>(jobs.count);
    if (forecasts_) {
      budget_.use(known);
      forecast_all(jobs, run);
      return {};
    }
    if (!budget_.allows(kind, known)) return {};
    std::vector<Curves> found(jobs.count);
    std::vector<Done> done(jobs.count, Done{0, false});
    const auto run_one = [&](std::size_t i, double most) {
      found[i].clear();
      done[i] = run(i, most, found[i]);
    };
    const std::vector<std::size_t> sample = budget_.sample(jobs.count);
    for (double most = budget_.most_for_one(jobs.count); !sample.empty(); most *= 4) {
      parallel_for(
          sample.size(),
          [&](std::size_t k) {
            if (!done[sample[k]].is_done) run_one(sample[k], most);
          },
          progress_, jobs.name);
      double tried = 0;
      for (const std::size_t i : sample) tried += done[i].work;
      const double scale = static_cast<double>(jobs.count) / static_cast<double>(sample.size());
      if (progress_.stopped()) return {};
      if (!budget_.allows(kind, tried * scale)) {
        budget_.use(known + tried);
        return {};
      }
      if (std::all_of(sample.begin(), sample.end(), [&](std::size_t i) { return done[i].is_done; }))
        break;
    }
    parallel_for(
        jobs.count,
        [&](std::size_t i) {
          if (!done[i].is_done) run_one(i, HUGE_VAL);
        },
        progress_, jobs.name);
    budget_.use(known);
    for (const Done& one : done) budget_.use(one.work);
    Curves all;
    for (Curves& curves : found) append(std::move(curves), all);
    return all;
  }

  /// Runs some of the jobs and counts the work and the curves of all.
  template <class Run>
  void forecast_all(const Jobs& jobs, const Run& run) {
    const std::vector<std::size_t> sample = spread_jobs(jobs.count, most_jobs_in_forecast);
    std::vector<double> work(sample.size()), found(sample.size());
    parallel_for(
        sample.size(),
        [&](std::size_t k) {
          Curves curves;
          work[k] = run(sample[k], most_for_forecast, curves).work;
          found[k] = static_cast<double>(curves.size());
        },
        progress_, jobs.name);
    for (std::size_t k = 0; k < sample.size(); ++k) {
      const double stands_for =
          static_cast<double>(jobs.count) / static_cast<double>(sample.size());
      budget_.use(stands_for * work[k]);
      expected_ += stands_for * found[k];
    }
  }

  const SoundScene& scene_;
  const OpaqueScene& opaque_;
  const EmitterScene& emitter_scene_;
  std::span<const int> receivers_;
  const DiscontinuityOptions& options_;
  const Progress& progress_;
  SearchBudget budget_;
  TraceCounts sampled_;  ///< of lines cast to know the scene; none if work is not limited
  PerThread<SwathTracer> tracers_;
  PerThread<BorderSearch> borders_;
  PerThread<HorizonSearch> horizons_;
  Curves curves_;
  bool forecasts_ = false;
  double expected_ = 0;  ///< curves
};

}  // namespace

Curves search_curves(const LitFromOne& lit, const DiscontinuityOptions& options, double most_work,
                     const Progress& progress, DiscontinuityReport& report) {
  return Search(lit, options, most_work, progress).run(report);
}

SearchForecast forecast_curves(const LitFromOne& lit, const DiscontinuityOptions& options,
                               const Progress& progress) {
  return Search(lit, options, HUGE_VAL, progress).forecast();
}

}  // namespace halfshade
