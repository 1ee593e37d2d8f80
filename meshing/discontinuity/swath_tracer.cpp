#include "meshing/discontinuity/swath_tracer.h"

#include "meshing/core/planar.h"
#include "meshing/discontinuity/event_evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace halfshade {
namespace {

// A line passes a triangle clearly if it stays this share of the triangle away from its border and
// this sine away from its plane.
constexpr double clearly_inside = 1e-7;
constexpr double clearly_across = 1e-9;
// Side steps, relative to the scene's size and to a rounding of the largest coordinate.
constexpr double relative_step = 1e-9;
constexpr double roundings_per_step = 1e4;
// What is hidden counts from 1e-15 of the emitter's area on, so that corners are seen to be cut off
// only at some distance; what lies closer together is told apart by the narrow step.
constexpr double wide_step = 300;
// One line of a piece decides for all, so that less than the limit must count.
constexpr double least_share_of_limit = 0.25;
// Edges shorter than this share of the scene's size call for the narrow step.
constexpr double fine_detail = 1e-4;
// Pieces of swath shorter than this many side steps on the receiver cannot be decided.
constexpr double least_steps = 4;
// How often a conic may be halved before it is made of arcs that turn little.
constexpr int most_halvings = 6;
// Arcs this flat, in side steps, are straight.
constexpr double straight_enough = 0.1;
// Lines whose hulls are searched for edges at once.
constexpr int hulls_per_swath = 4;

/// Skips by boxes.
template <class Skip, class Visit>
void walk(const FlatTree& tree, Skip&& skip, Visit&& visit) {
  walk_tree(
      tree, [&](int index) { return skip(tree.nodes[at(index)].box); }, visit);
}

/// Whether a ray misses a box that is enlarged by `slack`.
class RayBoxTest {
 public:
  RayBoxTest(const SightLine& line, double slack)
      : origin_(line.start), inverse_(line.direction.cwiseInverse()), slack_(slack) {}

  bool misses(const Bounds& box) const {
    double near = -slack_, far = HUGE_VAL;
    for (Eigen::Index k = 0; k < 3; ++k) {
      double a = (box.low[k] - slack_ - origin_[k]) * inverse_[k];
      double b = (box.high[k] + slack_ - origin_[k]) * inverse_[k];
      if (std::isnan(a) || std::isnan(b)) continue;  // along a face of the box
      if (a > b) std::swap(a, b);
      near = std::max(near, a);
      far = std::min(far, b);
    }
    return near > far;
  }

 private:
  Vec3 origin_, inverse_;
  double slack_;
};

}  // namespace

double side_step(const SoundScene& scene, const OpaqueScene& opaque) {
  return std::max(
      relative_step * scene.tolerance.scene_size,
      roundings_per_step * std::numeric_limits<double>::epsilon() * opaque.topology().magnitude);
}

/// A piece of curve on a receiver that may go on.
struct SwathTracer::Open {
  int receiver;
  double t0, t1;
  std::vector<EdgeTriple> triples;
};

SwathTracer::SwathTracer(const SoundScene& scene, const OpaqueScene& opaque,
                         const EmitterStage& stage, const TraceLimits& limits)
    : scene_(scene),
      opaque_(opaque.topology()),
      silhouette_trees_(opaque.silhouette_trees()),
      face_tree_(opaque.face_tree()),
      stage_(stage),
      limits_(limits),
      finder_(opaque),
      step_(side_step(scene, opaque)) {
  const double fine = fine_detail * scene.tolerance.scene_size;
  for (const StageEdge& edge : stage.edges)
    has_fine_detail_ = has_fine_detail_ || edge.whole.direction().norm() < fine;
  for (const OutlinePiece& piece : stage.outline)
    has_fine_detail_ = has_fine_detail_ || piece.span.direction().norm() < fine;
  for (const auto& edge : opaque_.edges) {
    const auto surface_of = [&](int i) {
      return opaque_.triangles[at(opaque_.incidences[at(edge.first + i)].triangle)].surface;
    };
    is_inner_.push_back(edge.count == 2 && surface_of(0) == surface_of(1));
  }
  for (std::size_t r = 0; r < scene.surfaces.size(); ++r) {
    const Surface& receiver = scene.surfaces[r];
    receiver_size_.push_back(size_of(receiver));
    for (const Segment2& contact : receiver.contacts)
      contacts_.push_back(
          {receiver.frame.to_space(contact[0]), receiver.frame.to_space(contact[1])});
    if (!receiver.back) continue;
    if (at(receiver.plane) >= backs_.size()) backs_.resize(at(receiver.plane) + 1);
    backs_[at(receiver.plane)].push_back(static_cast<int>(r));
  }
  std::vector<Bounds> boxes;
  for (const Span3& contact : contacts_)
    boxes.push_back({contact.from.cwiseMin(contact.to), contact.from.cwiseMax(contact.to)});
  contact_tree_ = make_flat_tree(boxes);
}

/// Adds the parameters between t0 and t1 at which the swath's line meets an edge.
void SwathTracer::cut(const Swath& swath, double t0, double t1) {
  const double slack = scene_.tolerance.length;
  const SwathHull hull = hull_of(swath, t0, t1);
  const auto skip = [&](const Bounds& box) {
    return stage_.frame.normal.dot(0.5 * (box.low + box.high) - stage_.frame.origin) <
               -stage_.frame.normal.cwiseAbs().dot(0.5 * (box.high - box.low)) - slack ||
           !hull.meets(box.low, box.high, slack);
  };
  std::vector<double> found;
  const auto consider = [&](const Span3& span) {
    if (hull.meets(span.from.cwiseMin(span.to), span.from.cwiseMax(span.to), slack))
      critical_parameters(swath, span, slack, found);
  };
  const auto visit = [&](int e) {
    if (is_inner_[at(e)]) return;
    const auto& edge = opaque_.edges[at(e)];
    consider({opaque_.vertices[at(edge.from)], opaque_.vertices[at(edge.to)]});
  };
  walk(silhouette_trees_.closed_edges, skip, visit);
  walk(silhouette_trees_.open_edges, skip, visit);
  // Where surfaces cut each other there is no edge, but what blocks the line changes, too.
  walk(contact_tree_, skip, [&](int c) { consider(contacts_[at(c)]); });
  for (const double t : found)
    if (t >= t0 && t <= t1) parameters_.push_back(t);
}

/// Where the faces at the edges that make the swath turn from one side to the other.
void SwathTracer::add_silhouette_limits(const Swath& swath, std::vector<double>& parameters) const {
  const auto add = [&](int e) {
    const StageEdge& edge = stage_.edges[at(e)];
    for (int f = edge.first_face; f < edge.first_face + edge.face_count; ++f)
      grazing_parameters(swath, stage_.faces[at(f)].normal, parameters);
  };
  for (const int e : swath.silhouettes)
    if (e >= 0) add(e);
  if (swath.corner >= 0)
    for (const int e : stage_.vertices[at(swath.corner)].edges) add(e);
}

void SwathTracer::trace(const Swath& swath, std::vector<DiscontinuityCurve>& curves) {
  ++counts_.swaths;
  std::vector<double> coarse = {0, 1};
  if (!swath.is_planar) own_limits(swath, coarse);
  for (const OutlinePiece& piece : stage_.outline)
    critical_parameters(swath, piece.span, scene_.tolerance.length, coarse);
  add_silhouette_limits(swath, coarse);
  std::sort(coarse.begin(), coarse.end());
  std::vector<Open> open;
  for (std::size_t i = 1; i < coarse.size(); ++i) {
    const double t0 = coarse[i - 1], t1 = coarse[i];
    if (!(t1 > t0)) continue;
    const auto line = line_at(swath, stage_.frame, 0.5 * (t0 + t1));
    if (!line || !(swath.ends_on_outline || stage_.contains(line->start)) ||
        !may_be_event(swath, *line))
      continue;
    parameters_.assign({t0, t1});
    const int hulls = static_cast<int>(std::ceil(hulls_per_swath * (t1 - t0)));
    for (int h = 0; h < hulls; ++h)
      cut(swath, t0 + h * (t1 - t0) / hulls, t0 + (h + 1) * (t1 - t0) / hulls);
    std::sort(parameters_.begin(), parameters_.end());
    for (std::size_t k = 1; k < parameters_.size(); ++k)
      if (parameters_[k] > parameters_[k - 1])
        trace_piece(swath, parameters_[k - 1], parameters_[k], open);
  }
  for (const Open& piece : open) finish(swath, piece, curves);
}

void SwathTracer::trace_piece(const Swath& swath, double t0, double t1, std::vector<Open>& open) {
  const auto line = line_at(swath, stage_.frame, 0.5 * (t0 + t1));
  if (!line) return;
  ++counts_.pieces;
  find_crossings(*line);
  collect_receivers(*line);
  for (const int receiver : reached_) try_receiver(swath, *line, receiver, t0, t1, open);
}

bool SwathTracer::may_be_event(const Swath& swath, const SightLine& line) const {
  const auto may_be = [&](int e) {
    return stage_.may_be_silhouette(stage_.edges[at(e)], line.direction);
  };
  for (const int e : swath.silhouettes)
    if (e >= 0 && !may_be(e)) return false;
  if (swath.corner < 0) return true;
  const std::vector<int>& edges = stage_.vertices[at(swath.corner)].edges;
  return std::count_if(edges.begin(), edges.end(), may_be) >= 2;
}

void SwathTracer::find_crossings(const SightLine& line) {
  crossings_.clear();
  const double slack = scene_.tolerance.length;
  const RayBoxTest ray(line, slack);
  walk(
      face_tree_, [&](const Bounds& box) { return ray.misses(box); },
      [&](int t) {
        const auto& corner = opaque_.triangles[at(t)].corner;
        const Vec3 a = opaque_.vertices[at(corner[0])] - line.start;
        const Vec3 b = opaque_.vertices[at(corner[1])] - line.start;
        const Vec3 c = opaque_.vertices[at(corner[2])] - line.start;
        const Vec3 normal = (b - a).cross(c - a);
        const double across = normal.dot(line.direction), size = normal.norm();
        if (!(std::abs(across) > clearly_across * size)) return;
        const double u = b.cross(c).dot(line.direction) / across;
        const double v = c.cross(a).dot(line.direction) / across;
        const double least = std::min({u, v, 1 - u - v});
        if (least < -clearly_inside) return;
        crossings_.push_back({normal.dot(a) / across, t, least > clearly_inside});
      });
  std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.triangle < b.triangle;
  });
}

/// The surfaces that the line may end on, if nothing clearly blocks it before.
void SwathTracer::collect_receivers(const SightLine& line) {
  reached_.clear();
  const double slack = scene_.tolerance.length;
  const double last = line.direction.dot(line.last - line.start);
  for (const Crossing& crossing : crossings_) {
    if (crossing.distance < slack) continue;
    const bool is_before = crossing.distance < last - slack;
    if (is_before && crossing.is_clear) return;
    if (crossing.distance <= last + slack) continue;
    const int r = opaque_.triangles[at(crossing.triangle)].surface;
    const Surface& receiver = scene_.surfaces[at(r)];
    const auto add = [&](int id) {
      if (std::find(reached_.begin(), reached_.end(), id) == reached_.end()) reached_.push_back(id);
    };
    if (receiver.frame.normal.dot(line.direction) < 0) {
      add(r);
    } else if (at(receiver.plane) < backs_.size()) {
      for (const int back : backs_[at(receiver.plane)])
        if (scene_.surfaces[at(back)].frame.normal.dot(line.direction) < 0) add(back);
    }
    if (crossing.is_clear) return;
  }
}

void SwathTracer::try_receiver(const Swath& swath, const SightLine& line, int receiver, double t0,
                               double t1, std::vector<Open>& open) {
  const Surface& target = scene_.surfaces[at(receiver)];
  const double tm = 0.5 * (t0 + t1);
  const auto trace = trace_at(swath, target.frame, tm);
  const auto before = trace_at(swath, target.frame, t0), after = trace_at(swath, target.frame, t1);
  if (!trace || !before || !after || !(trace->tangent.norm() > 0)) return;
  const double least = least_steps * step_;
  if ((trace->point - before->point).norm() < least || (trace->point - after->point).norm() < least)
    return;
  const Vec2 p = target.frame.to_plane(trace->point);
  if (is_known(swath, receiver, before->point, after->point)) return;
  if (distance_to_rings(target.rings, p) <= least || !is_inside(target.rings, p)) return;
  const Vec3 left = target.frame.normal.cross(trace->tangent).normalized();
  if (!may_matter(swath, line, receiver, {trace->point, target.frame.normal, left})) return;
  EventEvidence evidence;
  for (const double step : {wide_step * step_, step_}) {
    if (step == step_ && !has_fine_detail_) break;
    const Vec3 a = trace->point + step * left, b = trace->point - step * left;
    finder_.find(a, target.frame.normal, stage_.emitter, left_);
    finder_.find(b, target.frame.normal, stage_.emitter, right_);
    if (left_.signature == right_.signature) continue;
    evidence = compare_sides({a, left_}, {b, right_}, swath.group);
    if (evidence.differs) break;
  }
  if (!evidence.differs) return;
  if (swath.source.kind == CurveKind::face)
    known_.push_back({receiver, before->point, after->point});
  std::sort(evidence.triples.begin(), evidence.triples.end());
  if (!open.empty())
    for (auto last = open.rbegin(); last != open.rend() && last->t1 >= t0; ++last)
      if (last->t1 == t0 && last->receiver == receiver && last->triples == evidence.triples) {
        last->t1 = t1;
        return;
      }
  open.push_back({receiver, t0, t1, std::move(evidence.triples)});
}

/// False only if what happens at a point is below the limits.
bool SwathTracer::may_matter(const Swath& swath, const SightLine& line, int receiver,
                             const ReceivingPoint& at) const {
  if (!(limits_.least_change > 0)) return true;
  // The form factor is at most the emitter's area times the largest kernel.
  const Vec2 in_plane = stage_.frame.to_plane(at.position);
  Vec2 nearest = in_plane;
  for (Eigen::Index k = 0; k < 2; ++k)
    nearest[k] = std::clamp(in_plane[k], stage_.bounds.min()[k], stage_.bounds.max()[k]);
  const double height = stage_.frame.height(at.position);
  const double distance = std::hypot(height, (nearest - in_plane).norm());
  if (stage_.area * height < limits_.least_change * std::numbers::pi * std::pow(distance, 3))
    return false;
  const double h =
      element_size(receiver_size_[static_cast<std::size_t>(receiver)], limits_.max_length);
  if (swath.may_be_first_order) {
    // A shadow's straight edge across all of the emitter, moving as its nearest point does.
    const Vec3 way = line.start - at.position;
    const double kernel = std::abs(at.normal.dot(way) * stage_.frame.normal.dot(way)) /
                          (std::numbers::pi * std::pow(way.squaredNorm(), 2));
    const double speed = (line.start - line.last).norm() / (line.last - at.position).norm();
    const double jump = kernel * speed * stage_.bounds.diagonal().norm();
    return jump * h >= least_share_of_limit * limits_.least_change;
  }
  const auto& ids = swath.group;
  for (std::size_t i = 0; i < ids.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k) {
        const double jump =
            triangle_jump(at, stage_.frame,
                          {line_of(stage_, opaque_, ids[i]), line_of(stage_, opaque_, ids[j]),
                           line_of(stage_, opaque_, ids[k])});
        if (!(0.5 * jump * h * h < least_share_of_limit * limits_.least_change)) return true;
      }
  return false;
}

/// All swaths of one face lie in its plane and may make the same piece of curve.
bool SwathTracer::is_known(const Swath& swath, int receiver, const Vec3& from, const Vec3& to) {
  if (swath.source != known_source_) {
    known_source_ = swath.source;
    known_.clear();
  }
  const double slack = scene_.tolerance.length;
  return std::any_of(known_.begin(), known_.end(), [&](const KnownPiece& known) {
    if (known.receiver != receiver) return false;
    const Vec3 along = (known.to - known.from).normalized();
    const double length = (known.to - known.from).norm();
    const auto lies_on = [&](const Vec3& p) {
      const double t = along.dot(p - known.from);
      return t >= -slack && t <= length + slack;
    };
    return lies_on(from) && lies_on(to);
  });
}

/// Turns a piece of swath into arcs.
void SwathTracer::finish(const Swath& swath, const Open& piece,
                         std::vector<DiscontinuityCurve>& curves) const {
  const PlaneFrame& plane = scene_.surfaces[at(piece.receiver)].frame;
  DiscontinuityCurve curve;
  curve.receiver = piece.receiver;
  curve.emitter = stage_.emitter;
  curve.kind = swath.source.kind;
  curve.order = swath.may_be_first_order ? 1 : 2;
  curve.triples = piece.triples;
  curve.sources = {swath.source};
  if (swath.is_planar) {
    curve.sight_plane = hull_of(swath, 0, 1).normal;
    curve.arc = straight_arc(plane.to_plane(trace_at(swath, plane, piece.t0)->point),
                             plane.to_plane(trace_at(swath, plane, piece.t1)->point));
    curves.push_back(std::move(curve));
    return;
  }
  const auto direction = [&](const Trace& trace) -> Vec2 {
    return {plane.e1.dot(trace.tangent), plane.e2.dot(trace.tangent)};
  };
  const auto add = [&](const auto& self, double t0, double t1, int halvings) -> void {
    const double tm = 0.5 * (t0 + t1);
    const auto a = trace_at(swath, plane, t0), b = trace_at(swath, plane, tm),
               c = trace_at(swath, plane, t1);
    if (!a || !b || !c) return;
    const Vec2 from = plane.to_plane(a->point), to = plane.to_plane(c->point);
    if (const auto arc = conic_arc(from, direction(*a), plane.to_plane(b->point), to, direction(*c),
                                   straight_enough * step_)) {
      curve.arc = *arc;
      curves.push_back(curve);
    } else if (halvings < most_halvings) {
      self(self, t0, tm, halvings + 1);
      self(self, tm, t1, halvings + 1);
    } else {
      curve.arc = straight_arc(from, to);
      curves.push_back(curve);
    }
  };
  add(add, piece.t0, piece.t1, 0);
}

}  // namespace halfshade
