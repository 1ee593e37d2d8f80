#include "solver/factors/convex_bodies.h"

#include "meshing/core/plane_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace halfshade {
namespace {

/// From points this near to the plane of a side, relative to their distance, it is seen edge-on:
/// not at all.
constexpr double edge_on_side = 1e-12;

/// What of a surface lies in a closed body.
enum class Within { nothing, some, all };

Within within(const ConvexBody& body, const std::vector<std::vector<Vec3>>& pieces) {
  const double near = rounding_of(body);
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

bool looks_in_at_open_side(const ConvexBody& body, const FlatSurface& surface) {
  const double near = rounding_of(body);
  const auto lies_on = [&](const ConvexBody::Side& side) {
    const auto is_on = [&](const Vec3& p) {
      return std::abs(side.normal.dot(p - side.corner)) <= near;
    };
    return side.normal.dot(surface.normal) < 0 &&
           std::all_of(surface.pieces.begin(), surface.pieces.end(), [&](const auto& piece) {
             return std::all_of(piece.begin(), piece.end(), is_on);
           });
  };
  return std::any_of(body.sides.end() - static_cast<std::ptrdiff_t>(body.open_sides),
                     body.sides.end(), lies_on);
}

}  // namespace

double rounding_of(const ConvexBody& body) {
  constexpr double rounding = 1e-12;  // relative to the largest coordinate
  return rounding * (body.ball.centre.norm() + body.ball.radius);
}

bool reaches_into(const ConvexBody& body, const FlatSurface& surface) {
  return within(body, surface.pieces) != Within::nothing;
}

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

bool lies_outside(const ConvexBody& body, std::span<const Vec3> polygon) {
  const double rounding = rounding_of(body);
  for (std::size_t k = 0; k < body.sides.size(); ++k) {
    const bool is_open = k + body.open_sides >= body.sides.size();
    const auto is_beyond = [&](const Vec3& p) {
      const double height = body.sides[k].normal.dot(p - body.sides[k].corner);
      return height > (is_open ? -rounding : rounding);
    };
    if (std::all_of(polygon.begin(), polygon.end(), is_beyond)) return true;
  }
  return false;
}

bool is_within_sight(const ConvexBody& body, const FlatSurface& looking, const FlatSurface& seen) {
  const Within own = within(body, looking.pieces);
  if (own == Within::nothing && body.open_sides == 0) return false;
  const Within other = within(body, seen.pieces);
  if (body.open_sides == 0)
    return own == Within::all ? other != Within::all : other != Within::nothing;
  if (own == Within::nothing && other == Within::nothing) return false;
  if (own != Within::nothing && other != Within::nothing) return true;
  return !looks_in_at_open_side(body, own != Within::nothing ? looking : seen);
}

}  // namespace halfshade
