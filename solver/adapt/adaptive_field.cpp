#include "solver/adapt/adaptive_field.h"

#include "meshing/core/error.h"
#include "solver/adapt/element_fit.h"
#include "solver/adapt/field_beginnings.h"
#include "solver/adapt/watched_errors.h"
#include "solver/elements/balancing_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <queue>
#include <unordered_map>

namespace halfshade {
namespace {

constexpr int most_rounds = 60;
/// Coefficients that shrink faster from degree to degree are worth more of them: with this decay,
/// one more order and four smaller elements gain alike per unknown.
constexpr double smooth = 0.45;
constexpr double most_orders_at_once = 3;
/// Of the square of the error allowed: what may come of elements left alone, and of dropping
/// orders.
constexpr double share_left_alone = 0.25, share_after_dropping = 0.8;
/// Places of an element at which its estimate is checked, and by how much it may be off there.
constexpr int checks = 4;
constexpr double noticeably = 2;
/// New elements for one that is split, with what it takes to stay conforming.
constexpr double growth = 2.5;

struct Element {
  std::array<Vec3, 3> triangle;
  Vec3 normal;
  int surface = 0;
  double area = 0;
  double weight = 1;
  ElementFit fit;
  bool is_fitted = false, is_checked = false;
  bool is_broken = false;  ///< its samples overlook something

  double square_error() const { return area * weight * fit.error * fit.error; }
};

void check(const AdaptiveFieldOptions& options) {
  if (!(options.tolerance > 0 && std::isfinite(options.tolerance)) || options.order < -1 ||
      options.order > max_order || options.highest_order < 2 || options.highest_order > max_order ||
      !(options.norm >= 0) || options.max_elements < 1 || options.max_unknowns < 1)
    throw Error(
        ErrorCode::contract, "fit_adaptively",
        fmt::format("tolerance ({}), norm ({}), order ({}), highest_order ({}), max_elements ({}) "
                    "or max_unknowns ({}) is out of range",
                    options.tolerance, options.norm, options.order, options.highest_order,
                    options.max_elements, options.max_unknowns));
}

class Adaptation {
 public:
  Adaptation(PatchMesh& mesh, const FieldAt& field, const AdaptiveFieldOptions& options,
             const Progress& progress, std::span<const WatchedPlace> watched)
      : mesh_(mesh), field_(field), options_(options), progress_(progress), watched_(watched) {
    take_elements();
    double area = 0;
    for (const Element& element : elements_) area += element.area;
    for (Element& element : elements_) {
      const double share = element.area * static_cast<double>(elements_.size()) / area;
      element.fit.order =
          options.order >= 0 ? options.order : std::max(first_order(options) - modesty(share), 0);
      element.fit.coefficients = ChannelArray::Zero(basis_size(element.fit.order), 3);
    }
  }

  AdaptiveField run() {
    fit_new();
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
    if (options_.order < 0 && report_.limit == FieldLimit::none) drop_orders();
    return result();
  }

 private:
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
    for (const Element& element : elements_) {
      square_error_ += element.square_error();
      square_ += element.area * element.fit.coefficients.matrix().squaredNorm();
      unknowns_ += static_cast<std::size_t>(basis_size(element.fit.order));
    }
  }

  /// Reads the mesh; elements that are parts of others begin with what those knew.
  void take_elements() {
    table_ = mesh_.elements();
    const PatchHierarchy hierarchy = mesh_.hierarchy();
    std::vector<Element> before = std::move(elements_);
    const std::unordered_map<int, int> index_before = std::move(index_of_node_);
    elements_.assign(table_.corners.size(), {});
    index_of_node_.clear();
    for (int node = 0; node < static_cast<int>(hierarchy.element.size()); ++node) {
      const int e = hierarchy.element[at(node)];
      if (e < 0) continue;
      index_of_node_[node] = e;
      int known = node;
      while (known >= 0 && !index_before.contains(known)) known = hierarchy.parent[at(known)];
      Element& element = elements_[at(e)];
      element.triangle = table_.triangle(e);
      element.normal = table_.normal[at(e)];
      element.surface = table_.surface[at(e)];
      element.area = table_.area[at(e)];
      element.weight = mean_weight(options_.weight, element.surface, element.triangle);
      if (known < 0) continue;
      const Element& whole = before[at(index_before.at(known))];
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

  FieldPoint point_at(const Element& element, const TrianglePlace& place) const {
    return {{position(element.triangle, place), element.normal}, element.surface};
  }

  void fit_new() {
    std::vector<FieldPoint> points;
    for (const Element& element : elements_)
      if (!element.is_fitted)
        for (const TrianglePlace& place : sampling_rule(element.fit.order).places)
          points.push_back(point_at(element, place));
    const std::vector<Rgb> values = sample(points);
    if (values.empty()) return;
    ++report_.rounds;
    std::size_t next = 0;
    for (Element& element : elements_) {
      if (element.is_fitted) continue;
      ChannelArray samples(sampling_rule(element.fit.order).weights.size(), 3);
      for (Eigen::Index k = 0; k < samples.rows(); ++k) samples.row(k) = values[next++];
      element.fit = fit_element(element.fit.order, samples);
      element.is_fitted = true;
      element.is_checked = false;
    }
  }

  static Rgb fitted_at(const Element& element, const TrianglePlace& place) {
    Eigen::VectorXd phi(element.fit.coefficients.rows());
    basis_at(element.fit.order, place, phi);
    return (element.fit.coefficients.matrix().transpose() * phi).array();
  }

  /// Looks at places that the fits do not know. True if the estimates stand.
  bool check_new() {
    std::vector<FieldPoint> points;
    std::vector<TrianglePlace> places;
    for (const Element& element : elements_)
      for (int k = 0; !element.is_checked && k < checks; ++k) {
        places.push_back(spread_place(next_check_++));
        points.push_back(point_at(element, places.back()));
      }
    const std::vector<Rgb> values = sample(points);
    if (values.empty() && !points.empty()) return false;
    const double before = square_error_;
    std::size_t next = 0;
    for (Element& element : elements_) {
      if (element.is_checked) continue;
      double square = 0;
      for (int k = 0; k < checks; ++k, ++next)
        square += (values[next] - fitted_at(element, places[next])).square().sum() / checks;
      element.is_checked = true;
      if (square > noticeably * noticeably * element.fit.error * element.fit.error)
        element.fit.error = std::sqrt(square);
    }
    if (!check_watched()) return false;
    sum_up();
    return square_error_ <= std::max(before, allowed());
  }

  /// The same at the places that are watched. False if it was stopped.
  bool check_watched() {
    if (watched_values_.empty() && !watched_.empty()) {
      std::vector<FieldPoint> points;
      for (const WatchedPlace& watched : watched_) points.push_back(watched.place);
      watched_values_ = sample(points);
      if (watched_values_.empty()) return false;
    }
    if (watched_.empty()) return true;
    const auto fitted = [this](int e, const TrianglePlace& place) {
      return fitted_at(elements_[at(e)], place);
    };
    for (const auto& [e, found] : watched_errors(table_, watched_, watched_values_, fitted)) {
      ElementFit& fit = elements_[at(e)].fit;
      const double error = std::sqrt(found.square);
      // One place may be off by chance.
      if (error <= (found.places > 1 ? 1 : noticeably) * fit.error) continue;
      fit.error = error;
      elements_[at(e)].is_broken = true;
    }
    return true;
  }

  /// The elements that matter most, the worst first.
  std::vector<int> worst_elements() const {
    std::vector<int> order(elements_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return elements_[at(a)].square_error() > elements_[at(b)].square_error();
    });
    double left = square_error_;
    std::size_t count = 0;
    while (count < order.size() && left > share_left_alone * allowed())
      left -= elements_[at(order[count++])].square_error();
    order.resize(count);
    return order;
  }

  /// The order that an element should have; its own if it should be split.
  int better_order(const Element& element) const {
    const double shrinks = decay(element.fit);
    if (options_.order >= 0 || element.fit.order >= options_.highest_order || element.is_broken)
      return element.fit.order;
    if (element.fit.order < first_order(options_)) return first_order(options_);
    // Without coefficients there is nothing that shrinks: something was overlooked.
    if (shrinks > smooth || shrinks == 0) return element.fit.order;
    const double target =
        std::sqrt(share_left_alone * allowed() / static_cast<double>(elements_.size()));
    const double missing =
        std::log(std::sqrt(element.square_error()) / target) / -std::log(shrinks);
    const double more = std::clamp(std::ceil(missing), 1., most_orders_at_once);
    return std::min(element.fit.order + static_cast<int>(more), options_.highest_order);
  }

  /// False, with a limit set, if nothing can be done.
  bool improve() {
    if (options_.max_samples > 0 && static_cast<double>(report_.samples) > options_.max_samples) {
      report_.limit = FieldLimit::samples;
      return false;
    }
    if (options_.is_too_much && options_.is_too_much()) {
      report_.limit = FieldLimit::work;
      return false;
    }
    if (report_.rounds >= most_rounds) {
      report_.limit = FieldLimit::rounds;
      return false;
    }
    std::vector<int> to_split;
    auto unknowns = static_cast<double>(unknowns_);
    auto count = static_cast<double>(elements_.size());
    bool is_changed = false;
    FieldLimit limit = FieldLimit::fixed;
    for (const int e : worst_elements()) {
      Element& element = elements_[at(e)];
      const int order = better_order(element), size = basis_size(element.fit.order);
      const bool split = order == element.fit.order;
      if (split && !options_.split) continue;
      const double more = split ? (growth - 1) * size : basis_size(order) - size;
      if (unknowns + more > options_.max_unknowns) {
        limit = FieldLimit::unknowns;
        break;
      }
      if (split && count + growth - 1 > options_.max_elements) {
        limit = FieldLimit::elements;
        continue;
      }
      unknowns += more;
      is_changed = true;
      if (split) {
        count += growth - 1;
        to_split.push_back(e);
      } else {
        element.fit.order = order;
        element.fit.coefficients.conservativeResizeLike(ChannelArray::Zero(basis_size(order), 3));
        element.is_fitted = false;
      }
    }
    if (!is_changed) {
      report_.limit = limit;
      return false;
    }
    if (!to_split.empty()) {
      mesh_.bisect(to_split);
      take_elements();
    }
    progress_(fmt::format("refinement, round {}: {} elements, {} unknowns, error {:.2g}",
                          report_.rounds + 1, elements_.size(), static_cast<long>(unknowns),
                          std::sqrt(square_error_ / square_)),
              0);
    return true;
  }

  /// Top degrees go where the error allows it, those first that matter least for an unknown.
  void drop_orders() {
    using Candidate = std::pair<double, int>;  // square of the layer for an unknown, element
    const auto candidate = [&](int e) {
      const Element& element = elements_[at(e)];
      const double layer = element.fit.layer[at(element.fit.order)];
      return Candidate(element.area * element.weight * layer * layer / (element.fit.order + 1), e);
    };
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
    for (int e = 0; e < static_cast<int>(elements_.size()); ++e)
      if (elements_[at(e)].fit.order > 0) queue.push(candidate(e));
    while (!queue.empty()) {
      const auto [gain, e] = queue.top();
      queue.pop();
      Element& element = elements_[at(e)];
      const double more = gain * (element.fit.order + 1);
      if (square_error_ + more > share_after_dropping * allowed()) break;
      square_error_ += more;
      lower_order(element.fit);
      if (element.fit.order > 0) queue.push(candidate(e));
    }
  }

  AdaptiveField result() {
    sum_up();
    AdaptiveField out;
    std::vector<int> order;
    for (const Element& element : elements_) order.push_back(element.fit.order);
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
  std::span<const WatchedPlace> watched_;
  std::vector<Rgb> watched_values_;
  ElementTable table_;
  std::vector<Element> elements_;
  std::unordered_map<int, int> index_of_node_;
  std::optional<Rgb> scale_;  ///< of all values, by channel; once they are known
  double square_error_ = 0, square_ = 0;
  std::size_t unknowns_ = 0, next_check_ = 0;
  AdaptiveFieldReport report_;
};

}  // namespace

AdaptiveField fit_adaptively(PatchMesh& mesh, const FieldAt& field,
                             const AdaptiveFieldOptions& options, const Progress& progress,
                             std::span<const WatchedPlace> watched) {
  check(options);
  return Adaptation(mesh, field, options, progress, watched).run();
}

}  // namespace halfshade
