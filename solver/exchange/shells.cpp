#include "solver/exchange/shells.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>

namespace halfshade {

JoinedSets::JoinedSets(int count) : parent_(at(count)) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

int JoinedSets::root(int a) {
  while (parent_[at(a)] != a) a = parent_[at(a)] = parent_[at(parent_[at(a)])];
  return a;
}

void JoinedSets::join(int a, int b) {
  const int x = root(a), y = root(b);
  parent_[at(std::max(x, y))] = std::min(x, y);
}

std::vector<int> JoinedSets::numbered() {
  std::vector<int> number(parent_.size(), -1);
  int count = 0;
  for (std::size_t k = 0; k < parent_.size(); ++k) {
    // The root of a set is its first thing.
    const int r = root(static_cast<int>(k));
    number[k] = at(r) == k ? count++ : number[at(r)];
  }
  return number;
}

namespace {

/// Point of the table → number of its position.
std::vector<int> number_positions(const std::vector<Vec3>& points) {
  std::vector<int> order(points.size()), number(points.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Vec3& p = points[at(i)];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  int count = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k > 0 && key(order[k]) != key(order[k - 1])) ++count;
    number[at(order[k])] = count;
  }
  return number;
}

/// An element at an edge, which runs between two numbered positions.
struct HalfPlane {
  int low = 0, high = 0;
  int element = 0;
  int start = 0;         ///< the element's corner where the edge starts
  bool runs_up = false;  ///< its boundary runs from low to high: its front looks the way of angles
  double angle = 0;

  /// The side that looks the way of growing angles, and the one that looks back.
  int ahead() const { return 2 * element + (runs_up ? 0 : 1); }
  int behind() const { return 2 * element + (runs_up ? 1 : 0); }
};

std::vector<HalfPlane> find_half_planes(const ElementTable& elements) {
  const std::vector<int> position = number_positions(elements.points);
  std::vector<HalfPlane> planes;
  planes.reserve(3 * elements.corners.size());
  for (int e = 0; e < elements.count(); ++e)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& corners = elements.corners[at(e)];
      const int a = position[at(corners[k])], b = position[at(corners[(k + 1) % 3])];
      planes.push_back({std::min(a, b), std::max(a, b), e, static_cast<int>(k), a < b});
    }
  std::stable_sort(planes.begin(), planes.end(), [](const HalfPlane& p, const HalfPlane& q) {
    return std::tuple(p.low, p.high) < std::tuple(q.low, q.high);
  });
  return planes;
}

/// Sorts what meets at one edge by angle.
void sort_round(std::span<HalfPlane> fan, const SoundScene& scene, const ElementTable& elements) {
  const auto corners = elements.triangle(fan[0].element);
  const Vec3 edge = (corners[at((fan[0].start + 1) % 3)] - corners[at(fan[0].start)]).normalized();
  const Vec3 along = fan[0].runs_up ? edge : -edge;
  const auto away = [&](const HalfPlane& plane) {
    return Vec3((plane.runs_up ? 1 : -1) * elements.normal[at(plane.element)].cross(along));
  };
  const auto id = [&](const HalfPlane& plane) {
    return scene.surfaces[at(elements.surface[at(plane.element)])].plane;
  };
  const Vec3 x = away(fan[0]), y = along.cross(x);
  for (std::size_t k = 1; k < fan.size(); ++k) {
    const Vec3 d = away(fan[k]);
    const auto end = fan.begin() + static_cast<std::ptrdiff_t>(k);
    const auto covered = std::find_if(fan.begin(), end, [&](const HalfPlane& other) {
      return id(other) == id(fan[k]) && away(other).dot(d) > 0;
    });
    const double angle = std::atan2(d.dot(y), d.dot(x));
    fan[k].angle = covered != end ? covered->angle
                   : angle < 0    ? angle + 2 * std::numbers::pi
                                  : angle;
  }
  std::stable_sort(fan.begin(), fan.end(), [](const HalfPlane& p, const HalfPlane& q) {
    return std::tuple(p.angle, p.runs_up) < std::tuple(q.angle, q.runs_up);
  });
}

}  // namespace

Shells find_shells(const SoundScene& scene, const ElementTable& elements) {
  JoinedSets sides(2 * elements.count());
  std::vector<HalfPlane> planes = find_half_planes(elements);
  for (std::size_t first = 0, end = 0; first < planes.size(); first = end) {
    while (end < planes.size() && planes[end].low == planes[first].low &&
           planes[end].high == planes[first].high)
      ++end;
    const std::span fan(planes.data() + first, end - first);
    sort_round(fan, scene, elements);
    for (std::size_t i = 0; i < fan.size(); ++i)
      sides.join(fan[i].ahead(), fan[(i + 1) % fan.size()].behind());
  }
  Shells shells;
  const std::vector<int> shell = sides.numbered();
  for (std::size_t e = 0; e < elements.corners.size(); ++e)
    shells.of_side.push_back({shell[2 * e], shell[2 * e + 1]});
  for (const int s : shell) shells.count = std::max(shells.count, s + 1);
  return shells;
}

}  // namespace halfshade
