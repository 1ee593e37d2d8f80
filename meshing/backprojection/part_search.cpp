#include "meshing/backprojection/part_search.h"

#include "meshing/backprojection/margins.h"

#include <algorithm>

namespace halfshade {
namespace {

// Any fixed numbers.
constexpr std::uint64_t lit_signature = 0x9d5c31a4e8f07b63;
constexpr std::uint64_t umbra_signature = 0x3fb86a2c90d7154e;
constexpr std::uint64_t away_signature = 0x71e40b9d256c8fa3;

}  // namespace

void clear(VisiblePart& part) {
  part.region = Region::away;
  part.signature = away_signature;
  part.pieces.clear();
  part.chain_ends.clear();
  part.unobstructed.clear();
}

double next_jitter(double jitter) {
  return std::max(margins::jitter_growth * jitter, margins::least_jitter);
}

PartSearch::End PartSearch::arrange(bool unless_crowded) {
  if (!arrangement.build(view, outline, unless_crowded)) return End::crowded;
  chains.link(arrangement, view);
  return arrangement.is_consistent && chains.closed ? End::found : End::contradictory;
}

void PartSearch::fill_unobstructed(VisiblePart& part) const {
  for (const OutlineEdge& edge : outline.edges)
    part.unobstructed.push_back({view.corners[at(edge.from)].true_position,
                                 view.corners[at(edge.to)].true_position, edge.edge});
}

void PartSearch::write(VisiblePart& part) {
  if (!arrangement.fully_lit && chains.pieces.empty()) return write_hidden(part);
  fill_unobstructed(part);
  if (arrangement.fully_lit || chains.fill(outline, view)) {
    part.region = Region::lit;
    part.signature = lit_signature;
    part.pieces = part.unobstructed;
    outline.copy_ends(part.chain_ends);
  } else {
    part.region = Region::penumbra;
    part.signature = chains.signature;
    chains.copy(part);
  }
}

void PartSearch::write_hidden(VisiblePart& part) {
  fill_unobstructed(part);
  part.region = Region::umbra;
  part.signature = umbra_signature;
}

}  // namespace halfshade
