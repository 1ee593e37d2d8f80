#include "solver/adapt/element_choices.h"

#include "solver/adapt/comparable.h"
#include "solver/adapt/field_beginnings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

constexpr double most_orders_at_once = 3;
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

bool is_to_split(const FittedElement& element, const AdaptiveFieldOptions& options) {
  if (options.order >= 0 || element.fit.order >= options.highest_order || element.is_broken)
    return true;
  if (element.fit.order < first_order(options)) return false;
  // Without coefficients there is nothing that shrinks: something was overlooked.
  const double shrinks = decay(element.fit);
  return shrinks > smooth || shrinks == 0;
}

int better_order(const FittedElement& element, const AdaptiveFieldOptions& options, double target) {
  if (is_to_split(element, options)) return element.fit.order;
  if (element.fit.order < first_order(options)) return first_order(options);
  const double missing = std::log(std::sqrt(element.square_error()) / std::sqrt(target)) /
                         -std::log(decay(element.fit));
  const double more = std::clamp(std::ceil(missing), 1., most_orders_at_once);
  return std::min(element.fit.order + static_cast<int>(more), options.highest_order);
}

}  // namespace halfshade
