#include "solver/factors/body_search.h"

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/core/planar.h"
#include "meshing/core/plane_frame.h"
#include "meshing/geometry/link.h"
#include "meshing/triangulation/ring_triangles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

namespace halfshade {
namespace {

/// A cap is covered if all of it is but for this share.
constexpr double share_of_rounding = 1e-9;

struct Use {
  int surface;
  Link along;
};

/// Surfaces that hang together by ridges, as trees.
class Parts {
 public:
  explicit Parts(std::size_t count) : above_(count) { std::iota(above_.begin(), above_.end(), 0); }

  int root(int s) {
    while (above_[at(s)] != s) s = above_[at(s)] = above_[at(above_[at(s)])];
    return s;
  }
  void join(int a, int b) { above_[at(std::max(root(a), root(b)))] = std::min(root(a), root(b)); }

 private:
  std::vector<int> above_;
};

/// A convex polygon that closes an open side, counter-clockwise from outside.
struct Cap {
  std::vector<int> vertices;  ///< of the topology
  ConvexBody::Side side;
};

class BodyFinder {
 public:
  BodyFinder(const SoundScene& scene, const OpaqueTopology& topology)
      : scene_(scene), topology_(topology), parts_(scene.surfaces.size()) {
    // Backs lie on fronts, which are there.
    for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s)
      if (!scene.surfaces[at(s)].back) add_uses(s);
    for (const auto& [edge, uses] : uses_)
      if (is_ridge(uses)) parts_.join(uses[0].surface, uses[1].surface);
  }

  ConvexBodies run() {
    ConvexBodies result;
    result.of.assign(scene_.surfaces.size(), -1);
    std::map<int, std::vector<int>> members;
    for (int s = 0; s < static_cast<int>(scene_.surfaces.size()); ++s)
      if (!scene_.surfaces[at(s)].back) members[parts_.root(s)].push_back(s);
    for (const auto& [root, surfaces] : members) {
      if (surfaces.size() < 3) continue;
      const std::optional<ConvexBody> body = make(surfaces);
      if (!body) continue;
      for (const int s : surfaces) result.of[at(s)] = static_cast<int>(result.bodies.size());
      result.bodies.push_back(*body);
    }
    return result;
  }

 private:
  template <class UseLink>
  void for_each_link(int s, UseLink use) const {
    const auto& surface = topology_.surfaces[at(s)];
    for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r) {
      const auto ring = topology_.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k)
        use(Link{ring[k].vertex, ring[(k + 1) % ring.size()].vertex});
    }
  }

  void add_uses(int s) {
    for_each_link(s, [&](const Link& along) {
      uses_[sorted_link(along[0], along[1])].push_back({s, along});
    });
  }

  bool is_behind(int s, int other) const {
    const auto& surface = topology_.surfaces[at(s)];
    bool is_behind = true;
    for_each_link(other, [&](const Link& along) {
      is_behind = is_behind && surface.frame.height(topology_.vertices[at(along[0])]) <=
                                   surface.tolerance.length;
    });
    return is_behind;
  }

  /// Two surfaces that run along it in opposite directions, each behind the other one.
  bool is_ridge(const std::vector<Use>& uses) const {
    return uses.size() == 2 && uses[0].surface != uses[1].surface &&
           uses[0].along != uses[1].along && is_behind(uses[0].surface, uses[1].surface) &&
           is_behind(uses[1].surface, uses[0].surface);
  }

  /// What closes a convex shell where its surfaces run along nothing of it. Nothing if that is not
  /// a loop, or several.
  /// `left` tells the next vertex along a cap.
  std::optional<std::vector<Cap>> find_caps(std::map<int, int> left, double near) const {
    std::vector<Cap> caps;
    while (!left.empty()) {
      Cap& cap = caps.emplace_back();
      std::vector<Vec3> corners;
      const int first = left.begin()->first;
      for (int v = first; cap.vertices.empty() || v != first;) {
        const auto next = left.find(v);
        if (next == left.end()) return {};
        cap.vertices.push_back(v);
        corners.push_back(topology_.vertices[at(v)]);
        v = next->second;
        left.erase(next);
      }
      const Vec3 area = area_vector(corners);
      if (!(area.norm() > 0)) return {};
      cap.side = {corners.front(), area.normalized()};
      if (!lie_on(cap.side, corners, near)) return {};
    }
    return caps;
  }

  static bool lie_on(const ConvexBody::Side& plane, const std::vector<Vec3>& points, double near) {
    return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
      return std::abs(plane.normal.dot(p - plane.corner)) <= near;
    });
  }

  /// Whether one surface lies on all of a cap.
  bool is_covered(const Cap& cap, double near) const {
    std::vector<Vec3> corners;
    for (const int v : cap.vertices) corners.push_back(topology_.vertices[at(v)]);
    const double whole = area_vector(corners).norm();
    return std::any_of(scene_.surfaces.begin(), scene_.surfaces.end(), [&](const Surface& surface) {
      return !surface.back && lie_on({surface.frame.origin, surface.frame.normal}, corners, near) &&
             covered_area(corners, surface) >= (1 - share_of_rounding) * whole;
    });
  }

  static double covered_area(const std::vector<Vec3>& corners, const Surface& surface) {
    std::vector<Vec3> points;
    for (const Ring& ring : surface.rings)
      for (const Vec2& p : ring) points.push_back(surface.frame.to_space(p));
    double covered = 0;
    for (const auto& triangle : ring_triangles(surface.rings)) {
      std::vector<Vec3> rest = corners;
      for (std::size_t k = 0; k < 3 && !rest.empty(); ++k) {
        const Vec3 &from = points[at(triangle[k])], &to = points[at(triangle[(k + 1) % 3])];
        rest = clip_to_front(rest, from, surface.frame.normal.cross(to - from));
      }
      if (!rest.empty()) covered += area_vector(rest).norm();
    }
    return covered;
  }

  /// Where vertices of the topology, and surfaces, are in a body.
  struct Numbers {
    std::map<int, int> vertex, side;
  };

  /// As an open side.
  void add(const Cap& cap, const Numbers& numbers, ConvexBody& body) const {
    const int side = static_cast<int>(body.sides.size());
    body.sides.push_back(cap.side);
    ++body.open_sides;
    for (std::size_t k = 0; k < cap.vertices.size(); ++k) {
      const int from = cap.vertices[k], to = cap.vertices[(k + 1) % cap.vertices.size()];
      const auto& uses = uses_.at(sorted_link(from, to));
      const auto own = std::find_if(uses.begin(), uses.end(), [&](const Use& use) {
        return numbers.side.contains(use.surface) && use.along == Link{to, from};
      });
      body.edges.push_back({{numbers.vertex.at(from), numbers.vertex.at(to)},
                            {side, numbers.side.at(own->surface)}});
    }
  }

  std::optional<ConvexBody> make(const std::vector<int>& surfaces) const {
    ConvexBody body;
    Numbers numbers;
    double near = 0;
    for (const int s : surfaces) {
      const auto& surface = topology_.surfaces[at(s)];
      if (surface.ring_count != 1) return {};
      numbers.side[s] = static_cast<int>(body.sides.size());
      body.sides.push_back({surface.frame.origin, surface.frame.normal});
      near = std::max(near, surface.tolerance.length);
      for_each_link(s, [&](const Link& along) {
        const auto [entry, is_new] =
            numbers.vertex.emplace(along[0], static_cast<int>(body.vertices.size()));
        if (is_new) body.vertices.push_back(topology_.vertices[at(along[0])]);
      });
    }
    std::map<int, int> open;
    bool is_simple = true;
    for (const int s : surfaces)
      for_each_link(s, [&](const Link& along) {
        const auto& uses = uses_.at(sorted_link(along[0], along[1]));
        if (!is_ridge(uses)) {
          is_simple = is_simple && open.emplace(along[1], along[0]).second;
        } else if (along[0] < along[1]) {
          const Use& other = uses[0].surface == s ? uses[1] : uses[0];
          body.edges.push_back({{numbers.vertex.at(along[0]), numbers.vertex.at(along[1])},
                                {numbers.side.at(s), numbers.side.at(other.surface)}});
        }
      });
    const auto caps = find_caps(std::move(open), near);
    if (!is_simple || !caps || caps->size() > 2) return {};
    for (const Cap& cap : *caps) {
      if (caps->size() > 1 && !is_covered(cap, near)) return {};
      add(cap, numbers, body);
    }
    if (body.sides.size() < 4) return {};
    for (const ConvexBody::Side& side : body.sides)
      for (const Vec3& p : body.vertices)
        if (side.normal.dot(p - side.corner) > near) return {};
    measure(body);
    // Coplanar surfaces have each other behind them, whatever their outline.
    if (!(body.width > near)) return {};
    return body;
  }

  static void measure(ConvexBody& body) {
    body.ball = ball_round(body.vertices);
    body.low = body.high = body.vertices.front();
    for (const Vec3& p : body.vertices) {
      body.low = body.low.cwiseMin(p);
      body.high = body.high.cwiseMax(p);
    }
    body.width = body.inner = HUGE_VAL;
    for (const ConvexBody::Side& side : body.sides) {
      body.inner = std::min(body.inner, side.normal.dot(side.corner - body.ball.centre));
      double deepest = 0;
      for (const Vec3& p : body.vertices)
        deepest = std::max(deepest, side.normal.dot(side.corner - p));
      body.width = std::min(body.width, deepest);
    }
  }

  const SoundScene& scene_;
  const OpaqueTopology& topology_;
  Parts parts_;
  std::map<Link, std::vector<Use>> uses_;
};

}  // namespace

ConvexBodies find_convex_bodies(const SoundScene& scene, const OpaqueScene& opaque) {
  return BodyFinder(scene, opaque.topology()).run();
}

}  // namespace halfshade
