#include "meshing/events/events.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <array>
#include <cmath>

// Events of three edges. Where two of them lie in a plane the family of lines splits into two
// planar ones: those through the point where that plane meets the third edge are kept here, those
// through the two edges' common point are events with a vertex.

namespace halfshade {
namespace {

// How often spans are halved until one of them is nearer to the emitter than the other.
constexpr int most_halvings = 6;
// An edge is far from others where its coordinates are this many times as large.
constexpr double far_away = 1e3;

/// False only if the convex hull of four points misses that of the emitter.
bool hull_meets(const EmitterScene& emitter_scene, const std::array<Vec2, 4>& points) {
  const auto parts = [&](const Vec2& normal) {
    double low_a = HUGE_VAL, high_a = -HUGE_VAL, low_b = HUGE_VAL, high_b = -HUGE_VAL;
    for (const Vec2& p : points) {
      low_a = std::min(low_a, normal.dot(p));
      high_a = std::max(high_a, normal.dot(p));
    }
    for (const Vec2& p : emitter_scene.hull) {
      low_b = std::min(low_b, normal.dot(p));
      high_b = std::max(high_b, normal.dot(p));
    }
    const double slack = emitter_scene.slack * normal.norm();
    return low_a > high_b + slack || high_a < low_b - slack;
  };
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j) {
      const Vec2 along = points[j] - points[i];
      if (parts({along.y(), -along.x()})) return false;
    }
  for (std::size_t k = 0; k < emitter_scene.hull.size(); ++k) {
    const Vec2 along =
        emitter_scene.hull[(k + 1) % emitter_scene.hull.size()] - emitter_scene.hull[k];
    if (parts({along.y(), -along.x()})) return false;
  }
  return true;
}

/// Along the emitter's normal, from a place nearby: what is far from the emitter must not be
/// told apart by its height above it, which is rounded more coarsely.
struct Heights {
  double from, to;
  double low() const { return std::min(from, to); }
  double high() const { return std::max(from, to); }
};

Heights heights(const EmitterScene& emitter_scene, const Span3& span, const Vec3& base) {
  const Vec3& up = emitter_scene.frame.normal;
  return {up.dot(span.from - base), up.dot(span.to - base)};
}

/// Lines through spans of nearly the same height are too flat to reach the emitter.
bool is_too_flat(const EmitterScene& emitter_scene, const Span3& a, const Heights& ha,
                 const Span3& b, const Heights& hb) {
  const auto low = [&](const Span3& s) -> Vec2 {
    return emitter_scene.frame.to_plane(s.from).cwiseMin(emitter_scene.frame.to_plane(s.to));
  };
  const auto high = [&](const Span3& s) -> Vec2 {
    return emitter_scene.frame.to_plane(s.from).cwiseMax(emitter_scene.frame.to_plane(s.to));
  };
  const Vec2 gaps = (low(a) - high(b)).cwiseMax(low(b) - high(a)).cwiseMax(0);
  const double steepest = std::max(ha.high() - hb.low(), hb.high() - ha.low());
  double farthest = 0;
  for (const Vec2& corner : emitter_scene.hull)
    for (const Vec3& p : {a.from, a.to, b.from, b.to})
      farthest = std::max(farthest, (emitter_scene.frame.to_plane(p) - corner).norm());
  double nearest = HUGE_VAL;
  for (const Vec3& p : {a.from, a.to, b.from, b.to})
    nearest = std::min(nearest, emitter_scene.frame.height(p));
  return gaps.norm() * nearest > farthest * steepest;
}

bool lines_up(const EmitterScene& emitter_scene, const Span3& a, const Span3& b, int halvings) {
  const Heights ha = heights(emitter_scene, a, a.from), hb = heights(emitter_scene, b, a.from);
  const double slack = std::max(margins::slack_of(a), margins::slack_of(b));
  const auto images = [&](const Span3& near, const Span3& far) {
    std::array<Vec2, 4> points;
    std::size_t count = 0;
    for (const Vec3& p : {near.from, near.to})
      for (const Vec3& q : {far.from, far.to}) {
        const double drop = emitter_scene.frame.normal.dot(q - p);
        const double height = emitter_scene.frame.height(q);
        points[count++] = emitter_scene.frame.to_plane(q + height / drop * (p - q));
      }
    return points;
  };
  if (ha.high() < hb.low() - slack) return hull_meets(emitter_scene, images(a, b));
  if (hb.high() < ha.low() - slack) return hull_meets(emitter_scene, images(b, a));
  if (is_too_flat(emitter_scene, a, ha, b, hb)) return false;
  if (halvings == 0) return true;
  const auto halves = [](const Span3& s) {
    const Vec3 middle = s.at(0.5);
    return std::array<Span3, 2>{Span3{s.from, middle}, Span3{middle, s.to}};
  };
  if (ha.high() - ha.low() > hb.high() - hb.low()) {
    const auto parts = halves(a);
    return lines_up(emitter_scene, parts[0], b, halvings - 1) ||
           lines_up(emitter_scene, parts[1], b, halvings - 1);
  }
  const auto parts = halves(b);
  return lines_up(emitter_scene, a, parts[0], halvings - 1) ||
         lines_up(emitter_scene, a, parts[1], halvings - 1);
}

/// The same, by boxes first; `through_a` holds the lines from the emitter through the first span.
bool meet_and_line_up(const EmitterScene& emitter_scene, const LinesThrough& through_a,
                      const Span3& a, const Span3& b) {
  const auto may_meet = [](const LinesThrough& lines, const Span3& span) {
    return lines.may_meet(bounds_of(span.from, span.to), margins::slack_of(span));
  };
  return may_meet(through_a, b) && may_meet(emitter_scene.lines_through(b), a) &&
         lines_up(emitter_scene, a, b, most_halvings);
}

/// An edge, and what is closer to it than `joined` is meant to be on it.
struct EventEdge {
  Span3 span;
  double joined;
};

bool are_collinear(const EventEdge& a, const EventEdge& b) {
  const double joined = std::max(a.joined, b.joined);
  return distance_to_line(b.span.from, a.span) <= joined &&
         distance_to_line(b.span.to, a.span) <= joined;
}

/// The plane of two coplanar spans that are not collinear, as point and unit normal.
Vec3 common_normal(const Span3& a, const Span3& b) {
  const Vec3 by_directions = a.direction().cross(b.direction());
  const Vec3 by_from = a.direction().cross(b.from - a.from);
  const Vec3 by_to = a.direction().cross(b.to - a.from);
  const Vec3& widest = by_from.norm() > by_to.norm() ? by_from : by_to;
  // Parallel spans have no normal of their own; crossing ones may start in the same point.
  return (by_directions.norm() > widest.norm() ? by_directions : widest).normalized();
}

/// Whether the ends of both spans lie in one plane. Edges that were parallel before a file rounded
/// them must count, for the families of lines they make are as thin as that rounding.
bool are_coplanar(const EventEdge& a, const EventEdge& b) {
  if (b.joined < a.joined) return are_coplanar(b, a);
  if (are_collinear(a, b)) return true;
  const Vec3 normal = common_normal(a.span, b.span);
  // From the edge that is told more finely: it may be a small one near by, the other far away.
  const auto off = [&](const Vec3& p) { return std::abs(normal.dot(p - a.span.from)); };
  return off(a.span.to) <= a.joined && std::max(off(b.span.from), off(b.span.to)) <= b.joined;
}

/// Lines in the plane of two spans through the point where a third crosses it.
void coplanar_swath(Swath swath, const EventEdge& first, const EventEdge& second,
                    const Span3& third, const SwathSink& sink) {
  if (are_collinear(first, second)) return;
  const Span3 &base = first.span, &other = second.span;
  const Vec3 normal = common_normal(base, other);
  const Vec3& in_plane =
      (third.from - base.from).squaredNorm() < (third.from - other.from).squaredNorm() ? base.from
                                                                                       : other.from;
  const double a = normal.dot(third.from - in_plane), b = normal.dot(third.to - in_plane);
  const bool crosses =
      (a > 0) != (b > 0) && std::max(std::abs(a), std::abs(b)) > margins::slack_of(third);
  if (!crosses) return;
  swath.is_planar = true;
  swath.may_be_first_order = true;
  swath.source.kind = CurveKind::face;
  swath.apex = third.at(a / (a - b));
  swath.base = base;
  swath.second = other;
  if (distance_to_line(swath.apex, base) >
      std::max(margins::slack_of(third), margins::slack_of(base)))
    sink(swath);
}

/// Lines through the point where two spans cross, if they do so other than at their ends, and a
/// third span.
void crossing_swath(Swath swath, const Span3& a, const Span3& b, const Span3& third,
                    const SwathSink& sink) {
  const Vec3 u = a.direction(), v = b.direction(), normal = u.cross(v);
  if (!(normal.norm() > margins::parallel_sine * u.norm() * v.norm())) return;
  const double s = (b.from - a.from).cross(v).dot(normal) / normal.squaredNorm();
  const double t = (b.from - a.from).cross(u).dot(normal) / normal.squaredNorm();
  if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) return;
  swath.apex = a.at(s);
  const double slack = margins::slack_at(swath.apex);
  if (is_end(swath.apex, a, slack) && is_end(swath.apex, b, slack)) return;  // events with a vertex
  if (distance_to_line(swath.apex, third) <= std::max(slack, margins::slack_of(third))) return;
  swath.is_planar = true;
  swath.base = third;
  sink(swath);
}

/// Sends the swath through three spans, in whatever shape it has.
void send(Swath& swath, const std::array<EventEdge, 3>& edges, const SwathSink& sink) {
  bool splits = false;
  for (const auto& [i, j, k] : {std::array{0, 1, 2}, std::array{1, 2, 0}, std::array{2, 0, 1}})
    if (const Span3& third = edges[at(k)].span; are_coplanar(edges[at(i)], edges[at(j)])) {
      splits = true;
      coplanar_swath(swath, edges[at(i)], edges[at(j)], third, sink);
      crossing_swath(swath, edges[at(i)].span, edges[at(j)].span, third, sink);
    }
  if (splits) return;
  std::array<Span3, 3> spans = {edges[0].span, edges[1].span, edges[2].span};
  // Points of the family are counted from the first edge: not one that is far from the others.
  if (margins::slack_of(spans[0]) > far_away * margins::slack_of(spans[1]))
    std::swap(spans[0], spans[1]);
  set_edges(swath, spans);
  sink(swath);
}

}  // namespace

bool may_line_up(const EmitterScene& emitter_scene, const Span3& a, const Span3& b) {
  return meet_and_line_up(emitter_scene, emitter_scene.lines_through(a), a, b);
}

std::vector<int> later_partners(const EmitterScene& emitter_scene, int edge) {
  std::vector<int> partners;
  const Span3& span = emitter_scene.edges[at(edge)].front;
  const LinesThrough lines = emitter_scene.lines_through(span);
  visit_reached(
      emitter_scene.edge_tree, [&](const Bounds& box) { return lines.may_meet(box, 0); },
      [&](int other) {
        if (other > edge &&
            meet_and_line_up(emitter_scene, lines, span, emitter_scene.edges[at(other)].front))
          partners.push_back(other);
      });
  std::sort(partners.begin(), partners.end());
  return partners;
}

void pair_swaths(const EmitterScene& emitter_scene, int a, int b, const SwathSink& sink) {
  const SilhouetteEdge &first = emitter_scene.edges[at(a)], &second = emitter_scene.edges[at(b)];
  for (const OutlinePiece& piece : emitter_scene.outline) {
    Swath swath;
    swath.source = {
        CurveKind::eee,
        {piece.feature, {Feature::Kind::edge, first.id}, {Feature::Kind::edge, second.id}},
        3};
    swath.group = {piece.id, EdgeId::edge(first.id), EdgeId::edge(second.id)};
    std::sort(swath.group.begin(), swath.group.end());
    swath.silhouettes = {a, b, -1};
    swath.ends_on_outline = true;
    send(swath,
         {EventEdge{piece.span, emitter_scene.joined}, EventEdge{first.front, first.joined},
          EventEdge{second.front, second.joined}},
         sink);
  }
}

void triple_swath(const EmitterScene& emitter_scene, int a, int b, int c, const SwathSink& sink) {
  Swath swath;
  swath.source.kind = CurveKind::eee;
  swath.source.feature_count = 3;
  std::array<EventEdge, 3> edges;
  std::size_t k = 0;
  for (const int e : {a, b, c}) {
    const SilhouetteEdge& edge = emitter_scene.edges[at(e)];
    const EdgeId id = EdgeId::edge(edge.id);
    swath.source.features[k] = feature_of(id);
    swath.group.push_back(id);
    edges[k++] = {edge.front, edge.joined};
  }
  std::sort(swath.group.begin(), swath.group.end());
  swath.silhouettes = {a, b, c};
  send(swath, edges, sink);
}

}  // namespace halfshade
