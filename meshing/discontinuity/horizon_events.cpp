#include "meshing/discontinuity/horizon_events.h"

#include "meshing/core/planar.h"
#include "meshing/discontinuity/margins.h"
#include "meshing/discontinuity/search_budget.h"
#include "meshing/discontinuity/stretches.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace halfshade {
namespace {

/// Where a span leaves a plane upwards; nothing if none of it is above, or none below or in it.
std::optional<Vec3> foot(const Span3& span, const PlaneFrame& plane, double slack) {
  const double a = plane.height(span.from), b = plane.height(span.to);
  if (std::max(a, b) <= slack || std::min(a, b) > slack) return std::nullopt;
  if (std::abs(a) <= slack) return span.from;
  if (std::abs(b) <= slack) return span.to;
  return span.at(a / (a - b));
}

/// Whether all of a receiver is on one side of a line.
bool line_misses(const Surface& receiver, const Vec2& origin, const Vec2& along) {
  const Ring& outer = receiver.rings[0];
  const auto is_left = [&](const Vec2& p) { return cross_2d(along, p - origin) > 0; };
  return std::all_of(outer.begin(), outer.end(), is_left) ||
         std::none_of(outer.begin(), outer.end(), is_left);
}

/// Cuts stretches of a line in a receiver behind its origin where contacts cross it: something
/// stands there.
std::vector<std::array<double, 2>> pieces_behind(const Surface& receiver, const Vec2& origin,
                                                 const Vec2& along) {
  std::vector<double> cuts;
  for (const Segment2& contact : receiver.contacts) {
    const double a = cross_2d(along, contact[0] - origin), b = cross_2d(along, contact[1] - origin);
    if ((a > 0) == (b > 0)) continue;
    const Vec2 crossing = contact[0] + a / (a - b) * (contact[1] - contact[0]);
    cuts.push_back(along.dot(crossing - origin) / along.squaredNorm());
  }
  std::sort(cuts.begin(), cuts.end());
  std::vector<std::array<double, 2>> pieces;
  for (const auto& [begin, end] : stretches(receiver, origin, along)) {
    double from = std::max(begin, 0.);
    for (const double cut : cuts)
      if (cut > from && cut < end) {
        pieces.push_back({from, cut});
        from = cut;
      }
    if (from < end) pieces.push_back({from, end});
  }
  return pieces;
}

}  // namespace

HorizonSearch::HorizonSearch(const SoundScene& scene, const OpaqueScene& opaque,
                             const EmitterScene& emitter_scene)
    : scene_(scene),
      opaque_(opaque.topology()),
      emitter_scene_(emitter_scene),
      decider_(opaque, emitter_scene) {}

double HorizonSearch::work() const {
  return SearchBudget::of_test * static_cast<double>(tests_) + work_of(decider_.effort());
}

bool HorizonSearch::is_cut(int receiver) const {
  if (receiver == emitter_scene_.emitter) return false;
  const PlaneFrame& plane = scene_.surfaces[at(receiver)].frame;
  bool above = false, below = false;
  for (const OutlinePoint& corner : emitter_scene_.corners) {
    const double height = plane.height(corner.position);
    above = above || height > emitter_scene_.joined;
    below = below || height < -emitter_scene_.joined;
  }
  return above && below;
}

std::vector<HorizonSearch::Post> HorizonSearch::posts_on_emitter(const Surface& receiver) const {
  std::vector<Post> posts;
  for (const OutlinePiece& piece : emitter_scene_.outline) {
    const std::optional<Vec3> position = foot(piece.span, receiver.frame, emitter_scene_.joined);
    if (!position) continue;
    const auto same = std::find_if(posts.begin(), posts.end(), [&](const Post& post) {
      return (post.position - *position).norm() <= emitter_scene_.joined;
    });
    if (same != posts.end())
      same->edges.push_back(piece.id);
    else
      posts.push_back({*position, {piece.id}, {}, piece.feature, emitter_scene_.joined});
  }
  return posts;
}

std::vector<HorizonSearch::Post> HorizonSearch::posts_of_scene(const Surface& receiver) const {
  std::vector<Post> posts;
  std::vector<std::pair<int, std::size_t>> at_vertex;  // of the opaque scene → post
  for (std::size_t e = 0; e < emitter_scene_.edges.size(); ++e) {
    const SilhouetteEdge& edge = emitter_scene_.edges[e];
    const double joined = std::max(edge.joined, margins::slack_of(edge.front));
    const std::optional<Vec3> position = foot(edge.front, receiver.frame, joined);
    if (!position) continue;
    const EdgeId id = EdgeId::edge(edge.id);
    const auto& ends = opaque_.edges[at(edge.id)];
    const int vertex = *position == opaque_.vertices[at(ends.from)] ? ends.from
                       : *position == opaque_.vertices[at(ends.to)] ? ends.to
                                                                    : -1;
    const auto same = std::find_if(at_vertex.begin(), at_vertex.end(), [&](const auto& entry) {
      return vertex >= 0 && entry.first == vertex;
    });
    if (same != at_vertex.end()) {
      posts[same->second].edges.push_back(id);
      posts[same->second].silhouettes.push_back(static_cast<int>(e));
      continue;
    }
    if (vertex >= 0) at_vertex.emplace_back(vertex, posts.size());
    const Feature feature = vertex >= 0 ? Feature{Feature::Kind::vertex, vertex}
                                        : Feature{Feature::Kind::edge, edge.id};
    posts.push_back({*position, {id}, {static_cast<int>(e)}, feature, joined});
  }
  return posts;
}

bool HorizonSearch::may_hide(const Post& post, const Vec3& direction) const {
  return std::any_of(post.silhouettes.begin(), post.silhouettes.end(), [&](int e) {
    return emitter_scene_.may_be_silhouette(emitter_scene_.edges[at(e)], direction);
  });
}

/// Where the line through two posts comes from the emitter; false if it does not, or if the far one
/// is nearer to the emitter.
bool HorizonSearch::find_start(const Post& near, const Post& far, Vec3& start) const {
  const double a = emitter_scene_.frame.height(near.position);
  const double b = emitter_scene_.frame.height(far.position);
  if (near.silhouettes.empty()) {
    start = near.position;
    return b > far.joined;
  }
  if (!(a > near.joined && b - a > margins::grazing_sine * (far.position - near.position).norm()))
    return false;
  start = near.position - a / (b - a) * (far.position - near.position);
  return emitter_scene_.contains(start);
}

bool HorizonSearch::add_curves(int receiver, double most_work,
                               std::vector<DiscontinuityCurve>& curves) {
  if (!is_cut(receiver)) return true;
  const Surface& target = scene_.surfaces[at(receiver)];
  const double before = work();
  const std::vector<Post> lights = posts_on_emitter(target), posts = posts_of_scene(target);
  tests_ += emitter_scene_.edges.size();
  for (const Post& far : posts) {
    const Vec2 origin = target.frame.to_plane(far.position);
    for (const auto* list : {&lights, &posts}) {
      tests_ += list->size();
      if (work() - before > most_work) return false;
      for (const Post& near : *list) {
        const Vec2 along = origin - target.frame.to_plane(near.position);
        if (along.norm() <= std::max(near.joined, far.joined) || line_misses(target, origin, along))
          continue;
        Vec3 start;
        if (!find_start(near, far, start)) continue;
        const Vec3 direction = (far.position - start).normalized();
        if (!may_hide(far, direction) || (!near.silhouettes.empty() && !may_hide(near, direction)))
          continue;
        add_alignment(receiver, {&near, &far, start}, curves);
      }
    }
  }
  return true;
}

void HorizonSearch::add_alignment(int receiver, const Alignment& line,
                                  std::vector<DiscontinuityCurve>& curves) {
  const Surface& target = scene_.surfaces[at(receiver)];
  const Vec2 origin = target.frame.to_plane(line.far->position);
  const Vec2 along = (origin - target.frame.to_plane(line.start)).normalized();
  const Vec3 direction = along.x() * target.frame.e1 + along.y() * target.frame.e2;
  std::vector<EdgeId> group = {EdgeId::horizon()};
  for (const Post* post : {line.near, line.far})
    group.insert(group.end(), post->edges.begin(), post->edges.end());
  std::sort(group.begin(), group.end());
  group.erase(std::unique(group.begin(), group.end()), group.end());
  for (const auto& [from, to] : pieces_behind(target, origin, along)) {
    const Vec3 middle = target.frame.to_space(origin + 0.5 * (from + to) * along);
    const double step =
        side_step(target, emitter_scene_, {line.start, line.far->position, direction}, middle);
    if (to - from < margins::least_steps * step) continue;
    const ReceivingPoint here{middle, target.frame.normal, target.frame.normal.cross(direction)};
    EventEvidence evidence = decider_.decide(here, step, group);
    if (!evidence.differs) continue;
    DiscontinuityCurve curve;
    curve.receiver = receiver;
    curve.emitter = emitter_scene_.emitter;
    curve.kind = CurveKind::horizon;
    curve.order = 3;
    curve.step = step;
    curve.arc = straight_arc(origin + from * along, origin + to * along);
    curve.sight_plane = target.frame.normal;
    curve.triples = std::move(evidence.triples);
    curve.sources = {{CurveKind::horizon,
                      {line.near->feature, line.far->feature, {Feature::Kind::face, receiver}},
                      3}};
    curves.push_back(std::move(curve));
  }
}

}  // namespace halfshade
