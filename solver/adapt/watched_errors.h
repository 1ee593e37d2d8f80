#pragma once

#include "meshing/patches/element_table.h"
#include "solver/adapt/watched.h"
#include "solver/elements/polynomial.h"

#include <functional>
#include <span>
#include <unordered_map>

namespace halfshade {

/// What places that are watched tell of an element.
struct WatchedError {
  int places = 0;     ///< in it
  double square = 0;  ///< their part in its mean square error
};

/// Element → what its watched places tell, for those that have any. `values` are the field's there;
/// `fitted` is the polynomial of an element.
std::unordered_map<int, WatchedError> watched_errors(
    const ElementTable& elements, std::span<const WatchedPlace> watched,
    std::span<const Rgb> values,
    const std::function<Rgb(int element, const TrianglePlace& place)>& fitted);

}  // namespace halfshade
