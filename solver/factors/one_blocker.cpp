#include "solver/factors/one_blocker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

namespace halfshade {
namespace {

/// Clearly before (1) or behind (−1) the plane of a blocker, or neither.
int side_of(const Blocker& blocker, std::span<const Vec3> polygon, double margin) {
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const Vec3& p : polygon) {
    const double height = blocker.normal.dot(p - blocker.corners.front());
    least = std::min(least, height);
    most = std::max(most, height);
  }
  return least > margin ? 1 : most < -margin ? -1 : 0;
}

/// Whether every line from a corner of one to a corner of the other passes through the blocker: so
/// do all lines between them then, for what a point sees of a plane through a convex polygon is
/// convex, from either end.
bool hides_all(const Blocker& blocker, std::span<const Vec3> part, std::span<const Vec3> other) {
  const auto& corners = blocker.corners;
  const double margin =
      tolerance_of(scale_of(corners)).length + tolerance_of(scale_of(part)).length;
  const int side = side_of(blocker, part, margin);
  if (side == 0 || side_of(blocker, other, margin) != -side) return false;
  for (const Vec3& p : part)
    for (std::size_t k = 0; k < corners.size(); ++k) {
      // The plane through p and an edge, as seen from where the blocker is counter-clockwise.
      const Vec3 out = (corners[k] - p).cross(corners[(k + 1) % corners.size()] - p) * side;
      for (const Vec3& q : other)
        if (!(out.dot(q - p) < 0)) return false;
    }
  return true;
}

/// What balls tell of that, if anything.
std::optional<bool> passes_balls(const ConvexBody& body, const Vec3& from, const Vec3& to) {
  constexpr double clearly = 1e-6;
  const double outer2 = body.ball.radius * body.ball.radius;
  const double inner = (1 - clearly) * body.inner;
  const Vec3 along = to - from, towards = body.ball.centre - from;
  const double part = std::clamp(along.dot(towards) / along.squaredNorm(), 0., 1.);
  const double distance2 = (towards - part * along).squaredNorm();
  if (distance2 > outer2) return false;
  const bool are_outside =
      towards.squaredNorm() > outer2 && (body.ball.centre - to).squaredNorm() > outer2;
  if (are_outside && inner > 0 && distance2 < inner * inner) return true;
  return {};
}

/// Whether a segment passes through a body, not only along it.
bool passes(const ConvexBody& body, const Vec3& from, const Vec3& to) {
  if (const auto told = passes_balls(body, from, to)) return *told;
  // What is shorter than this, relative to the segment, may be rounding.
  constexpr double touching = 1e-9;
  double enter = 0, leave = 1;
  for (const ConvexBody::Side& side : body.sides) {
    const double a = side.normal.dot(from - side.corner), b = side.normal.dot(to - side.corner);
    if (a > 0 && b > 0) return false;
    if (a > 0) enter = std::max(enter, a / (a - b));
    if (b > 0) leave = std::min(leave, a / (a - b));
    if (!(leave - enter > touching)) return false;
  }
  return enter > 0 && leave < 1;
}

/// The same of a body: what it hides from a point is convex, too. But into an open one points look
/// past its sides.
bool hides_all(const ConvexBody& body, std::span<const Vec3> part, std::span<const Vec3> other) {
  if (body.open_sides > 0 && !(lies_outside(body, part) && lies_outside(body, other))) return false;
  for (const Vec3& p : part)
    for (const Vec3& q : other)
      if (!passes(body, p, q)) return false;
  return true;
}

/// With more in between, one thing that hides all is rather found for smaller parts.
constexpr std::size_t most_things = 64;

/// Bodies and polygons that some triangles are parts of, each once; no more than are looked at, and
/// one. A body is −1 less its number.
std::vector<int> things_of(const SightScene& scene, const Between& triangles) {
  std::vector<int> things;
  for (const int t : triangles) {
    const int blocker = scene.blocker_of[at(t)], body = scene.blockers[at(blocker)].body;
    const int thing = body >= 0 ? -1 - body : blocker;
    if (std::find(things.rbegin(), things.rend(), thing) == things.rend()) things.push_back(thing);
    if (things.size() > most_things) break;
  }
  return things;
}

}  // namespace

bool hides_all(const SightScene& scene, const Between& triangles, std::span<const Vec3> part,
               std::span<const Vec3> other) {
  const std::vector<int> things = things_of(scene, triangles);
  if (things.size() > most_things) return false;
  return std::any_of(things.begin(), things.end(), [&](int thing) {
    return thing < 0 ? hides_all(scene.bodies[at(-1 - thing)], part, other)
                     : hides_all(scene.blockers[at(thing)], part, other);
  });
}

bool are_all_beside(const SightScene& scene, const Between& triangles, std::span<const Vec3> part,
                    std::span<const Vec3> other) {
  constexpr std::size_t most = 24;
  if (triangles.size() > most) return false;
  const TriangleSoup& soup = scene.between.soup();
  std::uint32_t left = (std::uint32_t{1} << triangles.size()) - 1;
  int last = -1;
  for (std::size_t i = 0; i < triangles.size() && left != 0; ++i) {
    const int id = scene.blocker_of[at(triangles[i])];
    if (id == last) continue;
    last = id;
    const Blocker& blocker = scene.blockers[at(id)];
    double least = HUGE_VAL, most_high = -HUGE_VAL;
    for (const auto& polygon : {part, other})
      for (const Vec3& p : polygon) {
        const double height = blocker.normal.dot(p - blocker.corners.front());
        least = std::min(least, height);
        most_high = std::max(most_high, height);
      }
    if (least < 0 && most_high > 0) continue;
    for (std::size_t k = 0; k < triangles.size(); ++k) {
      if ((left >> k & 1) == 0) continue;
      const auto is_beside = [&](int corner) {
        const double height = blocker.normal.dot(soup.points[at(corner)] - blocker.corners.front());
        return least >= 0 ? height <= blocker.rounding : height >= -blocker.rounding;
      };
      const auto& corners = soup.triangles[at(triangles[k])];
      if (std::all_of(corners.begin(), corners.end(), is_beside)) left &= ~(std::uint32_t{1} << k);
    }
  }
  return left == 0;
}

}  // namespace halfshade
