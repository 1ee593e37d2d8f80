#include "solver/elements/painted_triangle.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Parts along an edge: for each texel that it crosses, and at least and at most.
constexpr double parts_of_texel = 1.5;
constexpr int fewest_parts = 6, most_parts = 96;

/// Calls `look(place, colour)` for the middles of equal parts of a triangle; returns their number.
template <class Look>
int sample(const Paint& paint, const std::array<Vec3, 3>& triangle, const Look& look) {
  const std::array<Vec2, 3> corner = {paint.place(triangle[0]), paint.place(triangle[1]),
                                      paint.place(triangle[2])};
  const auto texels = [&](const TextureLevel& level) {
    const Vec2 size(level.width, level.height);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (corner[(k + 1) % 3] - corner[k]).cwiseProduct(size).norm());
    return longest;
  };
  auto level = paint.texture->levels.begin();
  while (parts_of_texel * texels(*level) > most_parts && level + 1 != paint.texture->levels.end())
    ++level;
  const int n = static_cast<int>(std::clamp(std::ceil(parts_of_texel * texels(*level)),
                                            double{fewest_parts}, double{most_parts}));
  const auto part = [&](double i, double j) {
    const TrianglePlace place(i / n, j / n);
    const Vec2 there =
        corner[0] + place.x() * (corner[1] - corner[0]) + place.y() * (corner[2] - corner[0]);
    look(place, value_at(*level, there));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; i + j < n; ++j) {
      part(i + 1. / 3, j + 1. / 3);
      if (i + j + 1 < n) part(i + 2. / 3, j + 2. / 3);
    }
  return n * n;
}

}  // namespace

PaintedProduct painted_product(const Paint& paint, const Rgb& rho,
                               const std::array<Vec3, 3>& triangle, int order) {
  const Eigen::Index size = basis_size(order);
  const Eigen::MatrixXd even = Eigen::MatrixXd::Identity(size, size);
  PaintedProduct product;
  product.fill(Eigen::MatrixXd::Zero(size, size));
  Eigen::MatrixXd gram = product[0];
  Eigen::VectorXd phi(size);
  Rgb mean = Rgb::Zero();
  const int count = sample(paint, triangle, [&](const TrianglePlace& place, const Rgb& colour) {
    basis_at(order, place, phi);
    mean += colour;
    gram.noalias() += phi * phi.transpose();
    for (int c = 0; c < 3; ++c) product[at(c)].noalias() += colour[c] * phi * phi.transpose();
  });
  // The rule is not exact for products of the basis; what is even need not suffer from that.
  for (int c = 0; c < 3; ++c)
    product[at(c)] =
        rho[c] / count * (product[at(c)] + mean[c] * (even - gram / static_cast<double>(count)));
  return product;
}

Rgb mean_colour(const Paint& paint, const std::array<Vec3, 3>& triangle) {
  Rgb sum = Rgb::Zero();
  const int count =
      sample(paint, triangle, [&](const TrianglePlace&, const Rgb& colour) { sum += colour; });
  return sum / count;
}

Rgb mean_reflectance(const SoundScene& scene, const Surface& surface,
                     const std::array<Vec3, 3>& triangle) {
  const Rgb& rho = scene.materials[at(surface.material)].rho;
  return surface.paint < 0 ? rho
                           : Rgb(rho * mean_colour(scene.paints[at(surface.paint)], triangle));
}

Rgb mean_reflected(const SoundScene& scene, const Surface& surface, const ElementTable& elements,
                   const ElementField& field, int element) {
  const Rgb& rho = scene.materials[at(surface.material)].rho;
  const Rgb arriving = field.of(element).row(0).transpose();
  if (surface.paint < 0) return rho * arriving;
  Rgb colours = Rgb::Zero(), differences = Rgb::Zero(), products = Rgb::Zero();
  const int count = sample(scene.paints[at(surface.paint)], elements.triangle(element),
                           [&](const TrianglePlace& place, const Rgb& colour) {
                             const Rgb off = value_at(field, element, place) - arriving;
                             colours += colour;
                             differences += off;
                             products += colour * off;
                           });
  // As above: where one colour is everywhere, nothing comes of the rule.
  const Rgb mean = colours / count;
  return rho * (mean * arriving + (products - mean * differences) / count);
}

}  // namespace halfshade
