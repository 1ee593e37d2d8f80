#include "solver/adapt/unknown_trade.h"

#include "solver/adapt/comparable.h"
#include "solver/adapt/element_choices.h"

#include <algorithm>

namespace halfshade {
namespace {

/// New orders of an element are tried up to so many more.
constexpr int most_new_orders = 2;
/// Of the square error, what a split leaves: of breaks; of smooth functions less.
constexpr double left_by_split = 0.4;
/// Unknowns are spread better if that is likely to leave no more than this share of them.
constexpr double worth_it = 0.95;

/// What an element can be.
struct Choice {
  int order;
  bool is_split;
  int unknowns;
  double square_error;
};

/// From an element's choice to the next one that is worth it, with fewer unknowns.
struct Step {
  double key;  ///< square error for an unknown, as a share
  int element;
  Choice from, to;
};

/// By unknowns, the fewest first.
std::vector<Choice> choices_of(const FittedElement& element, const AdaptiveFieldOptions& options,
                               bool may_improve) {
  const double of_square = element.area * element.weight;
  const int own = element.fit.order;
  std::vector<Choice> choices;
  double square = element.square_error();
  for (int p = own; p >= 0; --p) {
    choices.push_back({p, false, basis_size(p), square});
    square += of_square * element.fit.layer[at(p)] * element.fit.layer[at(p)];
  }
  std::reverse(choices.begin(), choices.end());
  if (!may_improve || !(element.square_error() > 0)) return choices;
  if (is_to_split(element, options)) {
    if (options.split)
      choices.push_back({own, true, static_cast<int>(elements_for_one * basis_size(own)),
                         left_by_split * element.square_error()});
    return choices;
  }
  // Low orders do not tell.
  const double shrinks = std::min(decay(element.fit), smooth);
  double left = element.square_error();
  for (int p = own + 1; p <= std::min(own + most_new_orders, options.highest_order); ++p) {
    left *= shrinks * shrinks;
    choices.push_back({p, false, basis_size(p), left});
  }
  return choices;
}

/// Leaves those that save the most for an unknown, from fewer unknowns to more.
std::vector<Choice> worthwhile(const std::vector<Choice>& choices) {
  std::vector<Choice> hull = {choices.front()};
  for (std::size_t k = 0; k + 1 < choices.size();) {
    std::size_t next = k;
    double most = 0;
    for (std::size_t j = k + 1; j < choices.size(); ++j) {
      const double saved = (choices[k].square_error - choices[j].square_error) /
                           (choices[j].unknowns - choices[k].unknowns);
      if (saved > most) most = saved, next = j;
    }
    if (next == k) break;
    k = next;
    hull.push_back(choices[k]);
  }
  return hull;
}

/// What elements come to, and how many unknowns that takes.
struct Trade {
  std::vector<Choice> chosen;
  double unknowns = 0;
};

/// The fewest unknowns for that square error: every one that is there, and none that is not, saves
/// more of it than a price. Where it is more whatever is chosen, the best is.
Trade trade_unknowns(std::span<const FittedElement> elements, const AdaptiveFieldOptions& options,
                     double most, bool may_improve) {
  Trade trade;
  std::vector<Step> steps;
  double square_error = 0;
  for (int e = 0; e < static_cast<int>(elements.size()); ++e) {
    const std::vector<Choice> hull = worthwhile(choices_of(elements[at(e)], options, may_improve));
    for (std::size_t k = hull.size() - 1; k > 0; --k) {
      const double more = hull[k - 1].square_error - hull[k].square_error;
      const int fewer = hull[k].unknowns - hull[k - 1].unknowns;
      steps.push_back({comparable(more / fewer, most), e, hull[k], hull[k - 1]});
    }
    trade.chosen.push_back(hull.back());
    square_error += hull.back().square_error;
    trade.unknowns += hull.back().unknowns;
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const Step& a, const Step& b) { return a.key < b.key; });
  for (const Step& step : steps) {
    square_error += step.to.square_error - step.from.square_error;
    if (square_error > most) break;
    trade.chosen[at(step.element)] = step.to;
    trade.unknowns -= step.from.unknowns - step.to.unknowns;
  }
  return trade;
}

}  // namespace

std::vector<std::pair<int, int>> better_spread(std::span<const FittedElement> elements,
                                               const AdaptiveFieldOptions& options, double most) {
  const Trade trade = trade_unknowns(elements, options, most, true);
  if (trade.unknowns > worth_it * trade_unknowns(elements, options, most, false).unknowns)
    return {};
  std::vector<std::pair<int, int>> better;
  for (int e = 0; e < static_cast<int>(elements.size()); ++e)
    if (const Choice& to = trade.chosen[at(e)]; to.is_split || to.order > elements[at(e)].fit.order)
      better.emplace_back(e, to.order);
  return better;
}

void drop_orders(std::span<FittedElement> elements, const AdaptiveFieldOptions& options,
                 double most) {
  const Trade trade = trade_unknowns(elements, options, most, false);
  for (std::size_t e = 0; e < elements.size(); ++e)
    while (elements[e].fit.order > trade.chosen[e].order) lower_order(elements[e].fit);
}

}  // namespace halfshade
