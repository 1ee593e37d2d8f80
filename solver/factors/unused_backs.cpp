#include "solver/factors/unused_backs.h"

#include "meshing/arrangement/overlay.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace halfshade {
namespace {

Surface back_of(const Surface& front) {
  Surface back = front;
  back.back = true;
  back.frame = {front.frame.origin, front.frame.e1, -front.frame.e2, -front.frame.normal};
  const auto turn = [](std::vector<Ring>& rings) {
    for (Ring& ring : rings) {
      std::reverse(ring.begin(), ring.end());
      for (Vec2& p : ring) p.y() = -p.y();
    }
  };
  turn(back.rings);
  turn(back.face_rings);
  for (Segment2& line : back.contacts)
    for (Vec2& p : line) p.y() = -p.y();
  return back;
}

/// Of a surface, in the frame of another.
Eigen::AlignedBox2d box_in(const PlaneFrame& frame, const Surface& surface) {
  Eigen::AlignedBox2d box;
  for (const Vec2& p : surface.rings.front()) box.extend(frame.to_plane(surface.frame.to_space(p)));
  return box;
}

/// A surface and those that lie on its back, laid over each other.
class CoveredBack {
 public:
  explicit CoveredBack(const Surface& front)
      : front_(front), box_(box_in(front.frame, front)), tolerance_(tolerance_of(front)) {
    add(front);
  }

  void cover_with(const Surface& other) {
    const LocalTolerance tolerance = tolerance_of(front_, other);
    const Eigen::AlignedBox2d common = box_.intersection(box_in(front_.frame, other));
    if ((common.sizes().array() <= tolerance.planarity).any()) return;
    tolerance_.length = std::max(tolerance_.length, tolerance.length);
    tolerance_.planarity = std::max(tolerance_.planarity, tolerance.planarity);
    add(other);
  }

  /// What is not covered, as surfaces that look as the front does.
  std::vector<Surface> rest() const {
    if (loops_.size() == front_.rings.size()) return {front_};
    const Overlay parts = overlay(points_, loops_, {tolerance_.length, tolerance_.planarity});
    std::vector<int> labels;
    for (const auto& winding : parts.winding) labels.push_back(is_bare(winding) ? 0 : -1);
    std::vector<Surface> surfaces;
    for (const OverlayRegion& region : regions(parts, labels)) {
      if (is_sliver(parts, region)) continue;
      surfaces.push_back(front_);
      surfaces.back().rings.clear();
      for (const std::vector<int>& ring : region.rings) {
        surfaces.back().rings.emplace_back();
        for (const int p : ring) surfaces.back().rings.back().push_back(parts.points[at(p)]);
      }
      surfaces.back().scale.size = size_of(surfaces.back());
    }
    return surfaces;
  }

 private:
  void add(const Surface& surface) {
    const bool is_front = &surface == &front_;  // whose corners others share to the bit
    for (const Ring& ring : surface.rings) {
      loops_.emplace_back(ring.size());
      std::iota(loops_.back().begin(), loops_.back().end(), static_cast<int>(points_.size()));
      for (const Vec2& p : ring)
        points_.push_back(is_front ? p : front_.frame.to_plane(surface.frame.to_space(p)));
    }
  }

  /// Inside of the front, and of nothing else: holes wind the other way.
  bool is_bare(const std::vector<std::pair<int, int>>& winding) const {
    int of_front = 0, of_others = 0;
    for (const auto& [loop, turns] : winding)
      (loop < static_cast<int>(front_.rings.size()) ? of_front : of_others) += turns;
    return of_front != 0 && of_others == 0;
  }

  /// Narrower than what counts as nothing.
  bool is_sliver(const Overlay& parts, const OverlayRegion& region) const {
    double area = 0, length = 0;
    for (const std::vector<int>& ring : region.rings) {
      area += twice_area(parts.points, ring) / 2;
      for (std::size_t k = 0; k < ring.size(); ++k)
        length +=
            (parts.points[at(ring[k])] - parts.points[at(ring[(k + 1) % ring.size()])]).norm();
    }
    return area <= tolerance_.planarity * length;
  }

  const Surface& front_;
  Eigen::AlignedBox2d box_;
  LocalTolerance tolerance_;
  std::vector<Vec2> points_;
  std::vector<std::vector<int>> loops_;
};

}  // namespace

std::vector<Surface> uncovered_backs(const SoundScene& scene, const std::vector<bool>& has_back) {
  std::map<int, std::vector<const Surface*>> in_plane;
  for (const Surface& surface : scene.surfaces) in_plane[surface.plane].push_back(&surface);
  std::vector<Surface> backs;
  for (std::size_t s = 0; s < scene.surfaces.size(); ++s) {
    if (!has_back[s]) continue;
    const Surface& front = scene.surfaces[s];
    CoveredBack covered(front);
    for (const Surface* other : in_plane[front.plane])
      if (other->frame.normal.dot(front.frame.normal) < 0) covered.cover_with(*other);
    for (const Surface& part : covered.rest()) backs.push_back(back_of(part));
  }
  return backs;
}

}  // namespace halfshade
