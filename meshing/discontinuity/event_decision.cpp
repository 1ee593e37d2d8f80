#include "meshing/discontinuity/event_decision.h"

#include "meshing/discontinuity/margins.h"

#include <algorithm>

namespace halfshade {
namespace {

bool has_shorter_edges(const EmitterScene& emitter_scene, double length) {
  const auto is_short = [&](const Span3& span) { return span.direction().norm() < length; };
  return std::any_of(emitter_scene.edges.begin(), emitter_scene.edges.end(),
                     [&](const SilhouetteEdge& edge) { return is_short(edge.whole); }) ||
         std::any_of(emitter_scene.outline.begin(), emitter_scene.outline.end(),
                     [&](const OutlinePiece& piece) { return is_short(piece.span); });
}

}  // namespace

EventDecider::EventDecider(const SoundScene& scene, const OpaqueScene& opaque,
                           const EmitterScene& emitter_scene)
    : emitter_(emitter_scene.emitter),
      step_(side_step(scene, opaque)),
      has_fine_detail_(
          has_shorter_edges(emitter_scene, margins::fine_detail * scene.tolerance.scene_size)),
      finder_(opaque) {}

EventEvidence EventDecider::decide(const ReceivingPoint& at, std::span<const EdgeId> group) {
  EventEvidence evidence = compare(at, margins::wide_step * step_, group);
  if (!evidence.differs && has_fine_detail_) evidence = compare(at, step_, group);
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
