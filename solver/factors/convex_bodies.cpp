#include "solver/factors/convex_bodies.h"

#include "meshing/backprojection/opaque_topology.h"
#include "meshing/core/plane_frame.h"
#include "meshing/geometry/link.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace halfshade {
namespace {

struct Use {
  int surface;
  Link along;
};

/// Surfaces that hang together by edges, as trees.
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

class BodyFinder {
 public:
  BodyFinder(const SoundScene& scene, const OpaqueTopology& topology)
      : scene_(scene), topology_(topology), parts_(scene.surfaces.size()) {
    // Backs lie on fronts, which are there.
    for (int s = 0; s < static_cast<int>(scene.surfaces.size()); ++s)
      if (!scene.surfaces[at(s)].back) add_uses(s);
    for (const auto& [edge, uses] : uses_)
      for (const Use& use : uses) parts_.join(use.surface, uses.front().surface);
  }

  ConvexBodies run() {
    ConvexBodies result;
    result.of.assign(scene_.surfaces.size(), -1);
    std::map<int, std::vector<int>> members;
    for (int s = 0; s < static_cast<int>(scene_.surfaces.size()); ++s)
      if (!scene_.surfaces[at(s)].back) members[parts_.root(s)].push_back(s);
    for (const auto& [root, surfaces] : members) {
      ConvexBody body;
      if (surfaces.size() < 4 || !make(surfaces, body)) continue;
      for (const int s : surfaces) result.of[at(s)] = static_cast<int>(result.bodies.size());
      result.bodies.push_back(std::move(body));
    }
    return result;
  }

 private:
  void add_uses(int s) {
    const auto& surface = topology_.surfaces[at(s)];
    for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r) {
      const auto ring = topology_.ring(r);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const Link along = {ring[k].vertex, ring[(k + 1) % ring.size()].vertex};
        uses_[sorted_link(along[0], along[1])].push_back({s, along});
      }
    }
  }

  bool make(const std::vector<int>& surfaces, ConvexBody& body) const {
    std::map<int, int> vertices;
    std::map<int, int> side_of;
    double size = 0;
    for (const int s : surfaces) {
      const auto& surface = topology_.surfaces[at(s)];
      if (surface.ring_count != 1) return false;
      side_of[s] = static_cast<int>(body.sides.size());
      body.sides.push_back({surface.frame.origin, surface.frame.normal});
      size = std::max(size, surface.tolerance.length);
      for (const auto& corner : topology_.ring(surface.first_ring)) {
        const auto [entry, is_new] =
            vertices.emplace(corner.vertex, static_cast<int>(body.vertices.size()));
        if (is_new) body.vertices.push_back(topology_.vertices[at(corner.vertex)]);
      }
    }
    for (const ConvexBody::Side& side : body.sides)
      for (const Vec3& p : body.vertices)
        if (side.normal.dot(p - side.corner) > size) return false;
    for (const int s : surfaces) {
      const auto ring = topology_.ring(topology_.surfaces[at(s)].first_ring);
      for (std::size_t k = 0; k < ring.size(); ++k) {
        const int from = ring[k].vertex, to = ring[(k + 1) % ring.size()].vertex;
        const auto& uses = uses_.at(sorted_link(from, to));
        // Twice, in opposite directions: closed, for all that is convex.
        if (uses.size() != 2 || uses[0].along == uses[1].along) return false;
        const Use& other = uses[0].surface == s ? uses[1] : uses[0];
        if (other.surface == s) return false;
        if (from < to)
          body.edges.push_back(
              {{vertices.at(from), vertices.at(to)}, {side_of.at(s), side_of.at(other.surface)}});
      }
    }
    body.ball = ball_round(body.vertices);
    body.low = body.high = body.vertices.front();
    for (const Vec3& p : body.vertices) {
      body.low = body.low.cwiseMin(p);
      body.high = body.high.cwiseMax(p);
    }
    body.width = HUGE_VAL;
    for (const ConvexBody::Side& side : body.sides) {
      double deepest = 0;
      for (const Vec3& p : body.vertices)
        deepest = std::max(deepest, side.normal.dot(side.corner - p));
      body.width = std::min(body.width, deepest);
    }
    return true;
  }

  const SoundScene& scene_;
  const OpaqueTopology& topology_;
  Parts parts_;
  std::map<Link, std::vector<Use>> uses_;
};

/// From points this near to the plane of a side, relative to their distance, it is seen edge-on:
/// not at all.
constexpr double edge_on_side = 1e-12;

/// What of a surface lies in a closed body.
enum class Within { nothing, some, all };

Within within(const ConvexBody& body, const std::vector<std::vector<Vec3>>& pieces) {
  constexpr double rounding = 1e-12;  // relative to the largest coordinate
  const double near = rounding * (body.ball.centre.norm() + body.ball.radius);
  const auto all_lie = [&](const std::vector<Vec3>& polygon, const ConvexBody::Side& side,
                           double sign) {
    return std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& p) {
      return sign * side.normal.dot(p - side.corner) > -near;
    });
  };
  bool is_any = false, is_all = true;
  for (const std::vector<Vec3>& piece : pieces) {
    const bool is_inside = std::all_of(body.sides.begin(), body.sides.end(),
                                       [&](const auto& side) { return all_lie(piece, side, -1); });
    is_all = is_all && is_inside;
    const bool is_outside = std::any_of(body.sides.begin(), body.sides.end(), [&](const auto& s) {
      return all_lie(piece, s, 1) && !all_lie(piece, s, -1);
    });
    if (is_outside) continue;
    std::vector<Vec3> rest = piece;
    for (const ConvexBody::Side& side : body.sides)
      if (!rest.empty() && !all_lie(rest, side, -1))
        rest = clip_to_front(rest, side.corner, -side.normal);
    is_any = is_any || !rest.empty();
  }
  return !is_any ? Within::nothing : is_all ? Within::all : Within::some;
}

}  // namespace

Ball ball_round(std::span<const Vec3> points) {
  Ball ball;
  for (const Vec3& p : points) ball.centre += p / static_cast<double>(points.size());
  for (const Vec3& p : points) ball.radius = std::max(ball.radius, (p - ball.centre).norm());
  return ball;
}

void find_fronts(const ConvexBody& body, const Vec3& point, std::vector<char>& is_front) {
  is_front.clear();
  for (const ConvexBody::Side& side : body.sides) {
    const Vec3 towards = point - side.corner;
    is_front.push_back(side.normal.dot(towards) > edge_on_side * towards.lpNorm<1>());
  }
}

void find_silhouette(const ConvexBody& body, const Vec3& point, Silhouette& silhouette) {
  find_fronts(body, point, silhouette.is_front);
  silhouette.edges.clear();
  for (std::size_t k = 0; k < body.edges.size(); ++k) {
    const auto& [ends, sides] = body.edges[k];
    const bool left = silhouette.is_front[at(sides[0])], right = silhouette.is_front[at(sides[1])];
    if (left == right) continue;
    const Vec3 &from = body.vertices[at(ends[left ? 0 : 1])],
               &to = body.vertices[at(ends[left ? 1 : 0])];
    silhouette.edges.push_back(
        {(from - point).cross(to - from), to, static_cast<std::uint32_t>(k)});
  }
}

ConvexBodies find_convex_bodies(const SoundScene& scene, const OpaqueScene& opaque) {
  return BodyFinder(scene, opaque.topology()).run();
}

bool is_within_sight(const ConvexBody& body, const std::vector<std::vector<Vec3>>& looking,
                     const std::vector<std::vector<Vec3>>& seen) {
  const Within own = within(body, looking);
  if (own == Within::nothing) return false;
  const Within other = within(body, seen);
  return own == Within::all ? other != Within::all : other != Within::nothing;
}

}  // namespace halfshade
