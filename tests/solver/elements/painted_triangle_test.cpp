#include "solver/elements/painted_triangle.h"

#include "solver/elements/quadrature.h"
#include "tests/support/painted.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const std::array<Vec3, 3> triangle = {Vec3(0.1, 0, 0), Vec3(1.7, 0.2, 0), Vec3(0.4, 1.1, 0)};
const Rgb red(0.8, 0.2, 0.1), blue(0.1, 0.3, 0.7);

/// The share of the triangle left of x, from the areas of triangles.
double share_left_of(double x) {
  const auto [a, c, b] = triangle;  // by x: a, b, c
  const auto cut = [x](const Vec3& p, const Vec3& q) { return (x - p.x()) / (q.x() - p.x()); };
  return x <= b.x() ? cut(a, b) * cut(a, c) : 1 - (1 - cut(b, c)) * (1 - cut(a, c));
}

TEST(PaintedTriangle, OneColourIsAReflectance) {
  const Paint paint = test::across_x(test::two_coloured(red, red, 2), 2);
  for (int order = 0; order <= 3; ++order) {
    const PaintedProduct product = painted_product(paint, {0.5, 1, 0}, triangle, order);
    const Eigen::Index n = basis_size(order);
    for (int c = 0; c < 3; ++c) {
      const double expected = (Rgb(0.5, 1, 0) * red)[c];
      EXPECT_LT((product[at(c)] - expected * Eigen::MatrixXd::Identity(n, n)).norm(), 1e-6);
    }
  }
}

TEST(PaintedTriangle, MeansAreThoseOfAreas) {
  for (const double middle : {0.2, 0.5, 0.8, 1.2}) {
    Paint paint = test::across_x(test::two_coloured(red, blue), 8);
    paint.from.x() = 0.5 - middle / 8;
    const double left = share_left_of(middle);
    const Rgb expected = left * red + (1 - left) * blue;
    EXPECT_LT((mean_colour(paint, triangle) - expected).abs().maxCoeff(), 4e-3) << middle;
    EXPECT_NEAR(painted_product(paint, Rgb::Ones(), triangle, 2)[0](0, 0), expected[0], 4e-3);
  }
}

TEST(PaintedTriangle, ProjectsProductsWithPolynomials) {
  // ρ runs from red to blue along x, so that ρ f of a linear f is a polynomial of order 2.
  const Paint paint = test::across_x(test::two_coloured(red, blue, 2), 4);
  std::array<Vec3, 3> small = triangle;  // from the middle of the first texel to that of the second
  for (Vec3& p : small) p.x() = 1.1 + 0.5 * p.x();
  const auto rho = [&](const Vec3& p) { return Rgb(red + (p.x() - 1) / 2 * (blue - red)); };
  const PaintedProduct product = painted_product(paint, Rgb::Ones(), small, 2);
  Eigen::VectorXd linear = Eigen::VectorXd::Zero(6);
  linear.head(3) << 1, 0.3, -0.2;
  Eigen::VectorXd phi(6);
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd projected = product[at(c)] * linear;
    for (const TrianglePlace& place : {TrianglePlace(0.2, 0.3), TrianglePlace(0.6, 0.1)}) {
      basis_at(2, place, phi);
      EXPECT_NEAR(phi.dot(projected), rho(position(small, place))[c] * phi.dot(linear), 3e-3);
    }
  }
}

TEST(PaintedTriangle, LargePicturesTakeSmallerCopies) {
  std::vector<Eigen::Array3f> texels;
  for (int y = 0; y < 1000; ++y)
    for (int x = 0; x < 1000; ++x)
      texels.push_back(Eigen::Array3f::Constant((x + y) % 2 == 0 ? 0.9F : 0.1F));
  Paint paint = test::across_x(
      std::make_shared<const Texture>(make_texture("board", 1000, 1000, std::move(texels))), 2);
  paint.along(1, 1) = 1;
  EXPECT_LT((mean_colour(paint, triangle) - 0.5).abs().maxCoeff(), 1e-3);
}

}  // namespace
}  // namespace halfshade
