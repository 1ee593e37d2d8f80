#include "solver/reflected/kernel_moments.h"

#include "meshing/core/planar.h"
#include "meshing/core/rounded.h"
#include "meshing/core/sound_scene.h"
#include "solver/elements/quadrature.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

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

/// Sizes of parts fall by half each time: by then they are as small as rounding.
constexpr int most_depth = 45;

/// Triangles whose area is less than this times the square of their longest edge are cut across:
/// quarters of a needle that are close to the point would be as many as its rows.
constexpr double needle = 0.02;
/// Of its length: no part is shorter. Of the shortest part: corners as close as that to a cut lie
/// on it, so that rounding does not choose where parts begin.
constexpr double shortest = 1e-12, on_cut = 1e-3;

/// A triangle along its longest edge.
struct Needle {
  Vec2 start, along;  ///< of the edge; `along` is a unit vector
  double length;
};

Needle needle_of(const std::array<Vec2, 3>& corners) {
  Needle longest{corners[0], Vec2::Zero(), -1};
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 edge = corners[(k + 1) % 3] - corners[k];
    if (rounded(edge.norm()) > rounded(longest.length)) longest = {corners[k], edge, edge.norm()};
  }
  longest.along /= longest.length;
  return longest;
}

/// Where to cut a needle: from the foot of the point twice as far each time.
struct Cuts {
  std::vector<double> at;
  double margin;  ///< what lies as close to one lies on it
};

Cuts cuts_of(const Needle& whole, double area, const PointAbovePlane& from) {
  const Vec2 way = from.foot - whole.start;
  const double middle = whole.along.dot(way);
  const double nearest = std::max({std::abs(from.height), std::abs(cross_2d(whole.along, way)),
                                   2 * std::abs(area) / whole.length, shortest * whole.length});
  const double farthest = std::max(middle, whole.length - middle);
  Cuts cuts{{}, on_cut * nearest};
  for (double away = nearest; rounded(away) < rounded(farthest); away *= 2)
    for (const double cut : {middle - away, middle + away})
      if (cut > cuts.margin && cut < whole.length - cuts.margin) cuts.at.push_back(cut);
  std::sort(cuts.at.begin(), cuts.at.end());
  return cuts;
}

/// The parts of a ring before and behind a line across a needle.
std::array<Ring, 2> parted(const Ring& ring, const Needle& whole, double cut, double margin) {
  std::array<Ring, 2> parts;
  const auto beyond = [&](const Vec2& p) {
    const double by = whole.along.dot(p - whole.start) - cut;
    return std::abs(by) > margin ? by : 0;
  };
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 &p = ring[k], &q = ring[(k + 1) % ring.size()];
    const double at_p = beyond(p), at_q = beyond(q);
    if (at_p <= 0) parts[0].push_back(p);
    if (at_p >= 0) parts[1].push_back(p);
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0))
      for (Ring& part : parts) part.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return parts;
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
  // A splinter that stands upright on the plane: nothing of it is seen, wherever its places are.
  if (!to_place_.allFinite()) to_place_.setZero();
}

void KernelMoments::add(std::span<const Vec2> ring) {
  for (std::size_t k = 2; k < ring.size(); ++k) add(ring[0], ring[k - 1], ring[k]);
}

void KernelMoments::add(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double area = 0.5 * cross_2d(b - a, c - a);
  if (area == 0) return;
  const Needle whole = needle_of({a, b, c});
  if (rounded(std::abs(area) / (whole.length * whole.length)) > needle)
    return add_part(a, b, c, area, 0);
  const auto add_fan = [this](const Ring& ring) {
    for (std::size_t k = 2; k < ring.size(); ++k)
      add_part(ring[0], ring[k - 1], ring[k],
               0.5 * cross_2d(ring[k - 1] - ring[0], ring[k] - ring[0]), 0);
  };
  Ring rest = {a, b, c};
  const Cuts cuts = cuts_of(whole, area, from_);
  for (const double cut : cuts.at) {
    auto [before, behind] = parted(rest, whole, cut, cuts.margin);
    add_fan(before);
    rest = std::move(behind);
  }
  add_fan(rest);
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
        factor * whole_power(open, rule.degree + 1 - order_ / 2) < tolerance_) {
      chosen = &rule;
      break;
    }
  if (!chosen && depth < most_depth) {
    const Vec2 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    const double quarter = 0.25 * area;
    add_part(a, ab, ca, quarter, depth + 1);
    add_part(ab, b, bc, quarter, depth + 1);
    add_part(ca, bc, c, quarter, depth + 1);
    add_part(bc, ca, ab, quarter, depth + 1);
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
