#include "meshing/discontinuity/predict_jump.h"

#include "meshing/backprojection/edge_sum.h"
#include "meshing/discontinuity/event_jump.h"
#include "meshing/discontinuity/margins.h"
#include "meshing/events/margins.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// Places along a curve.
constexpr std::array<double, 3> samples = {1. / 6, 1. / 2, 5. / 6};
// The limit of a jump for ever smaller steps is this share of it at a step, or the jump is due to
// the step.
constexpr double share_in_limit = 0.5;
// If the limit differs by no more than this share, what moves in sight is far wider than the step;
// so it is where the jump is at least this share of such a one, for it grows with that width.
constexpr double hardly = 1e-6, comparable = 1e-3;

}  // namespace

JumpPredictor::JumpPredictor(const SoundScene& scene, const OpaqueScene& opaque,
                             const EmitterScene& emitter_scene)
    : scene_(scene), opaque_(opaque), emitter_scene_(emitter_scene), finder_(opaque) {}

void JumpPredictor::predict(DiscontinuityCurve& curve) {
  for (;; ++curve.order) {
    bool jumps = false;
    double wide = HUGE_VAL;
    for (const std::size_t k :
         {1, 0, 2}) {  // the middle first, for curves are narrow at their ends
      curve.jump[k] = jump_at(curve, samples[k], wide);
      jumps = jumps || curve.jump[k] != 0;
    }
    if (jumps || curve.order >= 2) return;
  }
}

/// At a place s of the curve. `wide`: the jump at another place, if the step does not matter there,
/// else HUGE_VAL; set if it is found not to matter here.
double JumpPredictor::jump_at(const DiscontinuityCurve& curve, double s, double& wide) {
  const PlaneFrame& plane = scene_.surfaces[at(curve.receiver)].frame;
  const Vec2 tangent = tangent_at(curve.arc, s);
  const Vec3 point = plane.to_space(point_at(curve.arc, s));
  const Vec3 left = -tangent.y() * plane.e1 + tangent.x() * plane.e2;
  if (curve.order == 2) return curvature_jump(curve, point, left, plane.normal);
  if (curve.order == 3) return third_order_jump(curve, point, left, plane.normal);
  const auto at_step = [&](double step) {
    finder_.find(point + step * left, plane.normal, emitter_scene_.emitter, left_);
    finder_.find(point - step * left, plane.normal, emitter_scene_.emitter, right_);
    return curve.order == 0 ? value_jump(point, step * left, plane.normal)
                            : slope_jump(curve, point, step * left, plane.normal);
  };
  const double near = at_step(curve.step);
  if (near == 0 || std::abs(near) >= comparable * wide) return near;
  // What moves in sight may be nearly as narrow as the step is: take the limit. It is zero where
  // the whole jump is due to the step.
  const double limit = 2 * near - at_step(2 * curve.step);
  if (std::abs(limit - near) <= hardly * std::abs(near)) wide = std::abs(near);
  return std::abs(limit) > share_in_limit * std::abs(near) ? limit : 0;
}

double JumpPredictor::value_jump(const Vec3& point, const Vec3& step, const Vec3& normal) const {
  return enclosed_factor(point + step, normal, left_.pieces) -
         enclosed_factor(point - step, normal, right_.pieces);
}

double JumpPredictor::slope_jump(const DiscontinuityCurve& curve, const Vec3& point,
                                 const Vec3& step, const Vec3& normal) const {
  if (std::abs(emitter_scene_.frame.height(point)) <= curve.step)  // the emitter is seen edge-on
    return (enclosed_factor(point + step, normal, left_.pieces) +
            enclosed_factor(point - step, normal, right_.pieces)) /
           step.norm();
  const ReceivingPoint receiving = {point, normal, step.normalized()};
  double jump = 0, whole = 0;
  const auto add = [&](const VisiblePart& part, double sign) {
    for (const BoundaryPiece& piece : part.pieces) {
      if (piece.edge == EdgeId::horizon() || !lies_in_sight_plane(curve, point, piece.edge))
        continue;
      const double motion = boundary_motion(receiving, emitter_scene_.frame, piece.from, piece.to);
      jump += sign * motion;
      whole += std::abs(motion);
    }
  };
  add(left_, 1);
  add(right_, -1);
  return std::abs(jump) > margins::least_share * whole ? jump : 0;
}

bool JumpPredictor::lies_in_sight_plane(const DiscontinuityCurve& curve, const Vec3& point,
                                        EdgeId edge) const {
  const OpaqueTopology& opaque = opaque_.topology();
  const Line3 line = line_of(emitter_scene_, opaque, edge);
  const double joined =
      edge.kind == EdgeId::Kind::edge ? opaque.edges[at(edge.id)].joined : emitter_scene_.joined;
  const double slack = margins::in_plane * std::max(joined, margins::slack_at(line.point));
  return std::abs(curve.sight_plane.dot(line.point - point)) <= slack &&
         std::abs(curve.sight_plane.dot(line.point + line.direction - point)) <= slack;
}

double JumpPredictor::curvature_jump(const DiscontinuityCurve& curve, const Vec3& point,
                                     const Vec3& left, const Vec3& normal) const {
  double jump = 0;
  for (const EdgeTriple& triple : curve.triples) {
    if (triple.edges[0] == EdgeId::horizon()) continue;  // of the third order
    const double size =
        triangle_jump({point, normal, left}, emitter_scene_.frame,
                      {line_of(emitter_scene_, opaque_.topology(), triple.edges[0]),
                       line_of(emitter_scene_, opaque_.topology(), triple.edges[1]),
                       line_of(emitter_scene_, opaque_.topology(), triple.edges[2])});
    if (std::isfinite(size)) jump += triple.sign * size;
  }
  return jump;
}

double JumpPredictor::third_order_jump(const DiscontinuityCurve& curve, const Vec3& point,
                                       const Vec3& left, const Vec3& normal) const {
  double jump = 0;
  for (const EdgeTriple& triple : curve.triples) {
    if (triple.edges[0] != EdgeId::horizon()) continue;
    const double size =
        horizon_jump({point, normal, left}, emitter_scene_.frame,
                     {line_of(emitter_scene_, opaque_.topology(), triple.edges[1]),
                      line_of(emitter_scene_, opaque_.topology(), triple.edges[2])});
    if (std::isfinite(size)) jump += triple.sign * size;
  }
  return jump;
}

}  // namespace halfshade
