#include "meshing/predict_jump.h"

#include "meshing/border_events.h"
#include "meshing/event_jump.h"
#include "meshing/swath_tracer.h"

#include <cmath>

namespace halfshade {
namespace {

constexpr std::array<double, 3> samples = {1. / 6, 1. / 2, 5. / 6};
// A jump of the slope that is this small a share of what makes it is rounding.
constexpr double least_share = 1e-6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

JumpPredictor::JumpPredictor(const SoundScene& scene, const OpaqueScene& opaque,
                             const EmitterStage& stage)
    : scene_(scene),
      opaque_(opaque),
      stage_(stage),
      step_(side_step(scene, opaque)),
      finder_(opaque) {}

void JumpPredictor::predict(DiscontinuityCurve& curve) {
  for (; curve.order < 3; ++curve.order) {
    bool jumps = false;
    for (std::size_t k = 0; k < samples.size(); ++k) {
      curve.jump[k] = jump_at(curve, samples[k]);
      jumps = jumps || curve.jump[k] != 0;
    }
    if (jumps || curve.order == 2) return;
  }
}

double JumpPredictor::jump_at(const DiscontinuityCurve& curve, double s) {
  const PlaneFrame& plane = scene_.receivers[at(curve.receiver)].frame;
  const Vec2 tangent = tangent_at(curve.arc, s);
  const Vec3 point = plane.to_space(point_at(curve.arc, s));
  const Vec3 left = -tangent.y() * plane.e1 + tangent.x() * plane.e2;
  if (curve.order == 2) return curvature_jump(curve, point, left, plane.normal);
  finder_.find(point + step_ * left, plane.normal, stage_.emitter, left_);
  finder_.find(point - step_ * left, plane.normal, stage_.emitter, right_);
  return curve.order == 0 ? value_jump(point, left, plane.normal)
                          : slope_jump(curve, point, left, plane.normal);
}

double JumpPredictor::value_jump(const Vec3& point, const Vec3& left, const Vec3& normal) {
  return seen_factor(left_, point + step_ * left, normal) -
         seen_factor(right_, point - step_ * left, normal);
}

double JumpPredictor::slope_jump(const DiscontinuityCurve& curve, const Vec3& point,
                                 const Vec3& left, const Vec3& normal) {
  if (std::abs(stage_.frame.height(point)) <= step_)  // the emitter is seen edge-on
    return value_jump(point, left, normal) / step_;
  const ReceivingPoint receiving = {point, normal, left};
  double jump = 0, whole = 0;
  const auto add = [&](const VisiblePart& part, double sign) {
    for (const BoundaryPiece& piece : part.pieces) {
      const double off = std::max(std::abs(curve.sight_plane.dot(piece.from - point)),
                                  std::abs(curve.sight_plane.dot(piece.to - point)));
      if (piece.edge == horizon_edge || off > scene_.tolerance.length) continue;
      const double motion = boundary_motion(receiving, stage_.frame, piece.from, piece.to);
      jump += sign * motion;
      whole += std::abs(motion);
    }
  };
  add(left_, 1);
  add(right_, -1);
  return std::abs(jump) > least_share * whole ? jump : 0;
}

double JumpPredictor::curvature_jump(const DiscontinuityCurve& curve, const Vec3& point,
                                     const Vec3& left, const Vec3& normal) const {
  double jump = 0;
  for (const EdgeTriple& triple : curve.triples) {
    const double size = triangle_jump(
        {point, normal, left}, stage_.frame,
        {line_of(triple.edges[0]), line_of(triple.edges[1]), line_of(triple.edges[2])});
    if (std::isfinite(size)) jump += triple.sign * size;
  }
  return jump;
}

Line3 JumpPredictor::line_of(int edge) const {
  if (edge >= 0 && edge < opaque_.edge_count()) {
    const auto [from, to] = opaque_.edge_ends(edge);
    return {from, to - from};
  }
  for (const OutlinePiece& piece : stage_.outline)
    if (piece.id == edge) return {piece.span.from, piece.span.direction()};
  return {stage_.frame.origin, stage_.frame.e1};
}

}  // namespace halfshade
