#include "meshing/backprojection/sight_shaft.h"

#include "meshing/backprojection/margins.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Others see nothing of the emitter.
bool is_in_front(const OpaqueTopology::OpaqueSurface& emitter, const Vec3& p, double height) {
  return height > margins::slack * std::max(emitter.magnitude, p.lpNorm<Eigen::Infinity>());
}

}  // namespace

void SightShaft::make(const OpaqueTopology::OpaqueSurface& emitter,
                      std::span<const BorderLine> lines, std::span<const Vec3> points) {
  const PlaneFrame& frame = emitter.frame;
  double magnitude = emitter.magnitude, highest = 0;
  for (const Vec3& p : points) {
    magnitude = std::max(magnitude, p.lpNorm<Eigen::Infinity>());
    highest = std::max(highest, frame.height(p));
  }
  slack = margins::shaft_margin * margins::slack * magnitude;
  spread = slack / magnitude;
  normal = frame.normal;
  span = normal.cwiseAbs();
  nearest = normal.dot(frame.origin);
  farthest = nearest + highest;
  sides.assign((lines.size() + 3) / 4, {});
  for (std::size_t k = 0; k < lines.size(); ++k) {
    // The slope of the plane through line and point.
    double low = 0, high = 0;
    bool is_first = true;
    for (const Vec3& p : points) {
      const double height = frame.height(p);
      if (!is_in_front(emitter, p, height)) continue;
      const double slope = lines[k].inset(frame, p) / height;
      low = is_first ? slope : std::min(low, slope);
      high = is_first ? slope : std::max(high, slope);
      is_first = false;
    }
    const Vec3 on_line = frame.origin + lines[k].offset * lines[k].out;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 out = (lines[k].out + (i == 0 ? low : high) * normal).normalized();
      sides[k / 4][i].set(k % 4, out, out.dot(on_line));
    }
  }
}

bool SightShaft::is_outside(const Bounds& box) const {
  const Vec3 centre = box.centre(), half = box.half_size();
  const double allowed = slack + spread * 2 * half.maxCoeff();
  for (const auto& [one, other] : sides)
    if (one.lowest(centre, half).min(other.lowest(centre, half)).maxCoeff() > allowed) return true;
  const double middle = normal.dot(centre), reach = span.dot(half);
  return middle - reach > farthest + allowed || middle + reach < nearest - allowed;
}

}  // namespace halfshade
