#include "meshing/discontinuity/event_decision.h"

#include "meshing/discontinuity/margins.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

double shortest_edge(const EmitterScene& emitter_scene) {
  double least = HUGE_VAL;
  for (const SilhouetteEdge& edge : emitter_scene.edges)
    least = std::min(least, edge.whole.direction().norm());
  for (const OutlinePiece& piece : emitter_scene.outline)
    least = std::min(least, piece.span.direction().norm());
  return least;
}

}  // namespace

EventDecider::EventDecider(const OpaqueScene& opaque, const EmitterScene& emitter_scene)
    : emitter_(emitter_scene.emitter),
      shortest_edge_(shortest_edge(emitter_scene)),
      finder_(opaque) {}

EventEvidence EventDecider::decide(const ReceivingPoint& at, double step,
                                   std::span<const EdgeId> group) {
  EventEvidence evidence = compare(at, margins::wide_step * step, group);
  if (!evidence.differs && shortest_edge_ < margins::fine_detail * step)
    evidence = compare(at, step, group);
  std::sort(evidence.triples.begin(), evidence.triples.end());
  return evidence;
}

EventEvidence EventDecider::compare(const ReceivingPoint& at, double step,
                                    std::span<const EdgeId> group) {
  const Vec3 a = at.position + step * at.across, b = at.position - step * at.across;
  finder_.find(a, at.normal, emitter_, left_);
  finder_.find(b, at.normal, emitter_, right_);
  if (left_.signature == right_.signature) return {};
  return compare_sides({a, left_}, {b, right_}, group);
}

}  // namespace halfshade
