#include "solver/exchange/form_factor.h"

#include "meshing/core/plane_frame.h"
#include "solver/elements/quadrature.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <numbers>
#include <vector>

namespace halfshade {
namespace {

/// Closer than this, relative to the outer polygon's size, fixed rules over its area are not
/// trusted.
constexpr double nearest_for_rules = 3;
/// A vertex of the inner contour this close to an outer edge, relative to its length, splits the
/// edge.
constexpr double near_by = 0.5;
/// Edges whose directions have at most this cosine do not contribute: it is rounding.
constexpr double perpendicular = 1e-15;
constexpr int max_depth = 40;
/// What is summed cannot be told apart by less than this part of its terms.
constexpr double rounding_of_terms = 4 * DBL_EPSILON;

/// Nodes on [−1,1] and weights of the Kronrod rule with 15 nodes and of the Gauss rule with 7 that
/// is nested in it (Kronrod 1965), for the non-negative half.
struct KronrodNode {
  double x, kronrod, gauss;
};
constexpr std::array<KronrodNode, 8> kronrod_rule = {
    {{0.991455371120812639, 0.022935322010529225, 0},
     {0.949107912342758525, 0.063092092629978553, 0.129484966168869693},
     {0.864864423359769073, 0.104790010322250184, 0},
     {0.741531185599394440, 0.140653259715525919, 0.279705391489276668},
     {0.586087235467691130, 0.169004726639267903, 0},
     {0.405845151377397167, 0.190350578064785410, 0.381830050505118945},
     {0.207784955007898468, 0.204432940075298892, 0},
     {0, 0.209482141084727828, 0.417959183673469388}}};

/// ∫ ln(|x − y|/unit) dy over the segment from a to b, in closed form.
double log_potential(const Vec3& x, const Vec3& a, const Vec3& b, double unit) {
  const Vec3 direction = (b - a).normalized();
  const double from = direction.dot(a - x), to = direction.dot(b - x);
  const double distance = (a - x - from * direction).norm();
  const auto primitive = [&](double t) {
    const double r2 = t * t + distance * distance;
    return r2 > 0 ? 0.5 * t * std::log(r2 / (unit * unit)) - t : 0.;
  };
  const double angle = std::atan2(distance * (to - from), distance * distance + to * from);
  return primitive(to) - primitive(from) + distance * angle;
}

/// Stokes' form of the mutual area, (1/2π) ∮∮ ln r dx·dy (Sparrow 1963), with the inner contour in
/// closed form and adaptive quadrature along the outer one.
class ContourIntegral {
 public:
  ContourIntegral(std::span<const Vec3> inner, const FormFactorOptions& options, double unit,
                  const std::stop_token& stop)
      : inner_(inner), options_(options), unit_(unit), stop_(stop) {}

  MutualArea integrate(std::span<const Vec3> outer) {
    for (std::size_t k = 0; k < outer.size(); ++k)
      start_edge(outer[k], outer[(k + 1) % outer.size()]);
    refine();
    for (const Interval& interval : intervals_) {
      result_.value += interval.value;
      result_.error += interval.error;
    }
    return result_;
  }

 private:
  /// Part [from, to] of the parameter of a piece of an outer edge.
  struct Interval {
    std::size_t piece;
    double from, to, value, error;
    double terms;  ///< that of which `value` is the sum, without their signs
    int depth;
  };
  struct Piece {
    Vec3 from, along;
  };

  /// Splits the edge where it passes a vertex of the inner contour, near which the integrand is not
  /// smooth.
  void start_edge(const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double length = along.norm();
    if (!(length > 0)) return;
    const bool perpendicular_to_all = std::all_of(inner_.begin(), inner_.end(), [&](const Vec3& v) {
      const Vec3& next = inner_[(static_cast<std::size_t>(&v - inner_.data()) + 1) % inner_.size()];
      return std::abs(along.dot(next - v)) <= perpendicular * length * (next - v).norm();
    });
    if (perpendicular_to_all) return;
    std::vector<double> breaks = {0, 1};
    for (const Vec3& v : inner_) {
      const double t = along.dot(v - a) / (length * length);
      if (t > 0 && t < 1 && (v - a - t * along).norm() < near_by * length) breaks.push_back(t);
    }
    std::sort(breaks.begin(), breaks.end());
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
      if (breaks[k + 1] > breaks[k]) {
        pieces_.push_back({a + breaks[k] * along, (breaks[k + 1] - breaks[k]) * along});
        intervals_.push_back(evaluate(pieces_.size() - 1, 0, 1, 0));
      }
  }

  struct Sum {
    double value = 0, terms = 0;
  };

  /// (1/2π) Σ over the inner edges at the point x, times the outer direction.
  Sum integrand(const Vec3& x, const Vec3& along) const {
    Sum sum;
    Vec3 a = inner_.back();
    for (const Vec3& b : inner_) {
      // Clipping may leave edges without length.
      if (const double length = (b - a).norm(); length > 0) {
        const double term =
            along.dot(b - a) / length * log_potential(x, a, b, unit_) / (2 * std::numbers::pi);
        sum.value += term;
        sum.terms += std::abs(term);
      }
      a = b;
    }
    return sum;
  }

  Interval evaluate(std::size_t piece, double from, double to, int depth) {
    const auto& [start, along] = pieces_[piece];
    double kronrod = 0, gauss = 0, terms = 0;
    const auto add = [&](double x, const KronrodNode& node) {
      // s = u³(10 − 15u + 6u²) gathers the nodes at the ends of the piece, where the integrand may
      // have singularities like t ln t.
      const double u = 0.5 * (from + to) + 0.5 * (to - from) * x;
      const double s = u * u * u * (10 - u * (15 - 6 * u));
      const double slope = 30 * u * u * (1 - u) * (1 - u);
      const Sum sum = integrand(start + s * along, along);
      kronrod += node.kronrod * slope * sum.value;
      gauss += node.gauss * slope * sum.value;
      terms += node.kronrod * slope * sum.terms;
    };
    for (const KronrodNode& node : kronrod_rule) {
      add(node.x, node);
      if (node.x > 0) add(-node.x, node);
    }
    result_.points += 15;
    const double half = 0.5 * (to - from);
    return {piece, from, to, half * kronrod, half * std::abs(kronrod - gauss), half * terms, depth};
  }

  /// Halves the intervals that are worst until the sum of the errors is small enough.
  void refine() {
    const auto worse = [](const Interval& a, const Interval& b) { return a.error < b.error; };
    std::make_heap(intervals_.begin(), intervals_.end(), worse);
    while (!intervals_.empty() && result_.points < options_.max_points && !stop_.stop_requested()) {
      double value = 0, error = 0, terms = 0;
      for (const Interval& interval : intervals_) {
        value += interval.value;
        error += interval.error;
        terms += interval.terms;
      }
      // Of two that are all but in one plane nothing is left but rounding.
      if (error <= std::max({options_.tolerance * std::abs(value), options_.floor,
                             rounding_of_terms * terms}))
        break;
      const Interval worst = intervals_.front();
      if (worst.depth >= max_depth) break;
      std::pop_heap(intervals_.begin(), intervals_.end(), worse);
      const double middle = 0.5 * (worst.from + worst.to);
      intervals_.back() = evaluate(worst.piece, worst.from, middle, worst.depth + 1);
      std::push_heap(intervals_.begin(), intervals_.end(), worse);
      intervals_.push_back(evaluate(worst.piece, middle, worst.to, worst.depth + 1));
      std::push_heap(intervals_.begin(), intervals_.end(), worse);
    }
  }

  std::span<const Vec3> inner_;
  FormFactorOptions options_;
  double unit_;
  const std::stop_token& stop_;
  std::vector<Piece> pieces_;
  std::vector<Interval> intervals_;
  MutualArea result_;
};

/// A ball round a polygon's vertices.
struct Ball {
  Vec3 centre;
  double radius;
};

Ball bounding_ball(std::span<const Vec3> polygon) {
  Ball ball{Vec3::Zero(), 0};
  for (const Vec3& p : polygon) ball.centre += p / static_cast<double>(polygon.size());
  for (const Vec3& p : polygon) ball.radius = std::max(ball.radius, (p - ball.centre).norm());
  return ball;
}

bool straddles(std::span<const Vec3> polygon, const Vec3& point, const Vec3& normal) {
  return std::any_of(polygon.begin(), polygon.end(),
                     [&](const Vec3& p) { return normal.dot(p - point) < 0; });
}

}  // namespace

// The plain sum, not EdgeSum: what cancels is 1e-16 of a few radians, far below the tolerance of
// any factor, and a triangle takes 0.11 µs instead of 0.26 µs, which is a quarter of the whole
// exchange.
double lambert_sum(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon) {
  double sum = 0;
  Vec3 a = polygon.back() - point;
  for (const Vec3& vertex : polygon) {
    const Vec3 b = vertex - point;
    const Vec3 cross = a.cross(b);
    const double sine = cross.norm();
    // An edge whose line passes through the point contributes nothing.
    if (sine > 0) sum += std::atan2(sine, a.dot(b)) / sine * normal.dot(cross);
    a = b;
  }
  // Seen from the front a counter-clockwise polygon runs clockwise round the direction towards it.
  return -sum / (2 * std::numbers::pi);
}

double point_to_polygon(const Vec3& point, const Vec3& normal, std::span<const Vec3> polygon) {
  if (!straddles(polygon, point, normal)) return std::max(0., lambert_sum(point, normal, polygon));
  const std::vector<Vec3> above = clip_to_front(polygon, point, normal);
  return above.empty() ? 0. : std::max(0., lambert_sum(point, normal, above));
}

double mutual_area_by_rule(const std::array<Vec3, 3>& outer, const Vec3& outer_normal,
                           std::span<const Vec3> inner, int degree) {
  const Vec3 b = outer[1] - outer[0], c = outer[2] - outer[0];
  double sum = 0;
  for (const TriangleNode& node : triangle_rule(degree))
    sum += node.weight *
           std::max(0., lambert_sum(outer[0] + node.u * b + node.v * c, outer_normal, inner));
  return 0.5 * b.cross(c).norm() * sum;
}

int sufficient_degree(double ratio, double tolerance) {
  if (ratio < nearest_for_rules) return -1;
  for (const int degree : {1, 2, 4, 6})
    if (std::pow(ratio, -(degree + 1)) <= tolerance) return degree;
  return -1;
}

MutualArea mutual_area(std::span<const Vec3> p, std::span<const Vec3> q,
                       const FormFactorOptions& options, const std::stop_token& stop) {
  const Vec3 p_area = area_vector(p), q_area = area_vector(q);
  const double p_size = p_area.norm(), q_size = q_area.norm();
  if (!(p_size > 0 && q_size > 0)) return {};
  const Vec3 p_normal = p_area / p_size, q_normal = q_area / q_size;
  std::vector<Vec3> outer = clip_to_front(p, q[0], q_normal);
  std::vector<Vec3> inner = clip_to_front(q, p[0], p_normal);
  if (outer.empty() || inner.empty()) return {};
  const Ball outer_ball = bounding_ball(outer), inner_ball = bounding_ball(inner);
  const double distance = (outer_ball.centre - inner_ball.centre).norm();
  const double ratio = (distance - inner_ball.radius) / outer_ball.radius;
  if (const int degree = sufficient_degree(ratio, options.tolerance); degree > 0) {
    MutualArea result;
    for (std::size_t k = 1; k + 1 < outer.size(); ++k) {
      result.value +=
          mutual_area_by_rule({outer[0], outer[k], outer[k + 1]}, p_normal, inner, degree);
      result.points += static_cast<int>(triangle_rule(degree).size());
    }
    result.error = result.value * options.tolerance;
    return result;
  }
  // Any unit will do; that of two which coincide must not be 0.
  const double unit = std::max(distance, DBL_EPSILON * outer_ball.radius);
  MutualArea result = ContourIntegral(inner, options, unit, stop).integrate(outer);
  result.value = std::max(result.value, 0.);
  return result;
}

double form_factor(std::span<const Vec3> p, std::span<const Vec3> q,
                   const FormFactorOptions& options) {
  return mutual_area(p, q, options).value / area_vector(p).norm();
}

}  // namespace halfshade
