#include "io/read/light_receivers.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/core/planar.h"
#include "meshing/core/plane_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <queue>
#include <span>

namespace halfshade::reading {
namespace {

constexpr std::size_t most_lamps = 256, most_cells = 768;
/// Of a size: what lies so little before a plane lies in it.
constexpr double in_plane = 1e-9;

struct Lamp {
  std::vector<Vec3> corners, reverse;  ///< `reverse` of what shines on its back, too
  Vec3 middle, normal;
  double area, radius;
  Rgb exitance;
};

Lamp make_lamp(const Scene& scene, const ShiningFace& from) {
  Lamp lamp;
  lamp.corners = face_corners(scene, from.face);
  lamp.exitance = from.exitance;
  const Vec3 area = area_vector(lamp.corners);
  lamp.area = area.norm();
  lamp.normal = area / lamp.area;
  lamp.middle = fit_plane(lamp.corners).origin;
  lamp.radius = 0;
  for (const Vec3& p : lamp.corners) lamp.radius = std::max(lamp.radius, (p - lamp.middle).norm());
  if (scene.materials[at(scene.faces[at(from.face)].material)].two_sided)
    lamp.reverse.assign(lamp.corners.rbegin(), lamp.corners.rend());
  return lamp;
}

std::vector<Lamp> lamps_of(const Scene& scene, const std::vector<ShiningFace>& first) {
  std::vector<char> is_known(scene.faces.size(), 0);
  std::vector<Lamp> lamps, others;
  const auto has_area = [](const Lamp& lamp) { return lamp.area > 0; };
  for (const ShiningFace& face : first) {
    is_known[at(face.face)] = 1;
    lamps.push_back(make_lamp(scene, face));
  }
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    const Rgb& exitance = scene.materials[at(scene.faces[f].material)].exitance;
    if (!is_known[f] && (exitance > 0).any())
      others.push_back(make_lamp(scene, {static_cast<int>(f), exitance}));
  }
  std::stable_sort(others.begin(), others.end(), [](const Lamp& a, const Lamp& b) {
    return a.area * a.exitance.sum() > b.area * b.exitance.sum();
  });
  lamps.insert(lamps.end(), others.begin(), others.end());
  lamps.erase(std::remove_if(lamps.begin(), lamps.end(), std::not_fn(has_area)), lamps.end());
  if (lamps.size() > most_lamps) lamps.resize(most_lamps);
  return lamps;
}

/// A side of a face.
struct Side {
  std::vector<Vec2> ring;
  PlaneFrame frame;
  double sign;  ///< −1: the back
};

/// A rectangle in a side's plane.
struct Cell {
  double most;  ///< about the most ∫ H² can be over it
  std::size_t side;
  Vec2 low, high;

  double area() const { return (high - low).prod(); }
  bool operator<(const Cell& other) const { return most < other.most; }
};

class Sampling {
 public:
  Sampling(const Scene& scene, const std::vector<ShiningFace>& first)
      : lamps_(lamps_of(scene, first)) {
    for (std::size_t f = 0; f < scene.faces.size(); ++f) {
      const std::vector<Vec3> corners = face_corners(scene, static_cast<int>(f));
      if (!(area_vector(corners).norm() > 0)) continue;
      add_side(corners, 1);
      if (scene.materials[at(scene.faces[f].material)].two_sided) add_side(corners, -1);
    }
  }

  LightReceivers run() {
    while (!cells_.empty() && cells_.size() < most_cells) {
      const Cell cell = cells_.top();
      cells_.pop();
      const int axis = cell.high.x() - cell.low.x() >= cell.high.y() - cell.low.y() ? 0 : 1;
      Vec2 low = cell.low, high = cell.high;
      low[axis] = high[axis] = 0.5 * (cell.low[axis] + cell.high[axis]);
      add_cell(cell.side, cell.low, high);
      add_cell(cell.side, low, cell.high);
    }
    // A scene of many faces has many that hardly matter.
    LightReceivers result;
    for (std::size_t k = 0; k < most_cells && !cells_.empty(); ++k, cells_.pop())
      add_point(cells_.top(), result);
    result.norm = std::sqrt(result.norm);
    return result;
  }

 private:
  void add_side(const std::vector<Vec3>& corners, double sign) {
    Side side{{}, fit_plane(corners), sign};
    Vec2 low = Vec2::Constant(HUGE_VAL), high = -low;
    for (const Vec3& p : corners) {
      side.ring.push_back(side.frame.to_plane(p));
      low = low.cwiseMin(side.ring.back());
      high = high.cwiseMax(side.ring.back());
    }
    sides_.push_back(std::move(side));
    add_cell(sides_.size() - 1, low, high);
  }

  void add_cell(std::size_t side, const Vec2& low, const Vec2& high) {
    Cell cell{0, side, low, high};
    const double light = most_light(cell);
    cell.most = cell.area() * light * light;
    if (cell.most > 0) cells_.push(cell);
  }

  double most_light(const Cell& cell) const {
    const Side& side = sides_[cell.side];
    const Vec3 middle = side.frame.to_space(0.5 * (cell.low + cell.high));
    const Vec3 normal = side.sign * side.frame.normal;
    const double radius = 0.5 * (cell.high - cell.low).norm();
    const std::array<Vec2, 4> at_plane = {cell.low, Vec2(cell.high.x(), cell.low.y()), cell.high,
                                          Vec2(cell.low.x(), cell.high.y())};
    double light = 0;
    for (const Lamp& lamp : lamps_) {
      const double least = in_plane * (lamp.radius + radius);
      const bool is_above =
          std::any_of(lamp.corners.begin(), lamp.corners.end(),
                      [&](const Vec3& p) { return normal.dot(p - middle) > least; });
      const bool is_before = std::any_of(at_plane.begin(), at_plane.end(), [&](const Vec2& q) {
        const double height = lamp.normal.dot(side.frame.to_space(q) - lamp.middle);
        return (lamp.reverse.empty() ? height : std::abs(height)) > least;
      });
      if (!is_above || !is_before) continue;
      const double distance = std::max(0., (middle - lamp.middle).norm() - radius);
      light +=
          lamp.exitance.sum() * lamp.area / (std::numbers::pi * distance * distance + lamp.area);
    }
    return light;
  }

  void add_point(const Cell& cell, LightReceivers& result) const {
    const Side& side = sides_[cell.side];
    const Vec2 middle = 0.5 * (cell.low + cell.high);
    if (!is_inside({&side.ring, 1}, middle)) return;
    const LightReceiver point{side.frame.to_space(middle), side.sign * side.frame.normal,
                              cell.area()};
    Rgb light = Rgb::Zero();
    for (const Lamp& lamp : lamps_) {
      double factor = unobstructed_factor(point.position, point.normal, {&lamp.corners, 1});
      if (!lamp.reverse.empty())
        factor += unobstructed_factor(point.position, point.normal, {&lamp.reverse, 1});
      light += factor * lamp.exitance;
    }
    if (!(light > 0).any()) return;
    result.points.push_back(point);
    result.norm += point.area * light.square().sum();
  }

  std::vector<Lamp> lamps_;
  std::vector<Side> sides_;
  std::priority_queue<Cell> cells_;
};

}  // namespace

LightReceivers light_receivers(const Scene& scene, const std::vector<ShiningFace>& first) {
  return Sampling(scene, first).run();
}

}  // namespace halfshade::reading
