#include "meshing/geometry/lines_through.h"

#include <utility>

namespace halfshade {

LinesThrough::LinesThrough(const Bounds& a, const Bounds& b) : near_(a), far_(b) {
  const Vec3 gap = (a.low - b.high).cwiseMax(b.low - a.high);
  gap_ = gap.maxCoeff(&axis_);
  if (near_.low[axis_] > far_.low[axis_]) std::swap(near_, far_);
  if (!(gap_ > 0)) return;
  inverse_[0][0] = 1 / (far_.low[axis_] - near_.low[axis_]);
  inverse_[0][1] = 1 / (far_.high[axis_] - near_.low[axis_]);
  inverse_[1][0] = 1 / (far_.low[axis_] - near_.high[axis_]);
  inverse_[1][1] = 1 / (far_.high[axis_] - near_.high[axis_]);
}

}  // namespace halfshade
