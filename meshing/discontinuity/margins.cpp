#include "meshing/discontinuity/margins.h"

#include "meshing/events/emitter_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

double roundings(double magnitude) {
  return margins::roundings_per_step * std::numeric_limits<double>::epsilon() * magnitude;
}

}  // namespace

double side_step(const Surface& receiver, const EmitterScene& emitter_scene, const SightLine& line,
                 const Vec3& point) {
  const double before = (line.start - line.last).norm(), after = (line.last - point).norm();
  const double emitter_size = emitter_scene.bounds.diagonal().norm();
  const double reach = std::max({size_of(receiver), emitter_size, before + after});
  const double penumbra = before > 0 ? emitter_size * after / before : HUGE_VAL;
  // The line turns about its last feature by what rounds its start.
  const double turned = before > after ? line.start.norm() * after / before : line.start.norm();
  const double magnitude = std::max({point.norm(), line.last.norm(), turned});
  return std::max(roundings(magnitude),
                  std::min(margins::relative_step * reach, margins::step_in_penumbra * penumbra));
}

double side_step(const Surface& receiver) {
  return std::max(roundings(receiver.scale.magnitude),
                  margins::relative_step * receiver.scale.magnitude);
}

}  // namespace halfshade
