#include "solver/elements/vertex_interpolation.h"

#include "solver/elements/vertex_values.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

/// The unit square in a grid of n² cells, each cut in two the same way.
ElementTable grid(int n) {
  ElementTable e;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) e.points.emplace_back(1. * i / n, 1. * j / n, 0);
  const auto triangle = [n](int i, int j, bool upper) { return 2 * (j * n + i) + (upper ? 1 : 0); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int p = j * (n + 1) + i;
      e.corners.push_back({p, p + 1, p + n + 2});
      e.corners.push_back({p, p + n + 2, p + n + 1});
      e.neighbours.push_back({j > 0 ? triangle(i, j - 1, true) : -1,
                              i + 1 < n ? triangle(i + 1, j, true) : -1, triangle(i, j, true)});
      e.neighbours.push_back({triangle(i, j, false), j + 1 < n ? triangle(i, j + 1, false) : -1,
                              i > 0 ? triangle(i - 1, j, false) : -1});
    }
  e.area.assign(e.corners.size(), 0.5 / (n * n));
  e.normal.assign(e.corners.size(), Vec3(0, 0, 1));
  return e;
}

Eigen::Array3d plane(const Vec3& p) { return {2 + p.x() - p.y(), 5 + 3 * p.x(), 1}; }

ChannelArray means_of_plane(const ElementTable& e) {
  ChannelArray values(e.count(), 3);
  for (int k = 0; k < e.count(); ++k) {
    const auto [a, b, c] = e.triangle(k);
    values.row(k) = plane((a + b + c) / 3).transpose();
  }
  return values;
}

TEST(VertexInterpolation, APlaneIsKeptUpToTheBorder) {
  const ElementTable e = grid(5);
  const ChannelArray at_points = interpolated_at_points(e, means_of_plane(e));
  for (std::size_t p = 0; p < e.points.size(); ++p)
    EXPECT_TRUE(
        at_points.row(static_cast<Eigen::Index>(p)).transpose().isApprox(plane(e.points[p]), 1e-12))
        << e.points[p].transpose();
  const ElementField field = interpolated_field(e, means_of_plane(e));
  for (int k = 0; k < e.count(); ++k)
    EXPECT_TRUE(
        value_at(field, k, {0.2, 0.5}).isApprox(plane(position(e.triangle(k), {0.2, 0.5})), 1e-12));
}

TEST(VertexInterpolation, InsideItIsTheMeanOfTheElementsAround) {
  const ElementTable e = grid(4);
  ChannelArray values(e.count(), 3);
  for (int k = 0; k < e.count(); ++k) values.row(k).setConstant((k * 7) % 11);
  const ChannelArray at_points = interpolated_at_points(e, values);
  const ChannelArray means = values_at_points(e, values);
  for (const int p : {6, 7, 8, 11, 12, 13, 16, 17, 18})
    EXPECT_TRUE(at_points.row(p).isApprox(means.row(p)));
}

TEST(VertexInterpolation, LightStaysPositiveAndLonelyElementsConstant) {
  const ElementTable e = grid(3);
  ChannelArray values = ChannelArray::Zero(e.count(), 3);
  values.row(8).setConstant(1);
  EXPECT_GE(interpolated_at_points(e, values).minCoeff(), 0);
  const ElementTable pair = grid(1);
  values = ChannelArray::Constant(2, 3, 4);
  EXPECT_TRUE(interpolated_at_points(pair, values).isApproxToConstant(4, 1e-12));
}

}  // namespace
}  // namespace halfshade
