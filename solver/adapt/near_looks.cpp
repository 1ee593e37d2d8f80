#include "solver/adapt/near_looks.h"

#include "meshing/core/rounded.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <unordered_map>

namespace halfshade {
namespace {

/// Circles around a corner, each half as wide as the one before, and places on each.
constexpr int most_circles = 7, places_each = 8;
/// Corners are near an element if no farther than this share of its size.
constexpr double near = 0.25;
constexpr int most_corners = 8;  ///< of an element
/// Farther from an edge than this share of its size, an element's own samples see what is there.
constexpr double seen_by_samples = 0.1;
/// Distances from an edge in its heights: the first place stands for those below √½; then each is
/// twice the one before and stands for those from √½ to √2 of it.
constexpr double first_distance = 0.35;
/// Shares of an element's size below this are rounding, of angles, too.
constexpr double same_place = 1e-9;
/// Of squared errors: some places alone may be off by this much.
constexpr double safety = 1.25;

double width_of(const std::array<Vec3, 3>& t) {
  return std::max({(t[1] - t[0]).norm(), (t[2] - t[1]).norm(), (t[0] - t[2]).norm()});
}

/// Both triangles at an edge have what lies on it, however it is rounded.
bool is_in(const TrianglePlace& p) {
  return p.minCoeff() >= -same_place && p.sum() <= 1 + same_place;
}

TrianglePlace inside(const TrianglePlace& p) {
  const TrianglePlace q = p.cwiseMax(0.);
  return q.sum() > 1 ? TrianglePlace(q / q.sum()) : q;
}

/// From where to where a triangle is seen from a point of its plane: angles in `right`, `up`.
std::array<double, 2> directions(const std::array<Vec2, 3>& corners) {
  std::vector<double> angles;
  double widest = 0;
  for (const Vec2& c : corners) widest = std::max(widest, c.norm());
  for (const Vec2& c : corners)
    if (c.norm() > same_place * widest) angles.push_back(std::atan2(c.y(), c.x()));
  std::sort(angles.begin(), angles.end());
  double gap = 0, from = 0;
  for (std::size_t k = 0; k < angles.size(); ++k) {
    const bool is_last = k + 1 == angles.size();
    const double next = is_last ? angles.front() + 2 * std::numbers::pi : angles[k + 1];
    if (next - angles[k] > gap) gap = next - angles[k], from = next;
  }
  // Seen from inside, no gap is wider than a half turn.
  if (gap < std::numbers::pi * (1 - same_place)) return {0, 2 * std::numbers::pi};
  return {from, from + 2 * std::numbers::pi - gap};
}

class Looker {
 public:
  Looker(const FittedElement& element, int index, std::vector<NearLook>& looks)
      : element_(element), index_(index), width_(width_of(element.triangle)), looks_(looks) {
    const Vec3& a = element.triangle[0];
    right_ = (element.triangle[1] - a).normalized();
    up_ = element.normal.cross(right_);
    for (const Vec3& p : element.triangle) middle_ += p / 3;
  }

  bool is_near(const Vec3& p, double reach) const {
    return (p - middle_).squaredNorm() < (reach + width_) * (reach + width_);
  }

  void around(const WatchedCorner& corner) {
    if (corner.height > near * width_ || !is_near(corner.foot, 0)) return;
    const TrianglePlace place = place_of(element_.triangle, corner.foot);
    if (place.minCoeff() < -near || place.sum() > 1 + near || ++groups_ > most_corners) return;
    std::array<Vec2, 3> seen;
    double radius = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 way = element_.triangle[k] - corner.foot;
      seen[k] = {way.dot(right_), way.dot(up_)};
      radius = std::max(radius, seen[k].norm());
    }
    const auto [from, to] = directions(seen);
    const double step = (to - from) / places_each;
    const double height = rounded(corner.height);
    for (int circle = 0; circle < most_circles && rounded(radius) > 0.5 * height; ++circle) {
      const bool is_last = circle + 1 == most_circles || rounded(radius) <= height;
      const double area = 0.5 * step * radius * radius * (is_last ? 1 : 0.75);
      const double middle = radius * (is_last ? 0.6 : 0.77);
      for (int k = 0; k < places_each; ++k) {
        const double angle = from + step * (k + (circle % 2 == 0 ? 0.4 : 0.6));
        add(corner.foot + middle * (std::cos(angle) * right_ + std::sin(angle) * up_), area,
            groups_);
      }
      radius /= 2;
    }
  }

  void along(const WatchedEdge& edge) {
    const Vec3 way = edge.feet[1] - edge.feet[0];
    const double length = way.norm(), farthest = rounded(seen_by_samples * width_);
    const double low = rounded(std::min(edge.height[0], edge.height[1]));
    if (low > farthest ||
        !is_near(edge.feet[0] +
                     std::clamp(way.dot(middle_ - edge.feet[0]) / (length * length), 0., 1.) * way,
                 farthest))
      return;
    const Vec3 across = element_.normal.cross(way / length);
    double distance = first_distance, band = std::numbers::sqrt2 / 2;
    for (; distance * low < farthest && distance < farthest / (same_place * width_);
         distance *= 2) {
      if (distance < 0.5) {
        add_parallels(edge, across, distance, band);
        distance = 0.5;  // the next is 1
        continue;
      }
      add_parallels(edge, across, distance, distance * std::numbers::sqrt2 / 2);
    }
  }

 private:
  void add(const Vec3& p, double area, int group) {
    const TrianglePlace place = place_of(element_.triangle, p);
    if (is_in(place)) looks_.push_back({index_, group, inside(place), area / element_.area});
  }

  /// On both sides, at so many heights from the edge, in the middle of what is in the element.
  void add_parallels(const WatchedEdge& edge, const Vec3& across, double distance, double band) {
    for (const double side : {-1., 1.}) {
      const Vec3 a = edge.feet[0] + side * distance * edge.height[0] * across;
      const Vec3 b = edge.feet[1] + side * distance * edge.height[1] * across;
      const TrianglePlace p = place_of(element_.triangle, a), q = place_of(element_.triangle, b);
      double low = 0, high = 1;
      const auto clip = [&](double from, double to) {
        if (from < 0 && to < 0)
          high = -1;
        else if (from < 0)
          low = std::max(low, from / (from - to));
        else if (to < 0)
          high = std::min(high, from / (from - to));
      };
      clip(p.x(), q.x());
      clip(p.y(), q.y());
      clip(1 - p.sum(), 1 - q.sum());
      if (!(low < high)) continue;
      const double middle = 0.5 * (low + high);
      const double height = (1 - middle) * edge.height[0] + middle * edge.height[1];
      if (distance * height < seen_by_samples * width_)
        add(a + middle * (b - a), (high - low) * (b - a).norm() * band * height, 0);
    }
  }

  const FittedElement& element_;
  int index_;
  double width_;
  std::vector<NearLook>& looks_;
  Vec3 middle_ = Vec3::Zero(), right_, up_;
  int groups_ = 0;  ///< 0 is that of edges
};

template <class Feature>
std::unordered_map<int, std::vector<const Feature*>> by_surface(const std::vector<Feature>& all) {
  std::unordered_map<int, std::vector<const Feature*>> result;
  for (const Feature& one : all) result[one.surface].push_back(&one);
  return result;
}

}  // namespace

std::vector<NearLook> near_looks(std::span<const FittedElement> elements, const Watched& watched,
                                 double mean_square, std::size_t most) {
  const auto corners = by_surface(watched.corners);
  const auto edges = by_surface(watched.edges);
  std::vector<std::pair<double, int>> order;  // how much it may matter, less than 0
  for (int e = 0; e < static_cast<int>(elements.size()); ++e) {
    const FittedElement& element = elements[at(e)];
    if (element.is_checked || !(element.area > 0)) continue;
    if (!corners.contains(element.surface) && !edges.contains(element.surface)) continue;
    const double square = element.fit.coefficients.matrix().squaredNorm();
    order.emplace_back(rounded(-element.area * element.weight * std::max(square, mean_square)), e);
  }
  std::sort(order.begin(), order.end());
  std::vector<NearLook> looks;
  for (const auto& [matters, e] : order) {
    if (looks.size() >= most) break;
    const FittedElement& element = elements[at(e)];
    Looker looker(element, e, looks);
    if (const auto found = edges.find(element.surface); found != edges.end())
      for (const WatchedEdge* edge : found->second) looker.along(*edge);
    if (const auto found = corners.find(element.surface); found != corners.end())
      for (const WatchedCorner* corner : found->second) looker.around(*corner);
  }
  return looks;
}

void take_near_looks(std::span<const NearLook> looks, std::span<const Rgb> values,
                     std::span<FittedElement> elements) {
  std::map<std::pair<int, int>, double> squares;  // element and group → mean square error
  for (std::size_t k = 0; k < looks.size(); ++k) {
    const NearLook& look = looks[k];
    squares[{look.element, look.group}] +=
        look.share * (values[k] - fitted_at(elements[at(look.element)], look.place)).square().sum();
  }
  for (const auto& [where, found] : squares) {
    FittedElement& element = elements[at(where.first)];
    const double square = safety * found;
    if (square <= element.fit.error * element.fit.error) continue;
    element.fit.error = std::sqrt(square);
    element.is_broken = true;
  }
}

}  // namespace halfshade
