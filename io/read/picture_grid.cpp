#include "io/read/picture_grid.h"

#include "meshing/core/plane_frame.h"

#include <algorithm>
#include <cmath>

namespace halfshade::reading {
namespace {

/// Along an axis, at most, and at least where the picture bends between texels.
struct CellCounts {
  int most, fewest;
};
constexpr CellCounts usual_counts = {128, 32}, fine_counts = {256, 128}, finest_counts = {512, 256},
                     stripe_counts = {128, 64};
constexpr int finest_part = 1024;   // of a texel: what lies within it is one colour
constexpr int most_samples = 64;    // of a cell, before a smaller copy of the picture is taken
constexpr int most_in_line = 1024;  // the same where the copy would be too coarse across
constexpr int few_texels = 8;       // in a cell: its ends matter
constexpr double off_line = 1e-5;   // of a picture: files round places to six digits
constexpr double far_away = 1e9;    // pictures away: doubles no longer know the texel

/// Whether the picture changes along u and v.
std::array<bool, 2> varies(const TextureLevel& level) {
  std::array<bool, 2> found = {false, false};
  const auto differ = [&](int a, int b) {
    return (level.texels[at(a)] != level.texels[at(b)]).any();
  };
  for (int row = 0; row < level.height; ++row)
    for (int column = 0; column < level.width; ++column) {
      const int here = row * level.width + column;
      found[0] = found[0] || (column > 0 && differ(here, here - 1));
      found[1] = found[1] || (row > 0 && differ(here, here - level.width));
    }
  return found;
}

/// Stripes need the fineness across them alone, and can have more there.
std::array<CellCounts, 2> counts_for(const Texture& texture, GridFineness fineness) {
  if (fineness == GridFineness::usual) return {usual_counts, usual_counts};
  const CellCounts counts = fineness == GridFineness::fine ? fine_counts : finest_counts;
  const std::array<bool, 2> found = varies(texture.levels.front());
  if (found[0] == found[1]) return {counts, counts};
  const CellCounts across{4 * counts.most, 4 * counts.fewest};
  return found[0] ? std::array{across, stripe_counts} : std::array{stripe_counts, across};
}

/// What a polygon covers along one axis of a picture.
struct Extent {
  double low, high;
};

std::array<Extent, 2> extents(const Paint& paint, std::span<const Vec3> polygon) {
  Vec2 low = paint.place(polygon[0]), high = low;
  for (const Vec3& corner : polygon) {
    low = low.cwiseMin(paint.place(corner));
    high = high.cwiseMax(paint.place(corner));
  }
  return {Extent{low.x(), high.x()}, Extent{low.y(), high.y()}};
}

/// Lines between the texels of one axis, and how many texels lie between two of them.
struct Fit {
  GridLines lines;
  double texels = 1;
};

Fit fit(const Extent& extent, int texels, const CellCounts& counts) {
  const auto [most_cells, fewest_cells] = counts;
  const double across = (extent.high - extent.low) * texels;
  const auto lines = [&, most = most_cells](double fineness) {
    const double off = std::min(off_line * fineness, 0.25);
    GridLines result{fineness, std::floor(extent.low * fineness + off), 1};
    const double end = std::ceil(extent.high * fineness - off);
    result.cells = static_cast<int>(std::clamp(end - result.first, 1., most + 1.));
    return result;
  };
  if (across < fewest_cells) {
    // Even: the picture bends in the middle of texels, too.
    double parts = std::clamp(std::ceil(fewest_cells / across), 1., double{finest_part});
    if (counts.fewest > usual_counts.fewest) parts = 2 * std::ceil(parts / 2);
    return {lines(across > 0 ? texels * parts : texels), 1};
  }
  for (double block = std::max(1., std::floor(across / most_cells));; ++block)
    if (const GridLines found = lines(texels / block); found.cells <= most_cells)
      return {found, block};
}

/// The mean of a cell's part that the polygon's extent has.
Rgb mean_in(const TextureLevel& level, const std::array<Extent, 2>& cell,
            const std::array<int, 2>& samples) {
  Rgb sum = Rgb::Zero();
  for (int y = 0; y < samples[1]; ++y)
    for (int x = 0; x < samples[0]; ++x) {
      const auto along = [&](int axis, int k) {
        const Extent& e = cell[at(axis)];
        return e.low + (e.high - e.low) * (k + 0.5) / samples[at(axis)];
      };
      sum += value_at(level, {along(0, x), along(1, y)});
    }
  return sum / (samples[0] * samples[1]);
}

void sample(const TextureLevel& level, const std::array<Extent, 2>& seen,
            const std::array<int, 2>& samples, PictureGrid& grid) {
  const auto cell = [&](int axis, int k) {
    const GridLines& lines = grid.lines[at(axis)];
    const Extent& e = seen[at(axis)];
    return Extent{std::clamp(lines.line(k), e.low, e.high),
                  std::clamp(lines.line(k + 1), e.low, e.high)};
  };
  for (int row = 0; row < grid.lines[1].cells; ++row)
    for (int column = 0; column < grid.lines[0].cells; ++column)
      grid.value.push_back(mean_in(level, {cell(0, column), cell(1, row)}, samples));
}

/// Areas of a polygon in the cells of a grid: blocks that it does not fill are halved.
class Areas {
 public:
  Areas(const Paint& paint, std::span<const Vec3> polygon, PictureGrid& grid)
      : paint_(paint), grid_(grid), normal_(area_vector(polygon).normalized()) {
    const Vec3 across = Vec3(paint.along.row(0)).cross(Vec3(paint.along.row(1)));
    cell_ = 1 / (std::abs(normal_.dot(across)) * grid.lines[0].fineness * grid.lines[1].fineness);
    grid.area.assign(grid.cell(0, grid.lines[1].cells), 0);
  }

  void share(const std::vector<Vec3>& polygon, const GridBlock& block) {
    if (polygon.empty()) return;
    const int width = block.end[0] - block.low[0], height = block.end[1] - block.low[1];
    const double cells = 1. * width * height;
    const double area = std::max(0., area_vector(polygon).dot(normal_));
    constexpr double full = 1 - 1e-9;
    if (cells == 1 || area >= full * cells * cell_) {
      for (int row = block.low[1]; row < block.end[1]; ++row)
        for (int column = block.low[0]; column < block.end[0]; ++column)
          grid_.area[grid_.cell(column, row)] = area / cells;
      return;
    }
    const std::size_t axis = width >= height ? 0 : 1;
    GridBlock lower = block, upper = block;
    lower.end[axis] = upper.low[axis] = (block.low[axis] + block.end[axis]) / 2;
    share(part_in(lower, grid_, paint_, polygon), lower);
    share(part_in(upper, grid_, paint_, polygon), upper);
  }

 private:
  const Paint& paint_;
  PictureGrid& grid_;
  Vec3 normal_;
  double cell_;  ///< its area; infinite where the polygon shows a line of the picture
};

/// The part before or behind a line. What it cuts off an edge does not depend on the side.
std::vector<Vec3> cut(const std::vector<Vec3>& polygon, const Paint& paint, int axis, double line,
                      bool behind) {
  const Vec3 along = paint.along.row(axis);
  if (along.isZero(0) || polygon.empty()) return polygon;
  const Vec3 normal = behind ? along : -along;
  const double from = line - paint.from[axis];
  return clip_to_front(polygon, along * (from / along.squaredNorm()), normal);
}

}  // namespace

PictureGrid make_picture_grid(const Paint& paint, std::span<const Vec3> polygon,
                              GridFineness fineness) {
  const bool is_fine = fineness != GridFineness::usual;
  const std::array<CellCounts, 2> counts = counts_for(*paint.texture, fineness);
  const std::vector<TextureLevel>& levels = paint.texture->levels;
  const std::array<Extent, 2> seen = extents(paint, polygon);
  PictureGrid grid;
  const auto is_near = [](const Extent& e) { return e.low > -far_away && e.high < far_away; };
  if (!is_near(seen[0]) || !is_near(seen[1])) {
    grid.area = {area_vector(polygon).norm()};
    grid.value = {value_at(levels.back(), Vec2::Zero())};
    return grid;
  }
  std::array<int, 2> samples = {1, 1};
  std::size_t level = 0;
  for (;; ++level) {
    const Fit u = fit(seen[0], levels[level].width, counts[0]),
              v = fit(seen[1], levels[level].height, counts[1]);
    grid.lines = {u.lines, v.lines};
    const bool is_line = std::min(u.texels, v.texels) < 2;
    const bool is_enough = u.texels * v.texels <= (is_line ? most_in_line : most_samples);
    if (is_enough) samples = {static_cast<int>(u.texels), static_cast<int>(v.texels)};
    // A cell that ends between texels has halves in which the picture does not bend.
    if (is_enough && is_fine)
      for (int& count : samples)
        if (count <= few_texels) count *= 2;
    if (is_enough || level + 1 == levels.size()) break;
  }
  sample(levels[level], seen, samples, grid);
  Areas(paint, polygon, grid).share({polygon.begin(), polygon.end()}, grid.whole());
  return grid;
}

std::vector<Vec3> part_in(const GridBlock& block, const PictureGrid& grid, const Paint& paint,
                          std::vector<Vec3> polygon) {
  for (int axis = 0; axis < 2; ++axis) {
    const GridLines& lines = grid.lines[at(axis)];
    const int low = block.low[at(axis)], end = block.end[at(axis)];
    if (low > 0) polygon = cut(polygon, paint, axis, lines.line(low), true);
    if (end < lines.cells) polygon = cut(polygon, paint, axis, lines.line(end), false);
  }
  return polygon;
}

}  // namespace halfshade::reading
