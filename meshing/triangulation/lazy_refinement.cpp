#include "meshing/triangulation/lazy_refinement.h"

#include "meshing/core/planar.h"
#include "meshing/core/rounded.h"
#include "meshing/geometry/link.h"
#include "meshing/triangulation/margins.h"
#include "meshing/triangulation/narrow_corners.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

namespace halfshade {
namespace {

struct Shape {
  std::size_t shortest = 0, longest = 0;  // sides
  std::array<double, 3> squared{};        // of the sides
  double twice_area = 0;
  double sine_squared() const {  // of the smallest angle
    const double product = squared[(shortest + 1) % 3] * squared[(shortest + 2) % 3];
    return twice_area * twice_area / product;
  }
  double altitude() const { return twice_area / std::sqrt(squared[longest]); }
};

double extent(std::span<const Vec2> points) {
  Vec2 low = Vec2::Constant(HUGE_VAL), high = -low;
  for (const Vec2& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return points.empty() ? 1 : (high - low).norm();
}

class Refiner {
 public:
  Refiner(ConstrainedMesh& mesh, const RefinementLimits& limits)
      : mesh_(mesh), limits_(limits), corners_(mesh), cavity_(mesh) {
    const double sine = std::sin(limits.min_angle * std::numbers::pi / 180);
    sine_squared_ = sine * sine;
    off_centre_ = margins::off_centre / (2 * std::tan(limits.min_angle * std::numbers::pi / 360));
    added_on_.assign(mesh.points.size(), -1);
    unit_ = margins::shell_of_size * extent(mesh.points);
  }

  bool run() {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) push(static_cast<int>(t));
    while (!queue_.empty()) {
      const Entry entry = queue_.top();
      queue_.pop();
      if (mesh_.triangle(entry.triangle).corner != entry.corner) continue;
      if (mesh_.triangles.size() >= limits_.max_triangles) return false;
      improve(entry.triangle);
    }
    return true;
  }

 private:
  // Corners tell triangles apart: they follow from what was added, while numbers of triangles hang
  // on the way to where it was.
  struct Entry {
    double badness;
    int triangle;
    std::array<int, 3> corner;
    bool operator<(const Entry& other) const {
      return std::tie(badness, other.corner) < std::tie(other.badness, corner);
    }
  };

  const Vec2& point(int p) const { return mesh_.point(p); }

  Shape shape(int t) const {
    const auto& c = mesh_.triangle(t).corner;
    Shape s;
    for (std::size_t k = 0; k < 3; ++k) {
      s.squared[k] = (point(c[(k + 1) % 3]) - point(c[k])).squaredNorm();
      if (rounded(s.squared[k]) < rounded(s.squared[s.shortest])) s.shortest = k;
      if (rounded(s.squared[k]) > rounded(s.squared[s.longest])) s.longest = k;
    }
    const Vec2 u = point(c[1]) - point(c[0]), v = point(c[2]) - point(c[0]);
    s.twice_area = cross_2d(u, v);
    return s;
  }

  bool is_long(double squared_length) const {
    return limits_.max_length > 0 && squared_length > limits_.max_length * limits_.max_length;
  }
  bool is_long(const Shape& s) const { return is_long(s.squared[s.longest]); }

  // The smallest angle lies between constraints, or its side between twins.
  bool is_forced(int t, const Shape& s) const {
    const auto& triangle = mesh_.triangle(t);
    if (triangle.constraint[(s.shortest + 1) % 3] >= 0 &&
        triangle.constraint[(s.shortest + 2) % 3] >= 0)
      return true;
    const int a = triangle.corner[s.shortest], b = triangle.corner[(s.shortest + 1) % 3];
    return corners_.are_twins(mesh_, a, added_on_[at(a)], b, added_on_[at(b)]);
  }

  bool is_slim(int t, const Shape& s) const {
    return s.sine_squared() < sine_squared_ && !is_forced(t, s);
  }

  // Long triangles first, longest first; then slim ones, slimmest first.
  void push(int t) {
    const Shape s = shape(t);
    if (is_long(s))
      queue_.push({rounded(s.squared[s.longest] / (limits_.max_length * limits_.max_length)), t,
                   mesh_.triangle(t).corner});
    else if (is_slim(t, s))
      queue_.push({rounded(-s.sine_squared()), t, mesh_.triangle(t).corner});
  }

  void improve(int t) {
    const Shape s = shape(t);
    if (split_long_constraint(t, s) || add_centre(t, s) || !is_long(s)) return;
    add(0.5 * (point(mesh_.triangle(t).corner[s.longest]) +
               point(mesh_.triangle(t).corner[(s.longest + 1) % 3])),
        Side{t, s.longest}, 0);
  }

  bool split_long_constraint(int t, const Shape& s) {
    if (!is_long(s)) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (mesh_.triangle(t).constraint[k] >= 0 && is_long(s.squared[k]) && split(t, s, {t, k}))
        return true;
    return false;
  }

  // The circumcentre, or for slim triangles a point on the way there from the middle of the
  // shortest side that is just far enough for a good triangle with it.
  std::optional<Vec2> centre(int t, const Shape& s) const {
    const auto& c = mesh_.triangle(t).corner;
    const Vec2 p = point(c[s.shortest]), side = point(c[(s.shortest + 1) % 3]) - p;
    const Vec2 other = point(c[(s.shortest + 2) % 3]) - p;
    const Vec2 normal(-side.y(), side.x());
    // p + side/2 + x normal is equally far from p and the third corner.
    const double reach = (other.squaredNorm() - other.dot(side)) / (2 * s.twice_area);
    const double length = std::sqrt(s.squared[s.shortest]);
    const double far = reach * length;
    const double radius = std::hypot(far, 0.5 * length);
    if (!(radius >= limits_.shortest) && !is_long(s)) return {};
    double distance = far;
    if (s.sine_squared() < sine_squared_) {
      // Not so near that the new sides are too short.
      const double least =
          std::sqrt(std::max(0.0, margins::not_shorter * limits_.shortest * limits_.shortest -
                                      0.25 * length * length));
      distance = std::min(far, std::max(off_centre_ * length, least));
    }
    return Vec2(p + 0.5 * side + distance / length * normal);
  }

  // Whether something was added.
  bool add_centre(int t, const Shape& s) {
    const auto target = centre(t, s);
    if (!target) return false;
    const auto arrival = walk(mesh_, t, *target);
    if (!arrival) return false;
    if (arrival->is_blocked) return split(t, s, arrival->side);
    cavity_.find(*target, arrival->side.triangle);
    if (const auto side = encroached(*target)) return split(t, s, *side);
    return add(*target, {}, limits_.shortest);
  }

  // The longest constraint of the present cavity that p sees under a large angle.
  std::optional<Side> encroached(const Vec2& p) const {
    std::optional<Side> result;
    double longest = 0;
    Link first{};  // of the longest
    for (const Cavity::Rim& r : cavity_.rim()) {
      if (r.constraint < 0 && r.beyond >= 0) continue;
      const Vec2 u = point(r.from) - p, v = point(r.to) - p;
      const double length = rounded((u - v).squaredNorm());
      const Link ends = sorted_link(r.from, r.to);
      if ((length > longest || (length == longest && ends < first)) &&
          u.dot(v) <= margins::lens_cosine * u.norm() * v.norm()) {
        longest = length;
        first = ends;
        result = r.side;
      }
    }
    return result;
  }

  // Where to split a constraint.
  Vec2 split_point(const Vec2& a, const Vec2& b, bool is_narrow_at_a, bool is_narrow_at_b) const {
    const double length = (b - a).norm();
    if (is_narrow_at_a != is_narrow_at_b) {
      // All round a narrow corner at the same distances, or splits answer each other without end.
      const double shell = unit_ * std::exp2(std::round(std::log2(0.5 * length / unit_))) / length;
      return is_narrow_at_a ? Vec2(a + shell * (b - a)) : Vec2(b + shell * (a - b));
    }
    // What is too long comes to as few equal parts as may be.
    const double parts = is_long(length * length) ? std::ceil(length / limits_.max_length) : 2;
    const double share = std::floor(0.5 * parts) / parts;
    return share == 0.5 ? Vec2(0.5 * (a + b)) : Vec2(a + share * (b - a));
  }

  // Splits a constraint that is too long or in the way of triangle t's improvement. Length alone is
  // no reason to split one that is short enough: then neighbours along it agree by themselves.
  bool split(int t, const Shape& s, const Side& side) {
    const auto& triangle = mesh_.triangle(side.triangle);
    const int a = triangle.corner[side.k], b = triangle.corner[(side.k + 1) % 3];
    if (is_long(s) ? !is_long((point(b) - point(a)).squaredNorm())
                   : s.altitude() < limits_.shortest)
      return false;
    const int constraint = triangle.constraint[side.k];
    const Vec2 p = split_point(point(a), point(b), corners_.is_narrow_at(constraint, a),
                               corners_.is_narrow_at(constraint, b));
    const auto corner = mesh_.triangle(t).corner;
    if (std::min((p - point(a)).norm(), (p - point(b)).norm()) < limits_.shortest) return false;
    if (!add(p, side, limits_.shortest)) return false;
    if (mesh_.triangle(t).corner == corner) push(t);
    return true;
  }

  // Adds a point, on a side if that is given, else into the present cavity, unless that makes an
  // edge shorter than `shortest`.
  bool add(const Vec2& p, const std::optional<Side>& on, double shortest) {
    int constraint = -1;
    if (on) {
      constraint = mesh_.triangle(on->triangle).constraint[on->k];
      cavity_.find(p, *on);
    }
    for (const Cavity::Rim& r : cavity_.rim())
      if ((point(r.from) - p).squaredNorm() < shortest * shortest ||
          (point(r.to) - p).squaredNorm() < shortest * shortest)
        return false;
    if (!cavity_.fill(changed_)) return false;
    added_on_.push_back(constraint);
    for (const int t : changed_) push(t);
    return true;
  }

  ConstrainedMesh& mesh_;
  RefinementLimits limits_;
  NarrowCorners corners_;
  Cavity cavity_;
  double sine_squared_ = 0, off_centre_ = 0;
  double unit_ = 1;            // distances round narrow corners are this times powers of two
  std::vector<int> added_on_;  // [point] constraint, −1: none, or an original point
  std::vector<int> changed_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

bool refine_lazily(ConstrainedMesh& mesh, const RefinementLimits& limits) {
  return Refiner(mesh, limits).run();
}

}  // namespace halfshade
