#include "meshing/discontinuity/swath_tracer.h"

#include "meshing/core/planar.h"
#include "meshing/discontinuity/curve_fitting.h"
#include "meshing/discontinuity/margins.h"

#include <cmath>

namespace halfshade {
namespace {

// How often what is left of a swath is divided by what hides it, and the share of it that this must
// take away each time.
constexpr int most_divisions = 8;
constexpr double least_hidden = 0.1;
// The line that is tried: in the middle itself it may run through a face's diagonal and seem to
// graze.
constexpr double tried = 0.47;

}  // namespace

TraceCounts operator-(const TraceCounts& a, const TraceCounts& b) {
  return {a.swaths - b.swaths, a.pieces - b.pieces, a.steps - b.steps, a.crossings - b.crossings,
          a.effort - b.effort};
}

TraceCounts& operator+=(TraceCounts& a, const TraceCounts& b) {
  a.swaths += b.swaths;
  a.pieces += b.pieces;
  a.steps += b.steps;
  a.crossings += b.crossings;
  a.effort += b.effort;
  return a;
}

SwathTracer::SwathTracer(const SoundScene& scene, const OpaqueScene& opaque,
                         const EmitterScene& emitter_scene, const TraceLimits& limits)
    : scene_(scene),
      emitter_scene_(emitter_scene),
      cuts_(scene, opaque, emitter_scene),
      caster_(scene, opaque),
      culling_(scene, opaque, emitter_scene, limits),
      decider_(opaque, emitter_scene) {}

bool SwathTracer::trace(const Swath& swath, std::vector<DiscontinuityCurve>& curves,
                        const std::function<bool()>& may_go_on) {
  ++counts_.swaths;
  counts_.steps += emitter_scene_.outline.size();
  pieces_.clear();
  const std::vector<double> limits = cuts_.limits(swath);
  for (std::size_t i = 1; i < limits.size(); ++i) {
    const double t0 = limits[i - 1], t1 = limits[i];
    if (!(t1 > t0)) continue;
    const auto line = line_at(swath, emitter_scene_.frame, 0.5 * (t0 + t1));
    if (!line || !may_be_event(emitter_scene_, swath, *line)) continue;
    if (!trace_between(swath, t0, t1, most_divisions, may_go_on)) return false;
  }
  for (const Piece& piece : pieces_) append_curves(swath, piece, curves);
  return true;
}

/// Precondition: t0 and t1 lie between two neighbouring limits of the swath.
bool SwathTracer::trace_between(const Swath& swath, double t0, double t1, int divisions,
                                const std::function<bool()>& may_go_on) {
  if (!(t1 > t0)) return true;
  if (may_go_on && !may_go_on()) return false;
  if (divisions > 0) {
    const auto hidden = hidden_around(swath, t0 + tried * (t1 - t0), t0, t1);
    if (hidden.length() > least_hidden * (t1 - t0))
      return trace_between(swath, t0, hidden.from, divisions - 1, may_go_on) &&
             trace_between(swath, hidden.to, t1, divisions - 1, may_go_on);
  }
  counts_.steps += cuts_.between(swath, t0, t1, parameters_);
  for (std::size_t k = 1; k < parameters_.size(); ++k) {
    if (!(parameters_[k] > parameters_[k - 1])) continue;
    if (may_go_on && !may_go_on()) return false;
    trace_piece(swath, parameters_[k - 1], parameters_[k]);
  }
  return true;
}

/// The longest stretch about t in which one triangle hides the emitter; empty if none does.
SwathCuts::Stretch SwathTracer::hidden_around(const Swath& swath, double t, double t0, double t1) {
  SwathCuts::Stretch longest = {t, t};
  const auto line = line_at(swath, emitter_scene_.frame, t);
  if (!line) return longest;
  caster_.cast(*line);
  counts_.steps += caster_.step_count();
  for (const int triangle : caster_.blockers())
    if (const auto hidden = cuts_.hidden_by(triangle, swath, t, t0, t1);
        hidden.length() > longest.length())
      longest = hidden;
  return longest;
}

void SwathTracer::trace_piece(const Swath& swath, double t0, double t1) {
  const auto line = line_at(swath, emitter_scene_.frame, 0.5 * (t0 + t1));
  if (!line) return;
  ++counts_.pieces;
  const std::vector<int>& receivers = caster_.cast(*line);
  counts_.steps += caster_.step_count();
  counts_.crossings += caster_.crossing_count();
  for (const int receiver : receivers) try_receiver(swath, *line, receiver, t0, t1);
}

void SwathTracer::try_receiver(const Swath& swath, const SightLine& line, int receiver, double t0,
                               double t1) {
  const Surface& target = scene_.surfaces[at(receiver)];
  const auto middle = trace_at(swath, target.frame, 0.5 * (t0 + t1));
  const auto from = trace_at(swath, target.frame, t0), to = trace_at(swath, target.frame, t1);
  if (!middle || !from || !to || !(middle->tangent.norm() > 0)) return;
  const double step = side_step(target, emitter_scene_, line, middle->point);
  const double least = margins::least_steps * step;
  if ((middle->point - from->point).norm() < least || (middle->point - to->point).norm() < least)
    return;
  const Span3 span = {from->point, to->point};
  known_.use(swath.source);
  if (known_.cover(receiver, span, tolerance_of(target).length)) return;
  const Vec2 p = target.frame.to_plane(middle->point);
  if (distance_to_rings(target.rings, p) <= least || !is_inside(target.rings, p)) return;
  const Vec3 left = target.frame.normal.cross(middle->tangent).normalized();
  const ReceivingPoint place = {middle->point, target.frame.normal, left};
  if (!culling_.may_matter(swath, line, receiver, place)) return;
  EventEvidence evidence = decider_.decide(place, step, swath.group);
  counts_.effort = decider_.effort();
  if (!evidence.differs) return;
  if (swath.source.kind == CurveKind::face) known_.add(receiver, span);
  add_piece({receiver, t0, t1, step, std::move(evidence.triples)});
}

/// Continues the piece that ends at t0 if there is one of the same kind.
void SwathTracer::add_piece(Piece piece) {
  const auto meets = [&](const Piece& last) { return last.t1 >= piece.t0 - margins::same_cut; };
  for (auto last = pieces_.rbegin(); last != pieces_.rend() && meets(*last); ++last)
    if (std::abs(last->t1 - piece.t0) <= margins::same_cut && last->receiver == piece.receiver &&
        last->triples == piece.triples) {
      last->t1 = piece.t1;
      last->step = std::min(last->step, piece.step);
      return;
    }
  pieces_.push_back(std::move(piece));
}

void SwathTracer::append_curves(const Swath& swath, const Piece& piece,
                                std::vector<DiscontinuityCurve>& curves) const {
  const PlaneFrame& plane = scene_.surfaces[at(piece.receiver)].frame;
  DiscontinuityCurve curve;
  curve.receiver = piece.receiver;
  curve.emitter = emitter_scene_.emitter;
  curve.kind = swath.source.kind;
  curve.order = swath.may_be_first_order ? 1 : 2;
  curve.step = piece.step;
  curve.triples = piece.triples;
  curve.sources = {swath.source};
  if (swath.is_planar) curve.sight_plane = plane_normal(swath);
  for (const ConicArc& arc :
       fit_arcs(swath, piece.t0, piece.t1, plane, margins::straight_enough * piece.step)) {
    curve.arc = arc;
    curves.push_back(curve);
  }
}

}  // namespace halfshade
