#include "solver/adapt/adaptive_field.h"

#include "solver/adapt/element_choices.h"
#include "solver/adapt/element_fit.h"
#include "solver/adapt/field_beginnings.h"
#include "solver/adapt/fitted_element.h"
#include "solver/adapt/near_looks.h"
#include "solver/adapt/possible_wholes.h"
#include "solver/adapt/sample_forecast.h"
#include "solver/adapt/unknown_trade.h"
#include "solver/adapt/watched_errors.h"
#include "solver/elements/balancing_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>

namespace halfshade {
namespace {

constexpr int most_rounds = 60, most_balances = 4, most_merges = 20;
/// Of the square of the error allowed: what may come of elements left alone, and of dropping
/// orders.
constexpr double share_left_alone = 0.25, share_after_merging = 0.7, share_after_dropping = 0.8;
/// Places of an element at which its estimate is checked, and by how much it may be off there.
constexpr std::size_t checks = 4;
constexpr double noticeably = 2;
/// Close to corners and edges: so many samples, and half of what all others take.
constexpr std::size_t least_near_looks = 20000;
/// Samples of another way may look at more each, in shadows' edges only: so many times what it
/// takes must be left.
constexpr double enough = 4;

class Adaptation {
 public:
  Adaptation(PatchMesh& mesh, const FieldAt& field, const AdaptiveFieldOptions& options,
             const Progress& progress, const Watched& watched)
      : mesh_(mesh), field_(field), options_(options), progress_(progress), watched_(watched) {
    take_elements();
    const std::vector<int> orders = beginning_orders(table_, counted_, options);
    for (std::size_t e = 0; e < elements_.size(); ++e) set_order(elements_[e], orders[e]);
  }

  AdaptiveField run() {
    fit_new();
    refine_and_balance();
    if (options_.merge && report_.limit == FieldLimit::none && merge_parts()) refine_and_balance();
    if (options_.order < 0 && report_.limit == FieldLimit::none)
      drop_orders(elements_, options_, share_after_dropping * allowed());
    return result();
  }

 private:
  void refine() {
    while (report_.limit == FieldLimit::none) {
      if (progress_.stopped()) {
        report_.limit = FieldLimit::stopped;
        break;
      }
      sum_up();
      if (square_error_ <= allowed() && check_new()) break;
      if (square_error_ <= allowed()) continue;
      if (!improve()) break;
      fit_new();
    }
  }

  /// Elements that matter most get better still where others can have fewer unknowns then.
  void refine_and_balance() {
    refine();
    for (int k = 0; k < most_balances && options_.balance && options_.order < 0; ++k) {
      if (report_.limit != FieldLimit::none || samples_left(options_) <= 0) return;
      const auto better = better_spread(elements_, options_, share_after_dropping * allowed());
      if (better.empty()) return;
      is_met_ = true;
      if (change(better) != FieldLimit::none) return;
      fit_new();
      refine();
    }
  }

  /// Where elements are smaller than they need be, the whole takes the place of its parts, as far
  /// as the error allows it, and has to prove itself. False if there are none.
  bool merge_parts() {
    bool is_changed = false;
    for (int round = 0; round < most_merges; ++round) {
      std::vector<int> parts;
      double square_error = square_error_;
      const double each = allowed() / static_cast<double>(unknowns_);  // unknown may err so much
      for (const PossibleWhole& whole :
           possible_wholes(mesh_, elements_, options_.order, options_.highest_order)) {
        square_error += whole.more;
        if (square_error > share_after_merging * allowed() || whole.more > each * whole.fewer)
          break;
        parts.insert(parts.end(), whole.parts.begin(), whole.parts.end());
        whole_fits_[whole.node] = whole.fit;
      }
      const std::size_t before = elements_.size();
      if (!parts.empty()) take_elements(mesh_.merge(parts));
      if (elements_.size() == before || progress_.stopped()) break;
      is_changed = true;
      is_met_ = true;
      fit_new();
      sum_up();
      check_new();
    }
    return is_changed;
  }

  /// Square of the error.
  double allowed() const { return options_.tolerance * options_.tolerance * square_norm(); }

  Rgb scale() const { return scale_.value_or(Rgb::Ones()); }

  /// Of what errors are relative to.
  double square_norm() const {
    const double norm = options_.norm * scale().minCoeff();
    return options_.weight ? norm * norm : std::max(square_, norm * norm);
  }

  void sum_up() {
    square_error_ = square_ = 0;
    unknowns_ = 0;
    for (const FittedElement& element : elements_) {
      square_error_ += element.square_error();
      square_ += element.area * element.fit.coefficients.matrix().squaredNorm();
      unknowns_ += static_cast<std::size_t>(basis_size(element.fit.order));
    }
  }

  /// Reads the mesh; elements that are parts of others begin with what those knew.
  void take_elements(std::span<const int> node_now = {}) {
    table_ = mesh_.elements();
    counted_ = counted_elements(table_, options_);
    const PatchHierarchy hierarchy = mesh_.hierarchy();
    std::vector<FittedElement> before = std::move(elements_);
    std::unordered_map<int, int> index_before = std::move(index_of_node_);
    std::unordered_map<int, ElementFit> whole_fits;
    if (!node_now.empty()) {
      for (const auto& [node, e] : std::exchange(index_before, {}))
        if (const int now = node_now[at(node)]; now >= 0) index_before[now] = e;
      for (auto& [node, fit] : std::exchange(whole_fits_, {}))
        whole_fits[node_now[at(node)]] = std::move(fit);
    }
    elements_.assign(table_.corners.size(), {});
    index_of_node_.clear();
    for (int node = 0; node < static_cast<int>(hierarchy.element.size()); ++node) {
      const int e = hierarchy.element[at(node)];
      if (e < 0) continue;
      index_of_node_[node] = e;
      int known = node;
      while (known >= 0 && !index_before.contains(known)) known = hierarchy.parent[at(known)];
      FittedElement& element = elements_[at(e)];
      element.triangle = table_.triangle(e);
      element.normal = table_.normal[at(e)];
      element.surface = table_.surface[at(e)];
      element.area = table_.area[at(e)];
      element.weight = mean_weight(options_.weight, element.surface, element.triangle);
      if (const auto whole = whole_fits.find(node); known < 0 && whole != whole_fits.end())
        element.fit = std::move(whole->second);
      if (known < 0) continue;
      const FittedElement& whole = before[at(index_before.at(known))];
      if (known == node) {
        element.fit = whole.fit;
        element.is_fitted = whole.is_fitted;
        element.is_checked = whole.is_checked;
        element.is_broken = whole.is_broken;
        continue;
      }
      std::array<TrianglePlace, 3> corners;
      for (std::size_t k = 0; k < 3; ++k)
        corners[k] = place_of(whole.triangle, element.triangle[k]);
      element.fit = restrict_fit(whole.fit, corners);
    }
  }

  /// Values of the field at places of some elements, scaled; empty if it was stopped on the way.
  std::vector<Rgb> sample(const std::vector<FieldPoint>& points) {
    std::vector<Rgb> values = field_(points, progress_);
    report_.samples += points.size();
    if (progress_.stopped()) return {};
    if (!scale_) scale_ = balancing_scale(values);
    for (Rgb& value : values) value *= *scale_;
    return values;
  }

  void fit_new() {
    std::vector<FieldPoint> points;
    for (const FittedElement& element : elements_)
      if (!element.is_fitted)
        for (const TrianglePlace& place : sampling_rule(element.fit.order).places)
          points.push_back(point_at(element, place));
    const std::vector<Rgb> values = sample(points);
    if (values.empty()) return;
    ++report_.rounds;
    std::size_t next = 0;
    for (FittedElement& element : elements_) {
      if (element.is_fitted) continue;
      ChannelArray samples(sampling_rule(element.fit.order).weights.size(), 3);
      for (Eigen::Index k = 0; k < samples.rows(); ++k) samples.row(k) = values[next++];
      element.fit = fit_element(element.fit.order, samples);
      element.is_fitted = true;
      element.is_checked = false;
    }
  }

  /// Looks at places that the fits do not know. True if the estimates stand.
  bool check_new() {
    std::vector<FieldPoint> points;
    std::vector<TrianglePlace> places;
    for (const FittedElement& element : elements_) {
      if (element.is_checked) continue;
      // Others where the order was another.
      const std::size_t first = first_spread(element.triangle) + at(checks * element.fit.order);
      for (std::size_t k = first; k < first + checks; ++k) {
        places.push_back(spread_place(k));
        points.push_back(point_at(element, places.back()));
      }
    }
    const std::vector<Rgb> values = sample(points);
    if ((values.empty() && !points.empty()) || !check_near()) return false;
    const double before = square_error_;
    std::size_t next = 0;
    for (FittedElement& element : elements_) {
      if (element.is_checked) continue;
      const double error = error_at(element, std::span(places).subspan(next, checks),
                                    std::span(values).subspan(next, checks));
      next += checks;
      element.is_checked = true;
      if (error > noticeably * element.fit.error) element.fit.error = error;
    }
    if (!check_watched()) return false;
    sum_up();
    return square_error_ <= std::max(before, allowed());
  }

  /// The same close to corners and edges that are watched. False if it was stopped.
  bool check_near() {
    const std::size_t most = least_near_looks + report_.samples / 2;
    if (near_looks_ > most) return true;
    const std::vector<NearLook> looks =
        near_looks(elements_, watched_, square_ / counted_.area, most - near_looks_);
    if (looks.empty()) return true;
    std::vector<FieldPoint> points;
    for (const NearLook& look : looks)
      points.push_back(point_at(elements_[at(look.element)], look.place));
    const std::vector<Rgb> values = sample(points);
    if (values.size() < points.size()) return false;
    near_looks_ += looks.size();
    take_near_looks(looks, values, elements_);
    return true;
  }

  /// The same at the places that are watched. False if it was stopped.
  bool check_watched() {
    if (watched_values_.empty() && !watched_.places.empty()) {
      std::vector<FieldPoint> points;
      for (const WatchedPlace& watched : watched_.places) points.push_back(watched.place);
      watched_values_ = sample(points);
      if (watched_values_.empty()) return false;
    }
    if (watched_.places.empty()) return true;
    const auto fitted = [this](int e, const TrianglePlace& place) {
      return fitted_at(elements_[at(e)], place);
    };
    for (const auto& [e, found] :
         watched_errors(table_, watched_.places, watched_values_, fitted)) {
      ElementFit& fit = elements_[at(e)].fit;
      const double error = std::sqrt(found.square);
      // One place may be off by chance.
      if (error <= (found.places > 1 ? 1 : noticeably) * fit.error) continue;
      fit.error = error;
      elements_[at(e)].is_broken = true;
    }
    return true;
  }

  /// Whether the rest is likely to take more samples than another way would, and there are so many.
  bool is_dearer_than_other_way() {
    const double other = options_.samples_of_other_way;
    return other > 0 && !is_met_ && samples_left(options_) > enough * other &&
           forecast_.rest_takes_more(other, static_cast<double>(report_.samples),
                                     square_error_ / allowed());
  }

  /// False, with a limit set, if nothing can be done.
  bool improve() {
    if (is_dearer_than_other_way())
      report_.limit = FieldLimit::samples;
    else if (samples_left(options_) <= 0)
      report_.limit = FieldLimit::work;
    else if (report_.rounds >= most_rounds)
      report_.limit = FieldLimit::rounds;
    if (report_.limit != FieldLimit::none) return false;
    const double may_stay = share_left_alone * allowed();
    std::vector<std::pair<int, int>> better;
    for (const int e : worst_elements(elements_, may_stay))
      better.emplace_back(e, better_order(elements_[at(e)], options_, may_stay / counted_.count));
    return (report_.limit = change(better)) == FieldLimit::none;
  }

  /// Gives elements other orders, or splits those whose own it is, as far as limits allow that.
  /// What kept it from any.
  FieldLimit change(std::span<const std::pair<int, int>> orders) {
    std::vector<int> to_split;
    double unknowns = static_cast<double>(unknowns_), count = static_cast<double>(elements_.size());
    double samples = samples_left(options_);
    bool is_changed = false;
    FieldLimit limit = FieldLimit::fixed;
    for (const auto& [e, order] : orders) {
      FittedElement& element = elements_[at(e)];
      const int size = basis_size(element.fit.order);
      const bool split = order == element.fit.order;
      if (split && !options_.split) continue;
      const double more = split ? (elements_for_one - 1) * size : basis_size(order) - size;
      samples -= sampling_rule(order).count() * (split ? elements_for_one : 1);
      if (unknowns + more > options_.max_unknowns || samples < 0) {
        limit = samples < 0 ? FieldLimit::work : FieldLimit::unknowns;
        break;
      }
      if (split && count + elements_for_one - 1 > options_.max_elements) {
        limit = FieldLimit::elements;
        continue;
      }
      unknowns += more;
      is_changed = true;
      if (split) {
        count += elements_for_one - 1;
        to_split.push_back(e);
      } else {
        set_order(element, order);
      }
    }
    if (!is_changed) return limit;
    if (!to_split.empty()) {
      mesh_.bisect(to_split);
      take_elements();
    }
    progress_(fmt::format("refinement, round {}: {} elements, {} unknowns, error {:.2g}",
                          report_.rounds + 1, elements_.size(), static_cast<long>(unknowns),
                          std::sqrt(square_error_ / square_)),
              0);
    return FieldLimit::none;
  }

  AdaptiveField result() {
    sum_up();
    AdaptiveField out;
    std::vector<int> order;
    for (const FittedElement& element : elements_) order.push_back(element.fit.order);
    out.field = zero_field(std::move(order));
    out.error.resize(static_cast<Eigen::Index>(elements_.size()));
    const Rgb unscaled = scale().inverse();
    for (int e = 0; e < out.field.count(); ++e) {
      out.field.of(e) = elements_[at(e)].fit.coefficients.rowwise() * unscaled.transpose();
      out.error[e] = elements_[at(e)].fit.error * unscaled.maxCoeff();
    }
    out.elements = std::move(table_);
    report_.unknowns = unknowns_;
    const double square = options_.weight ? square_norm() : square_;
    report_.relative_error = square > 0 ? std::sqrt(square_error_ / square) : 0;
    out.report = report_;
    return out;
  }

  PatchMesh& mesh_;
  const FieldAt& field_;
  const AdaptiveFieldOptions& options_;
  const Progress& progress_;
  const Watched& watched_;
  std::vector<Rgb> watched_values_;
  ElementTable table_;
  CountedElements counted_;
  std::vector<FittedElement> elements_;
  std::unordered_map<int, int> index_of_node_;
  SampleForecast forecast_;
  std::unordered_map<int, ElementFit> whole_fits_;  ///< of nodes that may become elements
  bool is_met_ = false;       ///< the tolerance was, once: samples are no limit any more
  std::optional<Rgb> scale_;  ///< of all values, by channel; once they are known
  double square_error_ = 0, square_ = 0;
  std::size_t unknowns_ = 0, near_looks_ = 0;
  AdaptiveFieldReport report_;
};

}  // namespace

AdaptiveField fit_adaptively(PatchMesh& mesh, const FieldAt& field,
                             const AdaptiveFieldOptions& options, const Progress& progress,
                             const Watched& watched) {
  require_usable(options);
  return Adaptation(mesh, field, options, progress, watched).run();
}

}  // namespace halfshade
