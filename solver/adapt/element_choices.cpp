#include "solver/adapt/element_choices.h"

#include "meshing/core/rounded.h"
#include "solver/adapt/field_beginnings.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>
#include <utility>

namespace halfshade {
namespace {

/// Coefficients that shrink faster from degree to degree are worth more of them: with this decay,
/// one more order and four smaller elements gain alike per unknown.
constexpr double smooth = 0.45;
constexpr double most_orders_at_once = 3;
/// Errors are small differences of large values: those of twins in a symmetric scene are alike to
/// so many digits.
constexpr int error_digits = 12;

/// A square as a share of another one, to compare it: rounding steps at the same shares in any unit
/// of length.
double comparable(double square, double of) {
  return rounded<error_digits>(of > 0 ? square / of : square);
}

double square_error_of(std::span<const FittedElement> elements) {
  double sum = 0;
  for (const FittedElement& element : elements) sum += element.square_error();
  return sum;
}

}  // namespace

std::vector<int> worst_elements(std::span<const FittedElement> elements, double may_stay) {
  std::vector<int> order(elements.size());
  std::iota(order.begin(), order.end(), 0);
  std::vector<double> key;
  for (const FittedElement& element : elements)
    key.push_back(comparable(element.square_error(), may_stay));
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return key[at(a)] > key[at(b)]; });
  double left = square_error_of(elements);
  std::size_t count = 0;
  while (count < order.size() && left > may_stay)
    left -= elements[at(order[count++])].square_error();
  order.resize(count);
  return order;
}

int better_order(const FittedElement& element, const AdaptiveFieldOptions& options, double target) {
  const double shrinks = decay(element.fit);
  if (options.order >= 0 || element.fit.order >= options.highest_order || element.is_broken)
    return element.fit.order;
  if (element.fit.order < first_order(options)) return first_order(options);
  // Without coefficients there is nothing that shrinks: something was overlooked.
  if (shrinks > smooth || shrinks == 0) return element.fit.order;
  const double missing =
      std::log(std::sqrt(element.square_error()) / std::sqrt(target)) / -std::log(shrinks);
  const double more = std::clamp(std::ceil(missing), 1., most_orders_at_once);
  return std::min(element.fit.order + static_cast<int>(more), options.highest_order);
}

void drop_orders(std::span<FittedElement> elements, double most) {
  using Candidate = std::pair<double, int>;  // square of the layer for an unknown, element
  const auto square_of_layer = [](const FittedElement& element) {
    const double layer = element.fit.layer[at(element.fit.order)];
    return element.area * element.weight * layer * layer;
  };
  const auto candidate = [&](int e) {
    const FittedElement& element = elements[at(e)];
    return Candidate(comparable(square_of_layer(element) / (element.fit.order + 1), most), e);
  };
  std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> queue;
  for (int e = 0; e < static_cast<int>(elements.size()); ++e)
    if (elements[at(e)].fit.order > 0) queue.push(candidate(e));
  double square_error = square_error_of(elements);
  while (!queue.empty()) {
    const int e = queue.top().second;
    queue.pop();
    FittedElement& element = elements[at(e)];
    square_error += square_of_layer(element);
    if (square_error > most) break;
    lower_order(element.fit);
    if (element.fit.order > 0) queue.push(candidate(e));
  }
}

}  // namespace halfshade
