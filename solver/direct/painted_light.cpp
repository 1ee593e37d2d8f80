#include "solver/direct/painted_light.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/planar.h"
#include "solver/elements/quadrature.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

using Triangle2 = std::array<Vec2, 3>;

/// An edge of the visible part in the emitter's plane, from the lower to the upper end.
struct Slope {
  Vec2 low, high;
  int winding;  ///< +1 if the boundary runs upwards
  double x_at(double y) const {
    const double t = (y - low.y()) / (high.y() - low.y());
    return low.x() + t * (high.x() - low.x());
  }
};

std::vector<Slope> slopes_of(const std::vector<std::vector<Vec3>>& rings, const PlaneFrame& frame) {
  std::vector<Slope> slopes;
  for (const std::vector<Vec3>& ring : rings)
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = frame.to_plane(ring[k]), b = frame.to_plane(ring[(k + 1) % ring.size()]);
      if (a.y() < b.y()) slopes.push_back({a, b, 1});
      if (a.y() > b.y()) slopes.push_back({b, a, -1});
    }
  return slopes;
}

/// Cuts polygons with holes at the height of every corner into trapezoids, and those into
/// triangles: not pretty ones, but nothing can go wrong with touching rings and slivers.
std::vector<Triangle2> cut(const std::vector<Slope>& slopes) {
  std::vector<double> heights;
  for (const Slope& s : slopes) {
    heights.push_back(s.low.y());
    heights.push_back(s.high.y());
  }
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  std::vector<Triangle2> triangles;
  std::vector<const Slope*> across;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    const double low = heights[k], high = heights[k + 1], middle = 0.5 * (low + high);
    across.clear();
    for (const Slope& s : slopes)
      if (s.low.y() <= low && s.high.y() >= high) across.push_back(&s);
    std::sort(across.begin(), across.end(),
              [&](const Slope* a, const Slope* b) { return a->x_at(middle) < b->x_at(middle); });
    int winding = 0;
    for (std::size_t i = 0; i + 1 < across.size(); ++i) {
      winding += across[i]->winding;
      if (winding == 0) continue;
      const Vec2 a(across[i]->x_at(low), low), b(across[i + 1]->x_at(low), low);
      const Vec2 c(across[i + 1]->x_at(high), high), d(across[i]->x_at(high), high);
      if (b.x() > a.x()) triangles.push_back({a, b, c});
      if (c.x() > d.x()) triangles.push_back({a, c, d});
    }
  }
  return triangles;
}

/// If the paint varies at all, subdivision starts from this many triangles, lest the nodes of large
/// ones miss its breaks.
constexpr std::size_t first_triangles = 256;

/// A triangle, counter-clockwise in the emitter's frame, and the light from it.
struct Part {
  Triangle2 corners;
  Rgb irradiance = Rgb::Zero();
  double error = 0;
  bool even = true;
  double area() const {
    const Vec2 b = corners[1] - corners[0], c = corners[2] - corners[0];
    return 0.5 * std::abs(cross_2d(b, c));
  }
};

class PaintedSum {
 public:
  PaintedSum(const PlaneFrame& frame, const SurfacePoint& point, const ExitanceAt& exitance)
      : frame_(frame), point_(point), exitance_(exitance) {}

  Part evaluate(const Triangle2& t) const {
    const std::vector<Vec3> corners = {frame_.to_space(t[0]), frame_.to_space(t[1]),
                                       frame_.to_space(t[2])};
    const Vec2 b = t[1] - t[0], c = t[2] - t[0];
    Part part{t};
    const Rgb even = exitance_(frame_.to_space(t[0] + (b + c) / 3));
    const auto uneven = [&](int degree) {
      Rgb sum = Rgb::Zero();
      for (const TriangleNode& node : triangle_rule(degree)) {
        const Vec3 q = frame_.to_space(t[0] + node.u * b + node.v * c);
        const Rgb difference = exitance_(q) - even;
        part.even = part.even && (difference == 0).all();
        sum += node.weight * kernel(q) * difference;
      }
      return Rgb(part.area() * sum);
    };
    const Rgb fine = uneven(6), coarse = uneven(4);
    const double factor =
        unobstructed_factor(point_.position, point_.normal, std::span(&corners, 1));
    part.irradiance = factor * even + fine;
    part.error = (fine - coarse).abs().maxCoeff();
    return part;
  }

 private:
  double kernel(const Vec3& q) const {
    const Vec3 to = q - point_.position;
    const double squared = to.squaredNorm();
    return std::max(0., point_.normal.dot(to)) * std::max(0., -frame_.normal.dot(to)) /
           (std::numbers::pi * squared * squared);
  }

  const PlaneFrame& frame_;
  const SurfacePoint& point_;
  const ExitanceAt& exitance_;
};

/// Halves of a triangle across its longest edge.
std::array<Triangle2, 2> halves(const Triangle2& t) {
  std::size_t longest = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if ((t[(k + 1) % 3] - t[k]).squaredNorm() > (t[(longest + 1) % 3] - t[longest]).squaredNorm())
      longest = k;
  const Vec2 &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
  const Vec2 middle = 0.5 * (a + b);
  return {Triangle2{a, middle, c}, Triangle2{middle, b, c}};
}

/// The parts of the visible part; the worst is halved first, and before that the largest.
class Subdivision {
 public:
  Subdivision(const PaintedSum& sum, const std::vector<Triangle2>& triangles, std::size_t limit)
      : sum_(sum), limit_(limit) {
    for (const Triangle2& t : triangles) parts_.push_back(sum.evaluate(t));
    if (std::any_of(parts_.begin(), parts_.end(), [](const Part& p) { return !p.even; }))
      halve(
          first_triangles, [](const Part& p) { return p.area(); }, 0);
  }

  const std::vector<Part>& parts() const { return parts_; }

  /// Halves what has an error above `enough` until there are half as many parts again.
  void refine(double enough) {
    halve(
        parts_.size() + parts_.size() / 2 + 1, [](const Part& p) { return p.error; }, enough);
  }

 private:
  template <class Badness>
  void halve(std::size_t goal, Badness badness, double enough) {
    const auto better = [&](const Part& a, const Part& b) { return badness(a) < badness(b); };
    std::make_heap(parts_.begin(), parts_.end(), better);
    while (parts_.size() < std::min(goal, limit_) && badness(parts_.front()) > enough) {
      std::pop_heap(parts_.begin(), parts_.end(), better);
      const auto [left, right] = halves(parts_.back().corners);
      parts_.back() = sum_.evaluate(left);
      std::push_heap(parts_.begin(), parts_.end(), better);
      parts_.push_back(sum_.evaluate(right));
      std::push_heap(parts_.begin(), parts_.end(), better);
    }
  }

  const PaintedSum& sum_;
  std::size_t limit_;
  std::vector<Part> parts_;
};

}  // namespace

PaintedLight painted_irradiance(const DirectLightIndex& index, const SoundScene& scene,
                                const SurfacePoint& point, int emitter, const ExitanceAt& exitance,
                                const PaintedLightOptions& options) {
  PaintedLight light;
  VisiblePart part;
  index.visible_part(point, emitter, part);
  if (part.pieces.empty()) return light;
  const PlaneFrame& frame = scene.surfaces[static_cast<std::size_t>(emitter)].frame;
  const PaintedSum sum(frame, point, exitance);
  Subdivision subdivision(sum, cut(slopes_of(visible_rings(part, point.position, frame), frame)),
                          static_cast<std::size_t>(options.max_triangles));
  for (;;) {
    light.irradiance.setZero();
    light.error = 0;
    for (const Part& p : subdivision.parts()) {
      light.irradiance += p.irradiance;
      light.error += p.error;
    }
    light.triangles = static_cast<int>(subdivision.parts().size());
    const double allowed = options.tolerance * light.irradiance.abs().maxCoeff();
    light.converged = light.error <= allowed;
    if (light.converged || light.triangles >= options.max_triangles) return light;
    const std::size_t before = subdivision.parts().size();
    subdivision.refine(allowed / (2 * light.triangles));
    if (subdivision.parts().size() == before) return light;  // the paint is not a number somewhere
  }
}

}  // namespace halfshade
