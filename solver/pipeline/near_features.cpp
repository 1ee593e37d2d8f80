#include "solver/pipeline/near_features.h"

#include "meshing/geometry/flat_tree.h"
#include "solver/pipeline/surface_finder.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace halfshade {
namespace {

/// Corners and edges as far from a surface as this share of their lengths are not near.
constexpr double nearest_corner = 0.25, nearest_edge = 0.1;
/// By how much an edge may rise over a surface, as a share of its length.
constexpr double steepest = 0.3;
/// Of lengths below which points of a surface are one: features nearer than that are.
constexpr double alike = 100;
/// Of each kind.
constexpr std::size_t most_features = 20000;

class Finder {
 public:
  explicit Finder(const SoundScene& scene) : scene_(scene) {
    std::vector<Bounds> boxes;
    for (const Surface& surface : scene.surfaces) boxes.push_back(outline_bounds(surface));
    tree_ = make_flat_tree(boxes);
  }

  void look_at(int id) {
    const Surface& surface = scene_.surfaces[at(id)];
    for (const Ring& ring : surface.rings)
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec3 before = surface.frame.to_space(ring[(k + ring.size() - 1) % ring.size()]);
        const Vec3 here = surface.frame.to_space(ring[k]);
        const Vec3 next = surface.frame.to_space(ring[(k + 1) % ring.size()]);
        look_at_corner(surface, here, std::min((here - before).norm(), (next - here).norm()));
        look_at_edge(surface, {here, next});
      }
  }

  Watched found;

 private:
  template <class Visit>
  void visit_near(const Surface& own, const Bounds& box, Visit&& visit) {
    visit_overlaps(tree_, box, [&](int other) {
      if (const Surface& surface = scene_.surfaces[at(other)]; surface.plane != own.plane)
        visit(other, surface.frame, tolerance_of(own, surface).length);
    });
  }

  void look_at_corner(const Surface& own, const Vec3& corner, double length) {
    Bounds box;
    box.include(corner);
    const double reach = nearest_corner * length;
    visit_near(own, box.grown(reach), [&](int other, const PlaneFrame& plane, double tiny) {
      const double height = plane.height(corner);
      if (height < -tiny || height > reach || found.corners.size() >= most_features) return;
      const Vec3 foot = corner - height * plane.normal;
      if (is_new(other, foot, foot))
        found.corners.push_back({other, foot, height > tiny ? height : 0});
    });
  }

  void look_at_edge(const Surface& own, const std::array<Vec3, 2>& edge) {
    Bounds box;
    for (const Vec3& end : edge) box.include(end);
    const double length = (edge[1] - edge[0]).norm(), reach = nearest_edge * length;
    visit_near(own, box.grown(reach), [&](int other, const PlaneFrame& plane, double tiny) {
      WatchedEdge near{other, edge, {}};
      for (std::size_t k = 0; k < 2; ++k) {
        const double height = plane.height(edge[k]);
        if (height < -tiny) return;
        near.feet[k] -= height * plane.normal;
        near.height[k] = height > tiny ? height : 0;
      }
      const auto [low, high] = std::minmax(near.height[0], near.height[1]);
      if (low > reach || high == 0 || high - low > steepest * length) return;
      if (near.feet[1].x() < near.feet[0].x()) {
        std::swap(near.feet[0], near.feet[1]);
        std::swap(near.height[0], near.height[1]);
      }
      if (found.edges.size() < most_features && is_new(other, near.feet[0], near.feet[1]))
        found.edges.push_back(near);
    });
  }

  /// Faces that share edges and corners tell of each but once.
  bool is_new(int surface, const Vec3& a, const Vec3& b) {
    const double apart = alike * tolerance_of(scene_.surfaces[at(surface)]).length;
    std::array<long long, 7> key{surface};
    for (int k = 0; k < 3; ++k) {
      key[at(1 + k)] = std::llround(a[k] / apart);
      key[at(4 + k)] = std::llround(b[k] / apart);
    }
    return known_.insert(key).second;
  }

  const SoundScene& scene_;
  FlatTree tree_;
  std::set<std::array<long long, 7>> known_;
};

}  // namespace

Watched near_features(const SoundScene& scene, std::span<const int> sources,
                      std::span<const int> blockers) {
  Finder finder(scene);
  std::vector<int> ids(sources.begin(), sources.end());
  ids.insert(ids.end(), blockers.begin(), blockers.end());
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (const int id : ids) finder.look_at(id);
  return std::move(finder.found);
}

}  // namespace halfshade
