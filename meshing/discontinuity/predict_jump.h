#pragma once

#include "meshing/backprojection/visible_part.h"
#include "meshing/discontinuity/discontinuity.h"
#include "meshing/events/emitter_scene.h"

namespace halfshade {

/// Predicts the jumps of finished curves. One a thread.
class JumpPredictor {
 public:
  /// All must outlive the predictor.
  JumpPredictor(const SoundScene& scene, const OpaqueScene& opaque,
                const EmitterScene& emitter_scene);

  /// Fills order and jump, for a source of unit exitance. The order may turn out to be higher than
  /// that given: where edges that line up do not move past each other in sight, nothing jumps.
  void predict(DiscontinuityCurve& curve);

 private:
  double jump_at(const DiscontinuityCurve& curve, double s, double& wide);
  /// From what is seen at point ± step, which was found last.
  double value_jump(const Vec3& point, const Vec3& step, const Vec3& normal) const;
  double slope_jump(const DiscontinuityCurve& curve, const Vec3& point, const Vec3& step,
                    const Vec3& normal) const;
  double curvature_jump(const DiscontinuityCurve& curve, const Vec3& point, const Vec3& left,
                        const Vec3& normal) const;
  double third_order_jump(const DiscontinuityCurve& curve, const Vec3& point, const Vec3& left,
                          const Vec3& normal) const;
  bool lies_in_sight_plane(const DiscontinuityCurve& curve, const Vec3& point, EdgeId edge) const;

  const SoundScene& scene_;
  const OpaqueScene& opaque_;
  const EmitterScene& emitter_scene_;
  VisiblePartFinder finder_;
  VisiblePart left_, right_;
};

}  // namespace halfshade
