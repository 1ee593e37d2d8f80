#include "io/read/face_cut.h"

#include "meshing/core/rounded.h"

#include <array>
#include <cmath>
#include <utility>

namespace halfshade::reading {
namespace {

/// Of a block's squared deviation, what a cut must take away to be preferred to one along the
/// sharpest edge: where a chequerboard is cut once, both parts still have the same mean. Between 0
/// and 0.1 it matters little for other pictures.
constexpr double worth_cutting = 0.02;

/// One axis of a block: sums between neighbouring lines, and squares of jumps across lines.
struct Profile {
  std::vector<PictureSum> between;
  std::vector<double> jump;  ///< [k]: across the line before [k]
};

void add_cell(const PictureGrid& grid, const GridBlock& block, int column, int row,
              std::array<Profile, 2>& profiles) {
  const std::size_t cell = grid.cell(column, row);
  if (!(grid.area[cell] > 0)) return;
  const std::array<int, 2> from = {column - block.low[0], row - block.low[1]};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    profiles[axis].between[at(from[axis])].add(grid.area[cell], grid.value[cell]);
    if (from[axis] == 0) continue;
    const std::size_t before = axis == 0 ? grid.cell(column - 1, row) : grid.cell(column, row - 1);
    profiles[axis].jump[at(from[axis])] += std::min(grid.area[cell], grid.area[before]) *
                                           (grid.value[cell] - grid.value[before]).square().sum();
  }
}

void choose_cut(const std::array<Profile, 2>& profiles, PicturePiece& piece) {
  // Gain, or jump, then how near to the middle.
  using Rank = std::pair<double, double>;
  Rank most = {0, 0}, steepest = {0, -HUGE_VAL};
  std::pair<std::size_t, int> best = {0, -1}, edge = {0, -1};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto count = static_cast<int>(profiles[axis].between.size());
    PictureSum below;
    for (int k = 1; k < count; ++k) {
      below += profiles[axis].between[at(k - 1)];
      const PictureSum above{piece.sum.area - below.area, piece.sum.value - below.value, 0};
      constexpr double none = 1e-12;
      if (std::min(below.area, above.area) <= none * piece.sum.area) continue;
      const double off_middle = std::abs(2. * k / count - 1);
      const double gain = below.explained() + above.explained() - piece.sum.explained();
      if (const Rank rank = {rounded(std::max(gain, 0.)), -off_middle}; rank > most)
        most = rank, best = {axis, k};
      const Rank rank = {rounded(profiles[axis].jump[at(k)]), -off_middle};
      if (rank.first > 0 && rank > steepest) steepest = rank, edge = {axis, k};
    }
  }
  const double least = worth_cutting * piece.sum.deviation();
  const bool by_gain = edge.second < 0 || most.first >= least;
  const auto& cut = by_gain ? best : edge;
  if (cut.second < 0) return;
  piece.axis = cut.first;
  piece.line = piece.block.low[cut.first] + cut.second;
  piece.gain = std::max(most.first, least);
}

PicturePiece make_piece(const PictureGrid& grid, const GridBlock& block) {
  PicturePiece piece;
  piece.block = block;
  std::array<Profile, 2> profiles;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto count = at(block.end[axis] - block.low[axis]);
    profiles[axis] = {std::vector<PictureSum>(count), std::vector<double>(count, 0.)};
  }
  for (int row = block.low[1]; row < block.end[1]; ++row)
    for (int column = block.low[0]; column < block.end[0]; ++column)
      add_cell(grid, block, column, row, profiles);
  for (const PictureSum& column : profiles[0].between) piece.sum += column;
  choose_cut(profiles, piece);
  return piece;
}

}  // namespace

FaceCut::FaceCut(const PictureGrid& grid)
    : grid_(grid), pieces_({make_piece(grid, grid.whole())}) {}

PictureSum FaceCut::sum() const {
  PictureSum all;
  for (const PicturePiece& piece : pieces_) all += piece.sum;
  return all;
}

double FaceCut::deviation() const {
  double left = 0;
  for (const PicturePiece& piece : pieces_) left += piece.sum.deviation();
  return left;
}

void FaceCut::cut_evenly() {
  const double enough = even_enough * even_enough * sum().explained();
  while (pieces_.size() < few_pieces && deviation() > enough) {
    // The first of equal ones, however they are rounded.
    const auto best = std::max_element(pieces_.begin(), pieces_.end(),
                                       [](const PicturePiece& a, const PicturePiece& b) {
                                         return rounded(a.gain) < rounded(b.gain);
                                       });
    if (best->line < 0) return;
    cut(best);
  }
}

bool FaceCut::cut_further(std::size_t count) {
  const std::size_t before = pieces_.size();
  while (pieces_.size() < count) {
    const auto felt = [](const PicturePiece& p) { return rounded(p.gain * p.sum.area); };
    const auto best = std::max_element(
        pieces_.begin(), pieces_.end(),
        [&](const PicturePiece& a, const PicturePiece& b) { return felt(a) < felt(b); });
    if (best->line < 0) break;
    cut(best);
  }
  return pieces_.size() > before;
}

void FaceCut::cut(std::vector<PicturePiece>::iterator piece) {
  GridBlock lower = piece->block, upper = piece->block;
  lower.end[piece->axis] = upper.low[piece->axis] = piece->line;
  *piece = make_piece(grid_, lower);
  pieces_.push_back(make_piece(grid_, upper));
}

}  // namespace halfshade::reading
