#include "solver/reflected/kernel_moments.h"

#include "meshing/core/planar.h"
#include "solver/elements/quadrature.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Rules to choose from, the quickest first.
struct Rule {
  int degree;
  std::vector<TriangleNode> nodes;
};

const std::array<Rule, 4>& rules() {
  static const std::array<Rule, 4> all = [] {
    std::array<Rule, 4> made;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto nodes = triangle_rule(static_cast<int>(2 * i + 2));
      made[i] = {static_cast<int>(2 * i + 2), {nodes.begin(), nodes.end()}};
    }
    constexpr int degree = 11;
    made[3].degree = degree;
    const TriangleRule& gauss = gauss_rule(degree);
    for (std::size_t k = 0; k < gauss.places.size(); ++k)
      made[3].nodes.push_back(
          {gauss.places[k].x(), gauss.places[k].y(), gauss.weights[static_cast<Eigen::Index>(k)]});
    return made;
  }();
  return all;
}

/// A part is divided if it is larger than this times its distance, whatever the rules promise.
constexpr double most_open = 0.7;
double power(double x, int n) {
  double result = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1) result *= x;
  return result;
}

/// How often parts may be halved: by then their sizes are as small as rounding.
constexpr int most_depth = 90;

/// Parts whose area is less than this times the square of their size are halved across, for of
/// quarters of a needle those that are close would be as many as its rows.
constexpr double needle = 0.03;

/// Corners of the halves at the longest edge; the same area each.
std::array<std::array<Vec2, 3>, 2> halves_of(std::array<Vec2, 3> corners) {
  const auto edge = [&](std::size_t k) {
    return (corners[(k + 1) % 3] - corners[k]).squaredNorm();
  };
  const std::size_t longest = edge(0) >= edge(1) && edge(0) >= edge(2) ? 0
                              : edge(1) >= edge(2)                     ? 1
                                                                       : 2;
  std::rotate(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(longest),
              corners.end());
  const auto& [a, b, c] = corners;
  const Vec2 middle = 0.5 * (a + b);
  return {{{a, middle, c}, {middle, b, c}}};
}

}  // namespace

PointAbovePlane above_plane(const Vec3& position, const Vec3& normal, const PlaneFrame& plane) {
  return {plane.to_plane(position),
          plane.height(position),
          {normal.dot(plane.e1), normal.dot(plane.e2), normal.dot(plane.normal)}};
}

KernelMoments::KernelMoments(const PointAbovePlane& from, const std::array<Vec2, 3>& cell,
                             int order, double tolerance)
    : from_(from),
      origin_(cell[0]),
      order_(order),
      count_(static_cast<std::size_t>((order + 1) * (order + 2) / 2)),
      tolerance_(tolerance) {
  Eigen::Matrix2d edges;
  edges << cell[1] - cell[0], cell[2] - cell[0];
  to_place_ = edges.inverse();
}

void KernelMoments::add(std::span<const Vec2> ring) {
  for (std::size_t k = 2; k < ring.size(); ++k) add(ring[0], ring[k - 1], ring[k]);
}

void KernelMoments::add(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double area = 0.5 * cross_2d(b - a, c - a);
  if (area != 0) add_part(a, b, c, area, 0);
}

void KernelMoments::add_part(const Vec2& a, const Vec2& b, const Vec2& c, double area, int depth) {
  const Vec2 centre = (a + b + c) / 3;
  const double size = std::sqrt(std::max(
      {(a - centre).squaredNorm(), (b - centre).squaredNorm(), (c - centre).squaredNorm()}));
  const double distance =
      std::sqrt((centre - from_.foot).squaredNorm() + from_.height * from_.height);
  const double open = size / distance;
  const double factor =
      std::min(1., std::abs(area) * from_.height / (M_PI * distance * distance * distance));
  const Rule* chosen = nullptr;
  // A rule of degree d takes what is smooth to the order d + 1; half of the monomials' is lost.
  for (const Rule& rule : rules())
    if (rule.degree > order_ && open < most_open &&
        factor * power(open, rule.degree + 1 - order_ / 2) < tolerance_) {
      chosen = &rule;
      break;
    }
  if (!chosen && depth < most_depth && std::abs(area) < needle * size * size) {
    for (const auto& [p, q, r] : halves_of({a, b, c})) add_part(p, q, r, 0.5 * area, depth + 1);
    return;
  }
  if (!chosen && depth < most_depth) {
    const Vec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    const double quarter = 0.25 * area;
    add_part(a, ab, ca, quarter, depth + 2);
    add_part(ab, b, bc, quarter, depth + 2);
    add_part(ca, bc, c, quarter, depth + 2);
    add_part(bc, ca, ab, quarter, depth + 2);
    return;
  }
  if (!chosen) chosen = &rules().front();
  for (const TriangleNode& node : chosen->nodes) {
    const Vec2 y = node.u * a + node.v * b + (1 - node.u - node.v) * c;
    const double k = node.weight * area * irradiance_kernel(from_, y);
    const Vec2 place = to_place_ * (y - origin_);
    const double s = place.x(), t = place.y();
    values_[0] += k;
    if (order_ < 1) continue;
    values_[1] += k * s;
    values_[2] += k * t;
    if (order_ < 2) continue;
    values_[3] += k * s * s;
    values_[4] += k * s * t;
    values_[5] += k * t * t;
    if (order_ < 3) continue;
    values_[6] += k * s * s * s;
    values_[7] += k * s * s * t;
    values_[8] += k * s * t * t;
    values_[9] += k * t * t * t;
  }
}

}  // namespace halfshade
