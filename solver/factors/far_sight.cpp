#include "solver/factors/far_sight.h"

#include "meshing/core/plane_frame.h"
#include "solver/elements/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Corners of a parallelogram close up to this, relative to its size.
constexpr double closing = 1e-13;
/// Nearer than this, relative to size, other ways are as quick.
constexpr double nearest = 2;
/// More evaluations of the kernel than this take longer than a closed form of one of the two.
constexpr std::size_t most_evaluations = 400;
/// Just above what the worst of some 8,600 random pairs was off by, relative to the kernel's
/// largest value times the ratio of size to distance to the power of degree + 1; 10 to 40 times
/// less on average.
constexpr std::array<double, 5> of_parallelograms = {12, 6, 3, 1.2, 0.4};
constexpr std::array<double, 4> of_triangles = {6, 1, 0.5, 0.1};

/// Gauss's rules on [−1,1] with one to five places, for the non-negative half.
struct GaussPlace {
  double x, weight;
};
const std::array<std::vector<GaussPlace>, 5>& gauss_places() {
  static const std::array<std::vector<GaussPlace>, 5> places = {
      {{{0, 2}},
       {{0.57735026918962576, 1}},
       {{0, 8. / 9}, {0.77459666924148338, 5. / 9}},
       {{0.33998104358485626, 0.65214515486254614}, {0.86113631159405258, 0.34785484513745386}},
       {{0, 128. / 225},
        {0.53846931010568309, 0.47862867049936647},
        {0.90617984593866399, 0.23692688505618909}}}};
  return places;
}

void add_place(const Vec3& place, double weight, AreaRule& rule) {
  rule.x.push_back(place.x());
  rule.y.push_back(place.y());
  rule.z.push_back(place.z());
  rule.weight.push_back(weight);
}

void add_parallelogram_rules(FarPiece& piece) {
  const Vec3 u = 0.5 * (piece.corners[1] - piece.corners[0]);
  const Vec3 v = 0.5 * (piece.corners[3] - piece.corners[0]);
  for (std::size_t n = 1; n <= gauss_places().size(); ++n) {
    std::vector<GaussPlace> line;
    for (const GaussPlace& place : gauss_places()[n - 1]) {
      line.push_back(place);
      if (place.x > 0) line.push_back({-place.x, place.weight});
    }
    AreaRule& rule = piece.rules.emplace_back();
    rule.degree = static_cast<int>(2 * n - 1);
    rule.left_out = of_parallelograms[n - 1];
    for (const GaussPlace& a : line)
      for (const GaussPlace& b : line)
        add_place(piece.centre + a.x * u + b.x * v, 0.25 * a.weight * b.weight * piece.area, rule);
  }
}

void add_triangle_rules(FarPiece& piece) {
  const Vec3 b = piece.corners[1] - piece.corners[0], c = piece.corners[2] - piece.corners[0];
  for (const int degree : {1, 2, 4, 6}) {
    AreaRule& rule = piece.rules.emplace_back();
    rule.degree = degree;
    rule.left_out = of_triangles[piece.rules.size() - 1];
    for (const TriangleNode& node : triangle_rule(degree))
      add_place(piece.corners[0] + node.u * b + node.v * c, node.weight * piece.area, rule);
  }
}

/// Of a polygon's corners over the plane of another one.
struct Heights {
  double least = HUGE_VAL, most = -HUGE_VAL;

  Heights(const FarPiece& above, const FarPiece& plane) {
    for (const Vec3& p : above.corners) {
      const double height = plane.normal.dot(p - plane.centre);
      least = std::min(least, height);
      most = std::max(most, height);
    }
  }
};

/// What a rule may be off by, relative to the kernel's largest value, at a ratio of size to
/// distance: the terms of the kernel's series that it leaves out fall like its powers.
double left_out(const AreaRule& rule, double ratio) {
  double power = rule.left_out * ratio;
  for (int k = 0; k < rule.degree; ++k) power *= ratio;
  return power;
}

/// The first rule that is good enough, or nothing.
const AreaRule* first_within(const FarPiece& piece, double ratio, double allowed, double& error) {
  for (const AreaRule& rule : piece.rules)
    if (error = left_out(rule, ratio); error <= allowed) return &rule;
  return nullptr;
}

double sum_of_kernel(const AreaRule& p, const Vec3& p_normal, const AreaRule& q,
                     const Vec3& q_normal) {
  const std::size_t places = q.weight.size();
  const double *x = q.x.data(), *y = q.y.data(), *z = q.z.data(), *weight = q.weight.data();
  double sum = 0;
  for (std::size_t i = 0; i < p.weight.size(); ++i) {
    const double px = p.x[i], py = p.y[i], pz = p.z[i];
    double inner = 0;
    for (std::size_t j = 0; j < places; ++j) {
      const double dx = x[j] - px, dy = y[j] - py, dz = z[j] - pz;
      const double r2 = dx * dx + dy * dy + dz * dz;
      const double from_p = p_normal.x() * dx + p_normal.y() * dy + p_normal.z() * dz;
      const double from_q = q_normal.x() * dx + q_normal.y() * dy + q_normal.z() * dz;
      inner -= weight[j] * from_p * from_q / (r2 * r2);
    }
    sum += p.weight[i] * inner;
  }
  return sum / std::numbers::pi;
}

}  // namespace

FarPiece far_piece(const std::vector<Vec3>& corners) {
  FarPiece piece;
  const Vec3 size = area_vector(corners);
  piece.area = size.norm();
  if (!(piece.area > 0)) return piece;
  piece.normal = size / piece.area;
  piece.corners = corners;
  for (const Vec3& p : corners) piece.centre += p / static_cast<double>(corners.size());
  for (const Vec3& p : corners) piece.radius = std::max(piece.radius, (p - piece.centre).norm());
  if (corners.size() == 3)
    add_triangle_rules(piece);
  else if (corners.size() == 4 && (corners[0] - corners[1] + corners[2] - corners[3]).norm() <=
                                      closing * (piece.radius + piece.centre.norm()))
    add_parallelogram_rules(piece);
  return piece;
}

std::optional<MutualArea> far_area(const FarPiece& p, const FarPiece& q,
                                   const FormFactorOptions& options) {
  if (p.rules.empty() || q.rules.empty()) return std::nullopt;
  const double distance = (q.centre - p.centre).norm();
  const double from_p = distance - q.radius, from_q = distance - p.radius;
  if (!(from_p > nearest * p.radius && from_q > nearest * q.radius)) return std::nullopt;
  const Heights over_p(q, p), over_q(p, q);
  if (!(over_p.least >= 0 && over_q.least >= 0)) return std::nullopt;
  const double squared = from_p * from_q;
  const double unit = p.area * q.area / (std::numbers::pi * squared * squared);
  const double least = unit * over_p.least * over_q.least, most = unit * over_p.most * over_q.most;
  if (!(most > 0)) return std::nullopt;
  // What is surely good enough; whether it is, the value tells.
  const double allowed = 0.5 * std::max(options.floor, options.tolerance * least) / most;
  double error_p = 0, error_q = 0;
  const AreaRule* rule_p = first_within(p, p.radius / from_p, allowed, error_p);
  const AreaRule* rule_q = first_within(q, q.radius / from_q, allowed, error_q);
  if (!rule_p || !rule_q || rule_p->weight.size() * rule_q->weight.size() > most_evaluations)
    return std::nullopt;
  MutualArea result;
  result.value = sum_of_kernel(*rule_p, p.normal, *rule_q, q.normal);
  result.error = (error_p + error_q) * most;
  result.points = static_cast<int>(rule_p->weight.size());
  return result;
}

}  // namespace halfshade
