#include "meshing/repair/coplanar.h"

#include "meshing/arrangement/overlay.h"
#include "meshing/core/planar.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

namespace halfshade {
namespace {

// Corners of merged boundaries closer than this part of the radius of points to the line of their
// neighbours are no corners but what rounding left.
constexpr double straightness = 1e-3;

// True for polygons that turn left at every corner and once round: those need no overlay.
bool convex(const std::vector<Vec2>& polygon) {
  double turned = 0;
  const std::size_t n = polygon.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vec2 in = polygon[(k + 1) % n] - polygon[k];
    const Vec2 out = polygon[(k + 2) % n] - polygon[(k + 1) % n];
    const double turn = std::atan2(cross_2d(in, out), in.dot(out));
    if (turn <= 0) return false;
    turned += turn;
  }
  return turned < 3 * std::numbers::pi;
}

class Resolver {
 public:
  Resolver(std::vector<Vec3>& points, const PlaneFrame& frame,
           const std::vector<CoplanarFace>& faces)
      : points_(points), frame_(frame), faces_(faces), snap_(snap_radii(faces)) {}

  CoplanarResult run() {
    if (faces_.size() == 1) {
      std::vector<Vec2> polygon;
      for (const int p : faces_[0].loop) polygon.push_back(frame_.to_plane(points_[at(p)]));
      if (polygon.size() == 3 || convex(polygon)) {
        add_draft(0, {faces_[0].loop}, {0});
        return std::move(result_);
      }
    }
    make_overlay();
    // Of a triangle that snapping turned over nothing is left.
    for (const int loop : crossed_loops(overlay_, snap_.links))
      if (faces_[at(loop)].loop.size() > 3) result_.crossed.push_back(faces_[at(loop)].face);
    if (!result_.crossed.empty()) return std::move(result_);
    const std::vector<int> winner = winners();
    std::vector<int> labels;
    for (const int w : winner) labels.push_back(w < 0 ? -1 : bucket_of(w));
    for (const OverlayRegion& region : regions(overlay_, labels)) draft(region);
    return std::move(result_);
  }

 private:
  static SnapRadii snap_radii(const std::vector<CoplanarFace>& faces) {
    LocalScale scale = faces[0].scale;
    for (const CoplanarFace& face : faces) scale = joint_scale(scale, face.scale);
    const LocalTolerance tolerance = tolerance_of(scale);
    return {tolerance.length, tolerance.planarity};
  }

  void make_overlay() {
    std::map<int, int> local;
    std::vector<Vec2> flat;
    std::vector<std::vector<int>> loops;
    for (const CoplanarFace& face : faces_) {
      loops.emplace_back();
      for (const int p : face.loop) {
        const auto [entry, is_new] = local.emplace(p, static_cast<int>(flat.size()));
        if (is_new) {
          flat.push_back(frame_.to_plane(points_[at(p)]));
          ids_.push_back(p);
        }
        loops.back().push_back(entry->second);
      }
    }
    overlay_ = overlay(std::move(flat), loops, snap_);
    for (std::size_t k = ids_.size(); k < overlay_.points.size(); ++k) {
      ids_.push_back(static_cast<int>(points_.size()));
      points_.push_back(frame_.to_space(overlay_.points[k]));
    }
  }

  auto rank(int f) const {
    const CoplanarFace& face = faces_[at(f)];
    return std::tuple(!face.emits, face.area, face.face, face.back);
  }

  // Numbered by first face.
  int bucket_of(int f) {
    const CoplanarFace& face = faces_[at(f)];
    const auto key = std::tuple(face.material, face.group, face.paint, face.back);
    return buckets_.emplace(key, static_cast<int>(buckets_.size())).first->second;
  }

  // Which face each triangle of the overlay belongs to; −1: none.
  std::vector<int> winners() {
    std::vector<int> winner;
    std::map<std::pair<int, int>, double> covered;
    for (std::size_t t = 0; t < overlay_.winding.size(); ++t) {
      int best = -1;
      for (const auto& [f, w] : overlay_.winding[t])
        if (w > 0 && (best < 0 || rank(f) < rank(best))) best = f;
      winner.push_back(best);
      for (const auto& [f, w] : overlay_.winding[t])
        if (best >= 0 && bucket_of(f) != bucket_of(best))
          covered[{best, f}] += 0.5 * twice_area(overlay_.points, overlay_.hull.triangles[t]);
    }
    for (const auto& [pair, area] : covered) {
      const CoplanarFace &keeper = faces_[at(pair.first)], &loser = faces_[at(pair.second)];
      result_.covered.push_back({keeper.face, loser.face, keeper.back && loser.back, area});
    }
    return winner;
  }

  void draft(const OverlayRegion& region) {
    std::set<int> members;
    for (const int t : region.triangles)
      for (const auto& [f, w] : overlay_.winding[at(t)])
        if (w > 0 && bucket_of(f) == region.label) members.insert(f);
    std::map<int, int> visits;
    for (const auto& ring : region.rings)
      for (const int p : ring) ++visits[p];
    std::vector<std::vector<int>> rings;
    for (const auto& ring : region.rings) {
      rings.emplace_back();
      for (const int p : without_straight_corners(ring, visits))
        rings.back().push_back(ids_[at(p)]);
    }
    // What is thinner than the snap distance everywhere may lose all its corners.
    if (rings[0].size() < 3) return;
    std::erase_if(rings, [](const auto& ring) { return ring.size() < 3; });
    add_draft(*members.begin(), std::move(rings), {members.begin(), members.end()});
  }

  std::vector<int> without_straight_corners(const std::vector<int>& ring,
                                            const std::map<int, int>& visits) const {
    std::vector<int> kept;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const int before = kept.empty() ? ring.back() : kept.back();
      const int after = ring[(k + 1) % ring.size()];
      const Vec2 in = overlay_.points[at(ring[k])] - overlay_.points[at(before)];
      const Vec2 out = overlay_.points[at(after)] - overlay_.points[at(ring[k])];
      const bool straight = in.dot(out) > 0 && std::abs(cross_2d(in, out)) <=
                                                   straightness * snap_.points * (in + out).norm();
      if (!straight || visits.at(ring[k]) > 1) kept.push_back(ring[k]);
    }
    return kept;
  }

  void add_draft(int first, std::vector<std::vector<int>> rings, const std::vector<int>& members) {
    const CoplanarFace& face = faces_[at(first)];
    SurfaceDraft draft;
    draft.frame = frame_;
    draft.material = face.material;
    draft.group = face.group;
    draft.paint = face.paint;
    draft.back = face.back;
    draft.rings = std::move(rings);
    std::vector<Vec3> corners;
    for (const int p : draft.rings[0]) corners.push_back(points_[at(p)]);
    draft.scale = face.scale;
    draft.scale.size = scale_of(corners).size;
    for (const int m : members) {
      draft.faces.push_back(faces_[at(m)].face);
      draft.face_rings.push_back(faces_[at(m)].loop);
    }
    result_.drafts.push_back(std::move(draft));
  }

  std::vector<Vec3>& points_;
  const PlaneFrame& frame_;
  const std::vector<CoplanarFace>& faces_;
  SnapRadii snap_;
  Overlay overlay_;
  std::vector<int> ids_;  // point of the overlay → point of the scene
  std::map<std::tuple<int, int, int, bool>, int> buckets_;
  CoplanarResult result_;
};

}  // namespace

CoplanarResult resolve_coplanar(std::vector<Vec3>& points, const PlaneFrame& frame,
                                const std::vector<CoplanarFace>& faces) {
  return Resolver(points, frame, faces).run();
}

}  // namespace halfshade
