#include "solver/factors/flat_parts.h"

#include <algorithm>

namespace halfshade {

void FlatParts::add(std::span<const Vec2> corners) {
  Part part{all_corners_.size(), all_corners_.size() + corners.size(), {}};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    all_corners_.push_back({corners[k], static_cast<std::uint32_t>(k)});
    part.box.extend(corners[k]);
  }
  all_parts_.push_back(part);
}

/// Heights of a part's corners over a plane.
FlatParts::Heights FlatParts::heights_over(const HalfPlane& plane,
                                           std::span<const Corner> corners) {
  Heights range{HUGE_VAL, -HUGE_VAL};
  heights_.resize(corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    heights_[k] = plane.height(corners[k].at);
    range.least = std::min(range.least, heights_[k]);
    range.most = std::max(range.most, heights_[k]);
  }
  return range;
}

/// Of `hidden_`, which is convex: what lies beyond the plane is appended to `corners_` as a part of
/// its own; the rest stays.
void FlatParts::split(const HalfPlane& plane) {
  const std::size_t count = hidden_.size(), start = corners_.size();
  inside_.resize(count + 2);
  corners_.resize(start + count + 2);
  Corner* in = inside_.data();
  Corner* out = corners_.data() + start;
  const Corner* from = &hidden_.back();
  double at_from = heights_[count - 1];
  for (std::size_t k = 0; k < count; ++k) {
    const Corner& to = hidden_[k];
    const double at_to = heights_[k];
    if (at_from <= 0) *in++ = *from;
    if (at_from >= 0) *out++ = *from;
    // Where the border passes over the line, the line takes it up.
    if ((at_from < 0 && at_to > 0) || (at_from > 0 && at_to < 0)) {
      const Vec2 crossing = from->at + at_from / (at_from - at_to) * (to.at - from->at);
      const bool leaves = at_to > 0;
      *in++ = {crossing, leaves ? plane.border : from->border};
      *out++ = {crossing, leaves ? from->border : plane.border};
    } else if (at_from == 0) {
      if (at_to > 0) in[-1].border = plane.border;
      if (at_to < 0) out[-1].border = plane.border;
    }
    from = &to;
    at_from = at_to;
  }
  inside_.resize(static_cast<std::size_t>(in - inside_.data()));
  const auto end = static_cast<std::size_t>(out - corners_.data());
  if (end > start + 2) {
    corners_.resize(end);
    Part part{start, end, {}};
    for (const Corner& corner : corners_of(part)) part.box.extend(corner.at);
    parts_.push_back(part);
  } else
    corners_.resize(start);
  hidden_.swap(inside_);
}

/// What lies outside of the shadow is added to the parts, what is left is hidden. False if all lies
/// outside.
bool FlatParts::cut_off(std::span<const HalfPlane> shadow, const Part& part) {
  crossing_.clear();
  const bool is_whole = part.first == 0 && part.last == all_corners_.size();
  for (const HalfPlane& plane : shadow) {
    if (!is_whole) {
      const Heights range = heights_over(plane, corners_of(part));
      if (range.least >= 0) return false;
      if (range.most <= 0) continue;
    }
    crossing_.push_back(&plane);
  }
  const std::size_t corners_before = corners_.size(), parts_before = parts_.size();
  const auto corners = corners_of(part);
  hidden_.assign(corners.begin(), corners.end());
  for (const HalfPlane* plane : crossing_) {
    const Heights range = heights_over(*plane, hidden_);
    if (range.most <= 0) continue;
    if (range.least >= 0) {
      corners_.resize(corners_before);
      parts_.resize(parts_before);
      return false;
    }
    split(*plane);
  }
  return true;
}

}  // namespace halfshade
