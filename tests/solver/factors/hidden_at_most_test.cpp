#include "solver/factors/blocked_cell.h"

#include <gtest/gtest.h>

#include <utility>

namespace halfshade {
namespace {

Blocker blocker_of(Polygon3 corners) {
  Blocker blocker;
  blocker.corners = std::move(corners);
  return blocker;
}

/// A wall that stands on the edge of a cell and leans over it hides something of what is behind it,
/// and nothing of what is before it.
TEST(HiddenFromAbove, OnlyWhatTheWallIsBefore) {
  const Triangle3 cell = {Vec3(0, 0, 0), Vec3(.1, 0, 0), Vec3(0, .1, 0)};
  const Blocker wall = blocker_of({{0, -5, 0}, {0, 5, 0}, {1, 5, 5}, {1, -5, 5}});
  const auto hidden_of = [&](const Polygon3& target) {
    return hidden_from_above(make_shaft(cell, target, 0), cell, {0, 0, 1}, wall);
  };
  EXPECT_GT(hidden_of({{-2, 0, 1}, {-1, 0, 1}, {-1, 1, 1}, {-2, 1, 1}}), 1e-4);
  EXPECT_LT(hidden_of({{1, 0, 1}, {2, 0, 1}, {2, 1, 1}, {1, 1, 1}}), 1e-12);
}

}  // namespace
}  // namespace halfshade
