#pragma once

#include "meshing/patches/patch_mesh.h"
#include "meshing/repair/repair.h"
#include "solver/exchange/exchange.h"
#include "tests/support/analytic.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

/// Matrices of exchange to solve radiosity with.
namespace halfshade::test {

/// A patch of a wall of the unit cube: the wall's axis and side, and where it lies in the others.
struct CubePatch {
  int axis = 0, side = 0;
  std::array<std::array<double, 2>, 3> range;  ///< along all axes; of its own, both the same
};

inline double exchanged_area(const CubePatch& a, const CubePatch& b, double area) {
  if (a.axis == b.axis) {
    if (a.side == b.side) return 0;
    const std::size_t u = at((a.axis + 1) % 3), v = at((a.axis + 2) % 3);
    return area * offset_parallel_rectangles(a.range[u], a.range[v], b.range[u], b.range[v], 1);
  }
  // Distances from the line where the walls meet, and ranges along it.
  const auto from_wall = [](const CubePatch& patch, const CubePatch& wall) {
    const auto& r = patch.range[at(wall.axis)];
    return wall.side == 0 ? r : std::array<double, 2>{1 - r[1], 1 - r[0]};
  };
  const std::size_t along = at(3 - a.axis - b.axis);
  return area * offset_perpendicular_rectangles(from_wall(a, b), a.range[along], b.range[along],
                                                from_wall(b, a));
}

/// The unit cube, each wall of n² patches, with exact factors.
inline Exchange cube(int n) {
  std::vector<CubePatch> patches;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n * n; ++i) {
        CubePatch patch{axis, side, {}};
        const double u = i / n, v = i % n;
        patch.range[at(axis)] = {static_cast<double>(side), static_cast<double>(side)};
        patch.range[at((axis + 1) % 3)] = {u / n, (u + 1) / n};
        patch.range[at((axis + 2) % 3)] = {v / n, (v + 1) / n};
        patches.push_back(patch);
      }
  const auto count = static_cast<Eigen::Index>(patches.size());
  Eigen::MatrixXd matrix(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j)
      matrix(i, j) = exchanged_area(patches[static_cast<std::size_t>(i)],
                                    patches[static_cast<std::size_t>(j)], 1. / (n * n));
  Exchange exchange;
  // Closed forms are off by 1e-12 or so.
  exchange.matrix = Eigen::MatrixXd(0.5 * (matrix + matrix.transpose())).sparseView();
  exchange.area = Eigen::ArrayXd::Constant(count, 1. / (n * n));
  EXPECT_LT((matrix.rowwise().sum().array() / exchange.area - 1).abs().maxCoeff(), 1e-9);
  EXPECT_TRUE(
      enforce_closure(exchange.matrix, exchange.area, std::vector<bool>(patches.size(), true)));
  exchange.lost = Eigen::ArrayXd::Zero(count);
  exchange.enclosures = {std::vector<int>(patches.size(), 0), {true}, {true}};
  return exchange;
}

/// Two unit squares that face each other, each of n² patches.
inline Exchange close_plates(double gap, int n) {
  const Eigen::Index half = n * n;
  Eigen::MatrixXd facing(half, half);
  const auto range = [n](Eigen::Index k) {
    return std::array{static_cast<double>(k) / n, static_cast<double>(k + 1) / n};
  };
  for (Eigen::Index i = 0; i < half; ++i)
    for (Eigen::Index j = 0; j < half; ++j)
      facing(i, j) =
          offset_parallel_rectangles(range(i / n), range(i % n), range(j / n), range(j % n), gap) /
          (n * n);
  Exchange exchange;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 * half, 2 * half);
  matrix.topRightCorner(half, half) = 0.5 * (facing + facing.transpose());
  matrix.bottomLeftCorner(half, half) = matrix.topRightCorner(half, half).transpose();
  exchange.matrix = matrix.sparseView();
  exchange.area = Eigen::ArrayXd::Constant(2 * half, 1. / (n * n));
  exchange.lost = exchange.area - matrix.rowwise().sum().array();
  exchange.enclosures = {std::vector<int>(static_cast<std::size_t>(2 * half), 0), {false}, {true}};
  return exchange;
}

/// An L-shaped room with a box in it, factors by closed forms and rays.
inline Exchange room_with_corner() {
  const SoundScene scene = make_sound(l_room(true));
  PlanarMeshOptions options;
  options.max_length = 0.5;
  return compute_exchange(scene, PatchMesh(scene, options).elements(),
                          VisibilityIndex(occluders(scene)));
}

/// The cube with an opening: its last patches are gone.
inline Exchange opened(const Exchange& whole, Eigen::Index gone) {
  const Eigen::Index count = whole.area.size() - gone;
  Exchange open = whole;
  open.matrix = whole.matrix.topLeftCorner(count, count);
  open.area = whole.area.head(count).eval();
  const Eigen::VectorXd left = open.matrix * Eigen::VectorXd::Ones(count);
  open.lost = open.area - left.array();
  open.enclosures = {std::vector<int>(at(static_cast<int>(count)), 0), {false}, {true}};
  return open;
}

}  // namespace halfshade::test
