#pragma once

#include "meshing/discontinuity/discontinuity.h"

#include <cstddef>
#include <vector>

namespace halfshade {

/// Merges the curves of each receiver and emitter that run on top of each other, whatever their
/// direction: they are cut at each other's ends, and of every stretch that several cover one is
/// left, with the sources and triples of all, each once, and the lowest order. Neighbouring
/// stretches that turn out alike are joined again.
///
/// Straight curves run on top of each other if they overlap and are within `tolerance` (a length)
/// of one line; end points move by no more than about that, and go to end points of others. Conic
/// arcs do so if over the stretch they share they are within `tolerance` of each other. Curves that
/// share nothing stay as they are, bit by bit; so do those shorter than a few tolerances.
///
/// The jumps of merged curves are 0: they have to be predicted again. Their sight plane is the one
/// that the curves of the lowest order have in common, or zero. A merged curve comes where the
/// first of the curves on it was. Returns how many curves lay on others before them.
/// O(n log n + size of the result) unless very many curves cross at one place; deterministic.
std::size_t merge_coincident(std::vector<DiscontinuityCurve>& curves, double tolerance);

}  // namespace halfshade
