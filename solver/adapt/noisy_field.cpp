#include "solver/adapt/noisy_field.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "solver/adapt/field_beginnings.h"
#include "solver/adapt/fresh_places.h"
#include "solver/adapt/noise_peaks.h"
#include "solver/adapt/noisy_element.h"
#include "solver/adapt/wanted_samples.h"
#include "solver/elements/balancing_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace halfshade {
namespace {

constexpr int most_noisy_rounds = 40;
/// Of the square of the error allowed: what may come of elements left alone.
constexpr double noisy_share_left_alone = 0.25;
/// Shares of the mean by which an element matters, and the samples it begins with above them.
constexpr std::array<std::pair<double, int>, 3> first_samples = {{{0.5, 6}, {0.02, 3}, {0, 2}}};
/// Of the same: what a round aims at, if more samples or parts leave this share of an element's.
constexpr double aim_of_round = 0.8, left_of_improved = 0.5;
/// Of what is thought to be left: a round aims at no less. If limits end it early, samples have
/// then gone to the worst elements, not to all that a small tolerance would have better.
constexpr double least_of_round = 0.1;
/// Where elements must not be split, rounds that leave more than this of the square of the error
/// do not pay.
constexpr double hardly_less = 0.97;
/// Of the square of the error allowed: noise of samples, each of which counts with others. Where
/// rays tell nearly the same there is much less than they are told to leave: then so many times as
/// much will do.
constexpr double share_of_noise_in_samples = 0.5, most_ease = 6;
/// Elements, and places that tell how uneven light is before it is known on them.
constexpr double many_at_first = 5000;
constexpr int places_for_peaks = 2000;
/// Of very many samples of the first round so many tell what all would take. If that is more than
/// this share of what may be taken, all are noisier: by this power of it, as rays to an emitter
/// are, see ray_shares.h; then some are tried again.
constexpr std::size_t samples_tried = 200, many_samples = 50 * samples_tried;
constexpr double share_of_first_round = 0.5, noise_for_work = 0.75;
constexpr int most_trials = 5;
/// New elements for one that is split, with what it takes to stay conforming.
constexpr double growth_of_split = 2.5;
/// Places that tell whether the estimate is right.
constexpr double most_fresh = 40000, least_fresh = 10000;
constexpr double fresh_for_one = 0.2;  ///< element
constexpr int most_comparisons = 4;    ///< of so many places each
/// Of the square of the error allowed: what is looked for at least; and how surely.
constexpr double least_estimate = 1e-3, deviations = 3;

void check_noisy(const AdaptiveFieldOptions& options) {
  if (!(options.tolerance > 0 && std::isfinite(options.tolerance)) || options.max_elements < 1 ||
      options.max_unknowns < 1)
    throw Error(ErrorCode::contract, "fit_noisy",
                fmt::format("tolerance ({}), max_elements ({}) or max_unknowns ({}) is out of "
                            "range",
                            options.tolerance, options.max_elements, options.max_unknowns));
}

class NoisyFit {
 public:
  NoisyFit(PatchMesh& mesh, const NoisyFieldAt& field, const FieldBound& bound,
           const AdaptiveFieldOptions& options, const Progress& progress)
      : mesh_(mesh), field_(field), bound_(bound), options_(options), progress_(progress) {
    take_elements();
    const double each = sum_of_reaches(elements_) / counted_.count;
    const double mean_area = counted_.area / counted_.count;
    for (NoisyElement& element : elements_) {
      element.slack = slack_of(element, mean_area);
      const double share = each > 0 ? element.area * element.reach / each : 1;
      const auto reaches = [&](const auto& samples) { return share >= samples.first; };
      element.wanted = std::ranges::find_if(first_samples, reaches)->second;
    }
    find_peaks();
    afford_first_round();
  }

  AdaptiveField run() {
    while (true) {
      const double peaks = peaks_;
      sample_and_fit();
      sum_up();
      if (report_.rounds == 1)
        allow_noise(std::pow(peaks_ / peaks, 2) * sum_of_noise(elements_), allowed());
      if (progress_.stopped()) report_.limit = FieldLimit::stopped;
      if (report_.limit != FieldLimit::none) break;
      if (square_error_ <= allowed()) {
        compare();
        if (corrected() <= allowed() || progress_.stopped()) break;
      }
      if (!improve()) break;
    }
    if (correction_of_round_ != report_.rounds && !progress_.stopped()) compare();
    if (report_.limit != FieldLimit::stopped && corrected() <= allowed())
      report_.limit = FieldLimit::none;
    return result();
  }

 private:
  /// Where very many elements begin, the noise that they may have is worth some places.
  void find_peaks() {
    if (counted_.count < many_at_first) return;
    const PeakPlaces places = peak_places(elements_, places_for_peaks);
    const std::vector<NoisyValue> values =
        sample(places.points, std::vector<double>(places.points.size(), most_peaks));
    if (values.size() != places.points.size()) return;
    const FirstLook look = first_look(places, values);
    peaks_ = look.peaks;
    allow_noise(std::pow(peaks_ / most_peaks, 2) * look.noise, square_of_tolerance() * look.square);
  }

  /// Makes samples noisier where the first round would take too much.
  void afford_first_round() {
    if (!options_.work_done) return;
    const WantedSamples all = wanted_samples(elements_, peaks_);
    if (all.points.size() < many_samples) return;
    const WantedSamples tried = some_of(all, samples_tried);
    for (int trial = 0; trial < most_trials && !progress_.stopped(); ++trial) {
      const double before = options_.work_done();
      sample(tried.points, tried.slack);
      const double done = options_.work_done();
      const double each = (done - before) / static_cast<double>(samples_tried);
      const double excess =
          each * static_cast<double>(all.points.size()) / (share_of_first_round * (1 - done));
      if (done >= 1 || excess <= 1) break;
      least_ease_ = ease_ *= std::pow(excess, noise_for_work);
    }
  }

  /// What noise there may be, if there is so much for now.
  void allow_noise(double now, double allowed) {
    const double wanted = share_of_noise_in_samples * std::max(allowed, 0.);
    const double ease = now > 0 ? ease_ * std::sqrt(wanted / now) : most_ease;
    ease_ = std::clamp(ease, least_ease_, std::max(least_ease_, most_ease));
  }

  /// Squares of errors. Noise may make square_error_ negative.
  double square_of_tolerance() const { return options_.tolerance * options_.tolerance; }
  double allowed() const { return square_of_tolerance() * square_; }
  double estimated() const { return std::max(square_error_, least_estimate * allowed()); }
  double corrected() const { return correction_ * estimated(); }

  /// Reads the mesh; parts of an element share its samples.
  void take_elements() {
    table_ = mesh_.elements();
    counted_ = counted_elements(table_, options_);
    const PatchHierarchy hierarchy = mesh_.hierarchy();
    std::vector<NoisyElement> before = std::move(elements_);
    std::vector<int> index_before = std::move(index_of_node_);
    index_before.resize(hierarchy.element.size(), -1);
    elements_.assign(table_.corners.size(), {});
    index_of_node_ = hierarchy.element;
    std::vector<std::vector<int>> parts(before.size());  // of elements before
    for (int node = 0; node < static_cast<int>(hierarchy.element.size()); ++node) {
      const int e = hierarchy.element[at(node)];
      if (e < 0) continue;
      int known = node;
      while (known >= 0 && index_before[at(known)] < 0) known = hierarchy.parent[at(known)];
      NoisyElement& element = elements_[at(e)];
      if (known == node) {
        element = std::move(before[at(index_before[at(known)])]);
        continue;
      }
      element.triangle = table_.triangle(e);
      element.normal = table_.normal[at(e)];
      element.surface = table_.surface[at(e)];
      element.area = table_.area[at(e)];
      element.wanted = least_samples_of_parts;
      if (known < 0) continue;
      element.slack = before[at(index_before[at(known)])].slack;
      parts[at(index_before[at(known)])].push_back(e);
    }
    for (std::size_t whole = 0; whole < before.size(); ++whole)
      share_samples(before[whole], parts[whole], elements_);
    find_reaches();
  }

  void find_reaches() {
    std::vector<double> most(elements_.size());
    parallel_for(elements_.size(), [&](std::size_t e) {
      if (elements_[e].reach < 0)
        most[e] = bound_(point_at(elements_[e], TrianglePlace::Constant(1. / 3)));
    });
    // Squares of light of any size must not over- or underflow.
    if (largest_ < 0) largest_ = *std::max_element(most.begin(), most.end());
    for (std::size_t e = 0; e < elements_.size(); ++e)
      if (elements_[e].reach < 0)
        elements_[e].reach = largest_ > 0 ? std::pow(std::min(most[e] / largest_, 1.), 2) : 1;
  }

  /// As many samples as are wanted, and what follows from them.
  void sample_and_fit() {
    const WantedSamples all = wanted_samples(elements_, peaks_);
    const std::vector<NoisyValue> values = sample(all.points, all.slack);
    if (values.size() < all.points.size()) return;
    ++report_.rounds;
    parallel_for(all.elements.size(), [&](std::size_t i) {
      NoisyElement& element = elements_[at(all.elements[i])];
      for (std::size_t k = all.first[i]; k < all.first[i + 1]; ++k)
        element.samples.push_back({all.places[k], values[k]});
      fit(element);
    });
  }

  /// Values of the field, scaled; none if it was stopped on the way.
  std::vector<NoisyValue> sample(const std::vector<FieldPoint>& points, std::vector<double> slack) {
    for (double& times : slack) times *= ease_;
    std::vector<NoisyValue> values = field_(points, slack, progress_);
    report_.samples += points.size();
    if (progress_.stopped()) return {};
    if (!scale_) {
      std::vector<Rgb> means;
      for (const NoisyValue& value : values) means.push_back(value.mean());
      if (std::ranges::any_of(means, [](const Rgb& mean) { return (mean > 0).any(); }))
        scale_ = balancing_scale(means);
    }
    const Rgb scale = scale_.value_or(Rgb::Ones());
    for (NoisyValue& value : values) value = {value.a * scale, value.b * scale};
    return values;
  }

  void sum_up() {
    suspect_unseen(table_.neighbours, elements_);
    square_error_ = square_ = 0;
    unknowns_ = 0;
    for (const NoisyElement& element : elements_) {
      square_error_ += element.area * element.square_error();
      square_ += element.area * element.coefficients.matrix().squaredNorm();
      unknowns_ += static_cast<std::size_t>(element.coefficients.rows());
    }
    peaks_ = peaks_of(elements_);
  }

  /// Compares the elements with samples that they do not know; with more of them while what these
  /// are off by chance is most of what they say, and too much.
  void compare() {
    const double count = std::clamp(fresh_for_one * counted_.count, least_fresh, most_fresh);
    SquareError error;
    double by_chance = 0;
    do {
      const auto draw =
          static_cast<std::uint64_t>(report_.rounds * most_comparisons + error.count());
      const FreshPlaces fresh = fresh_places(elements_, options_, estimated(), count, draw);
      const std::vector<NoisyValue> values =
          sample(fresh.points, std::vector<double>(fresh.points.size(), peaks_));
      if (values.size() < fresh.points.size() || fresh.points.empty()) break;
      error.add(fresh, values, elements_);
      by_chance = deviations * error.deviation();
      correction_ = std::max((error.mean() + by_chance) / estimated(), 1.);
      correction_of_round_ = report_.rounds;
    } while (error.count() < most_comparisons && by_chance > error.mean() &&
             corrected() > allowed());
  }

  /// False, with a limit set, if nothing can be done.
  bool improve() {
    double left = samples_left(options_);
    if (left <= 0) report_.limit = FieldLimit::work;
    if (report_.rounds >= most_noisy_rounds) report_.limit = FieldLimit::rounds;
    if (report_.limit != FieldLimit::none) return false;
    // Samples that compared the elements are theirs now.
    parallel_for(elements_.size(), [&](std::size_t e) {
      NoisyElement& element = elements_[e];
      if (element.samples.size() <= at(element.wanted)) return;
      fit(element);
      element.wanted = static_cast<int>(element.samples.size());
    });
    sum_up();
    std::vector<int> to_split;
    double count = static_cast<double>(elements_.size()), unknowns = static_cast<double>(unknowns_);
    bool is_changed = false;
    FieldLimit limit = FieldLimit::fixed;
    for (const int e : worst()) {
      NoisyElement& element = elements_[at(e)];
      if (const int samples = next_samples(element); at(samples) > element.samples.size()) {
        left -= samples - static_cast<double>(element.samples.size());
        if (left < 0) limit = FieldLimit::work;
        if (left < 0) break;
        element.wanted = samples;
        is_changed = true;
        continue;
      }
      if (!options_.split) continue;
      if (count + growth_of_split - 1 > options_.max_elements) {
        limit = FieldLimit::elements;
        continue;
      }
      if (unknowns + (growth_of_split - 1) * basis_size(1) > options_.max_unknowns) {
        limit = FieldLimit::unknowns;
        continue;
      }
      count += growth_of_split - 1;
      unknowns += (growth_of_split - 1) * basis_size(1);
      to_split.push_back(e);
    }
    const bool is_stuck =
        limit != FieldLimit::fixed && square_error_ > hardly_less * last_square_error_;
    if (to_split.empty() && (!is_changed || is_stuck)) {
      report_.limit = limit;
      return false;
    }
    last_square_error_ = square_error_;
    if (!to_split.empty()) {
      mesh_.bisect(to_split);
      take_elements();
    }
    progress_(fmt::format("refinement, round {}: {} elements, {} unknowns, error {:.2g}",
                          report_.rounds + 1, elements_.size(), static_cast<long>(unknowns),
                          std::sqrt(corrected() / square_)),
              0);
    return true;
  }

  /// The fewest elements that are likely to make the error do, and without which it would.
  std::vector<int> worst() const {
    std::vector<std::pair<double, int>> heap;  // error and −index
    for (int e = 0; e < static_cast<int>(elements_.size()); ++e)
      heap.emplace_back(elements_[at(e)].area * elements_[at(e)].known_error(), -e);
    const double known = known_error(elements_);
    // The sum over elements of what noise did not surely make is not what is said of all together.
    const double most = std::clamp(allowed() / correction_, least_of_round * known, known);
    const double may_stay = noisy_share_left_alone * most, aim = aim_of_round * most;
    std::ranges::make_heap(heap);
    std::vector<int> found;
    double without = known, after = known;
    while (!heap.empty() && without > may_stay && after > aim) {
      std::ranges::pop_heap(heap);
      const auto [error, minus_e] = heap.back();
      found.push_back(-minus_e);
      heap.pop_back();
      without -= error;
      after -= (1 - left_of_improved) * error;
    }
    return found;
  }

  AdaptiveField result() {
    sum_up();
    AdaptiveField out;
    std::vector<int> order;
    for (const NoisyElement& element : elements_) order.push_back(element.order);
    out.field = zero_field(std::move(order));
    out.error.resize(static_cast<Eigen::Index>(elements_.size()));
    // Of each, only that is known which noise did not make; together they are off by all there is.
    const double known = known_error(elements_);
    const auto square_error = [&](const NoisyElement& element) {
      return known > 0 ? corrected() / known * element.known_error() : corrected() / counted_.area;
    };
    const Rgb unscaled = scale_.value_or(Rgb::Ones()).inverse();
    for (int e = 0; e < out.field.count(); ++e) {
      const NoisyElement& element = elements_[at(e)];
      out.field.of(e) = element.coefficients.rowwise() * unscaled.transpose();
      out.error[e] = std::sqrt(square_error(element)) * unscaled.maxCoeff();
    }
    out.elements = std::move(table_);
    report_.unknowns = unknowns_;
    report_.is_noisy = true;
    report_.relative_error = square_ > 0 ? std::sqrt(corrected() / square_) : 0;
    out.report = report_;
    return out;
  }

  PatchMesh& mesh_;
  const NoisyFieldAt& field_;
  const FieldBound& bound_;
  const AdaptiveFieldOptions& options_;
  const Progress& progress_;
  ElementTable table_;
  CountedElements counted_;
  std::vector<NoisyElement> elements_;
  double largest_ = -1;             ///< bound of the first elements; < 0: not known yet
  std::vector<int> index_of_node_;  ///< of elements_; −1: of none
  std::optional<Rgb> scale_;        ///< of all values, by channel; once they are known
  double square_error_ = 0, square_ = 0;
  double last_square_error_ = HUGE_VAL;  ///< square_error_ of the round before
  double correction_ = 1;  ///< of the square of the error, as the last comparison has it
  int correction_of_round_ = -1;
  double peaks_ = 1;       ///< as last known: values may be so much noisier than usual
  double ease_ = 1;        ///< and again so many times, as there is less noise than is thought
  double least_ease_ = 1;  ///< that can be afforded
  std::size_t unknowns_ = 0;
  AdaptiveFieldReport report_;
};

}  // namespace

AdaptiveField fit_noisy(PatchMesh& mesh, const NoisyFieldAt& field, const FieldBound& bound,
                        const AdaptiveFieldOptions& options, const Progress& progress) {
  check_noisy(options);
  return NoisyFit(mesh, field, bound, options, progress).run();
}

}  // namespace halfshade
