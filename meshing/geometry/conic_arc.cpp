#include "meshing/geometry/conic_arc.h"

#include "meshing/core/planar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace halfshade {

namespace {

constexpr double largest_turn = 150 * std::numbers::pi / 180;
/// Nearest points are sought on pieces with weights in this range, whose parameter runs evenly
/// enough for polynomials in it to lose no digits.
constexpr double even_low = 0.5, even_high = 2;
/// 2^20 chords: deviations below 1e-12 of the size are asked for by mistake only.
constexpr int deepest_halving = 20;
/// Lengths below this share of the arc's size are rounding.
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();

double denominator(double weight, double s, double t) {
  return (1 - s) * (1 - t) + ((1 - s) * t + s * (1 - t)) * weight + s * t;
}

/// The bilinear form with p(s) = blossom(s, s); blossom(s, t) is where the tangents at s and t
/// meet.
Vec2 blossom(const ConicArc& arc, double s, double t) {
  const double mixed = ((1 - s) * t + s * (1 - t)) * arc.weight;
  return ((1 - s) * (1 - t) * arc.from + mixed * arc.control + s * t * arc.to) /
         denominator(arc.weight, s, t);
}

/// A piece of an arc and where it lies on it.
struct Piece {
  ConicArc arc;
  double s0 = 0, s1 = 1;
};

/// The parameter on the whole arc of parameter u on its piece between s0 and s1. The piece's own
/// parameter is a Möbius map of the arc's, because its end weights are scaled to one.
double parameter_on_whole(double weight, double s0, double s1, double u) {
  const double w0 = std::sqrt(denominator(weight, s0, s0));
  const double w1 = std::sqrt(denominator(weight, s1, s1));
  const double share = u * w0 / ((1 - u) * w1 + u * w0);
  return s0 + share * (s1 - s0);
}

/// Where the tangent is parallel to the chord of a piece: the point farthest from the chord.
double shoulder(double weight, double s0, double s1) {
  return parameter_on_whole(weight, s0, s1, 0.5);
}

/// How far the chord and the arc stray from each other at most.
double chord_deviation(const ConicArc& arc) {
  const Vec2 chord = arc.to - arc.from;
  const Vec2 first = arc.control - arc.from, second = arc.to - arc.control;
  // An arc that bulges beyond the ends of its chord: it stays in its triangle, at least.
  if (first.dot(chord) <= 0 || second.dot(chord) <= 0) return std::max(first.norm(), second.norm());
  return std::abs(cross_2d(chord, first)) / chord.norm() * arc.weight / (1 + arc.weight);
}

void halve(const ConicArc& arc, double s0, double s1, double deviation, int depth,
           std::vector<double>& ends) {
  const double middle = shoulder(arc.weight, s0, s1);
  if (depth < deepest_halving && s0 < middle && middle < s1 &&
      chord_deviation(part(arc, s0, s1)) > deviation) {
    halve(arc, s0, middle, deviation, depth + 1, ends);
    halve(arc, middle, s1, deviation, depth + 1, ends);
  } else {
    ends.push_back(s1);
  }
}

/// A polynomial in s, lowest power first.
template <std::size_t N>
double value(const std::array<double, N>& c, double s) {
  double sum = 0;
  for (std::size_t i = N; i-- > 0;) sum = sum * s + c[i];
  return sum;
}

template <std::size_t N>
std::array<double, N - 1> derivative(const std::array<double, N>& c) {
  std::array<double, N - 1> d{};
  for (std::size_t i = 1; i < N; ++i) d[i - 1] = static_cast<double>(i) * c[i];
  return d;
}

/// The root of a polynomial that changes sign between a and b, by Newton's method kept inside by
/// bisection.
template <std::size_t N>
double root_between(const std::array<double, N>& c, double a, double b) {
  const auto slope = derivative(c);
  const bool rises = value(c, a) < value(c, b);
  double s = 0.5 * (a + b);
  constexpr int enough = 60;  // bisection alone would do with 53
  for (int i = 0; i < enough && a < b; ++i) {
    const double f = value(c, s);
    if (f == 0) break;
    ((f < 0) == rises ? a : b) = s;
    const double newton = s - f / value(slope, s);
    const double next = newton > a && newton < b ? newton : 0.5 * (a + b);
    if (next == s) break;
    s = next;
  }
  return s;
}

/// Where a polynomial changes sign in (0, 1), in order: between the extrema, found likewise.
template <std::size_t N>
std::vector<double> sign_changes(const std::array<double, N>& c) {
  std::vector<double> breaks = {0};
  if constexpr (N > 2) {
    const std::vector<double> extrema = sign_changes(derivative(c));
    breaks.insert(breaks.end(), extrema.begin(), extrema.end());
  }
  breaks.push_back(1);
  std::vector<double> roots;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    if ((value(c, breaks[i]) < 0) != (value(c, breaks[i + 1]) < 0))
      roots.push_back(root_between(c, breaks[i], breaks[i + 1]));
  return roots;
}

/// (p(s) − q)·p'(s), times the cube of p's denominator: a quartic, because N' W − N W' is quadratic
/// for quadratic N and W.
std::array<double, 5> slope_of_square_distance(const ConicArc& arc, const Vec2& q) {
  const Vec2 n0 = arc.from - q, middle = arc.weight * (arc.control - q), n_end = arc.to - q;
  const Vec2 n1 = 2 * (middle - n0), n2 = n0 - 2 * middle + n_end;
  const double w1 = 2 * (arc.weight - 1), w2 = -w1;
  const Vec2 d0 = n1 - w1 * n0, d1 = 2 * (n2 - w2 * n0), d2 = w1 * n2 - w2 * n1;
  return {n0.dot(d0), n0.dot(d1) + n1.dot(d0), n0.dot(d2) + n1.dot(d1) + n2.dot(d0),
          n1.dot(d2) + n2.dot(d1), n2.dot(d2)};
}

/// Derivative of p(s).
Vec2 velocity(const ConicArc& arc, double s) {
  const double w = denominator(arc.weight, s, s);
  const Vec2 rise =
      arc.weight * ((1 - s) * (1 - s) * (arc.control - arc.from) + s * s * (arc.to - arc.control)) +
      s * (1 - s) * (arc.to - arc.from);
  return 2 / (w * w) * rise;
}

struct Nearest {
  double s = 0;
  double distance = std::numeric_limits<double>::infinity();
};

/// On an arc whose weight is near one.
Nearest nearest_on_even(const ConicArc& arc, const Vec2& q) {
  Nearest best;
  const auto consider = [&](double s) {
    const double d = (point_at(arc, s) - q).norm();
    if (d < best.distance) best = {s, d};
  };
  consider(0);
  consider(1);
  for (const double s : sign_changes(slope_of_square_distance(arc, q))) consider(s);
  // For points on the arc the distance is as inexact as the root: a step along the tangent.
  const Vec2 v = velocity(arc, best.s);
  if (v.squaredNorm() > 0)
    consider(std::clamp(best.s + v.dot(q - point_at(arc, best.s)) / v.squaredNorm(), 0.0, 1.0));
  return best;
}

Nearest nearest(const ConicArc& arc, const Vec2& q) {
  if (arc.is_straight)
    return {nearest_on_segment(q, arc.from, arc.to), distance_to_segment(q, arc.from, arc.to)};
  if (arc.weight >= even_low && arc.weight <= even_high) return nearest_on_even(arc, q);
  // Halving takes weights towards one: w becomes √((1 + w)/2).
  const Nearest first = nearest(part(arc, 0, 0.5), q), second = nearest(part(arc, 0.5, 1), q);
  if (first.distance <= second.distance)
    return {parameter_on_whole(arc.weight, 0, 0.5, first.s), first.distance};
  return {parameter_on_whole(arc.weight, 0.5, 1, second.s), second.distance};
}

}  // namespace

ConicArc straight_arc(const Vec2& from, const Vec2& to) {
  return {from, 0.5 * (from + to), to, 1, true};
}

std::optional<ConicArc> conic_arc(const Vec2& from, const Vec2& from_tangent, const Vec2& between,
                                  const Vec2& to, const Vec2& to_tangent, double flat) {
  const bool near_chord = distance_to_segment(between, from, to) <= flat;
  const Vec2 chord = to - from;
  const double size = chord.norm();
  if (near_chord && size <= flat) return straight_arc(from, to);
  if (!(size > 0)) return std::nullopt;
  // Angles at the ends, positive if the arc lies on the right of its chord (turns left).
  const Vec2 along = chord / size;
  const double first = std::atan2(cross_2d(from_tangent, along), from_tangent.dot(along));
  const double second = std::atan2(cross_2d(along, to_tangent), along.dot(to_tangent));
  // Tangents that leave the chord by less than `flat` over its length say nothing else either.
  if (near_chord && size * std::max(std::abs(first), std::abs(second)) <= flat)
    return straight_arc(from, to);
  const double turn = std::abs(first + second);
  const bool convex = first * second > 0 && turn < largest_turn;
  if (!convex) {
    // An arc between collinear points that seems to swing to both sides is straight, with tangents
    // that are inexact; unless they are far off.
    constexpr double off = 0.1;
    if (near_chord && std::max(std::abs(first), std::abs(second)) < off)
      return straight_arc(from, to);
    return std::nullopt;
  }
  const double leg = size * std::sin(second) / std::sin(first + second);
  // Coordinates along the chord and across it towards the arc; `across` never vanishes here.
  const double side = first > 0 ? 1 : -1;
  const double control_along = leg * std::cos(first);
  const double control_across = leg * std::abs(std::sin(first));
  const Vec2 right(side * along.y(), -side * along.x());
  const Vec2 offset = between - from;
  const double middle = right.dot(offset) / control_across;
  const double last = (along.dot(offset) - middle * control_along) / size;
  const double start = 1 - middle - last;
  const Vec2 control = from + control_along * along + control_across * right;
  if (middle > 0 && last > 0 && start > 0) {
    const ConicArc arc = {from, control, to, middle / (2 * std::sqrt(start * last)), false};
    if (chord_deviation(arc) > flat || !near_chord) return arc;
    return straight_arc(from, to);
  }
  if (near_chord && control_across <= flat) return straight_arc(from, to);
  return std::nullopt;
}

Vec2 point_at(const ConicArc& arc, double s) {
  if (s == 0) return arc.from;
  if (s == 1) return arc.to;
  if (arc.is_straight) return (1 - s) * arc.from + s * arc.to;
  return blossom(arc, s, s);
}

Vec2 tangent_at(const ConicArc& arc, double s) {
  if (arc.is_straight) return (arc.to - arc.from).normalized();
  return velocity(arc, s).normalized();
}

ConicArc part(const ConicArc& arc, double s0, double s1) {
  const Vec2 from = point_at(arc, s0), to = point_at(arc, s1);
  if (arc.is_straight) return straight_arc(from, to);
  const double ends = denominator(arc.weight, s0, s0) * denominator(arc.weight, s1, s1);
  return {from, blossom(arc, s0, s1), to, denominator(arc.weight, s0, s1) / std::sqrt(ends), false};
}

double length(const ConicArc& arc) {
  if (arc.is_straight) return (arc.to - arc.from).norm();
  constexpr double fine = 1e-6;  // some 300 chords, 1e-6 of the length too short
  const double size = (arc.control - arc.from).norm() + (arc.to - arc.control).norm();
  const std::vector<double> ends = flatten(arc, fine * size);
  double sum = 0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    sum += (point_at(arc, ends[i + 1]) - point_at(arc, ends[i])).norm();
  return sum;
}

double distance(const ConicArc& arc, const Vec2& p) { return nearest(arc, p).distance; }

double nearest_parameter(const ConicArc& arc, const Vec2& p) { return nearest(arc, p).s; }

std::vector<double> flatten(const ConicArc& arc, double deviation) {
  std::vector<double> ends = {0};
  if (arc.is_straight) {
    ends.push_back(1);
    return ends;
  }
  const double size = (arc.control - arc.from).norm() + (arc.to - arc.control).norm();
  halve(arc, 0, 1, std::max(deviation, rounding * size), 0, ends);
  return ends;
}

}  // namespace halfshade
