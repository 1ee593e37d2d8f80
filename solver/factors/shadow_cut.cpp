#include "solver/factors/shadow_cut.h"

namespace halfshade {

bool add_crossing(std::span<const ShadowSide> sides, const FlatBox& box, double nearness,
                  std::vector<ShadowSide>& crossing) {
  const double x = 0.5 * (box.left + box.right), y = 0.5 * (box.low + box.high);
  const double across = box.right - x, up = box.high - y;
  const std::size_t before = crossing.size();
  crossing.resize(before + sides.size());
  ShadowSide* next = crossing.data() + before;
  for (const ShadowSide& side : sides) {
    const double height = side.ax * x + side.ay * y + side.b;
    const double reach = std::abs(side.ax) * across + std::abs(side.ay) * up;
    const double near = side.near(nearness);
    if (height - reach > -near) {
      crossing.resize(before);
      return false;
    }
    *next = side;
    next += height + reach >= near ? 1 : 0;
  }
  crossing.resize(static_cast<std::size_t>(next - crossing.data()));
  return true;
}

void ShadowCut::clear() {
  parts_.clear();
  x_.clear();
  y_.clear();
}

void ShadowCut::add(Corners part) {
  Part added{x_.size(), part.count, {}};
  x_.insert(x_.end(), part.x, part.x + part.count);
  y_.insert(y_.end(), part.y, part.y + part.count);
  for (std::size_t k = 0; k < part.count; ++k) added.box.add(part.x[k], part.y[k]);
  parts_.push_back(added);
}

/// Room for so many corners of what is cut, and of what comes of it.
void ShadowCut::reserve(std::size_t corners) {
  if (cut_x_.size() < corners)
    for (std::vector<double>* values : {&cut_x_, &cut_y_, &next_x_, &next_y_, &heights_})
      values->resize(2 * corners);
}

/// At the line that `heights_` are over; `leave` gets the corners of what lies beyond it.
template <class Leave>
void ShadowCut::cut_at_line(Leave leave) {
  // What is cut is convex to rounding: each side of it may cross a line.
  reserve(2 * cut_count_);
  double *in_x = next_x_.data(), *in_y = next_y_.data();
  const std::size_t last = cut_count_ - 1;
  double from_x = cut_x_[last], from_y = cut_y_[last], at_from = heights_[last];
  for (std::size_t k = 0; k < cut_count_; ++k) {
    const double to_x = cut_x_[k], to_y = cut_y_[k], at_to = heights_[k];
    if ((at_from < 0 && at_to > 0) || (at_from > 0 && at_to < 0)) {
      const double part = at_from / (at_from - at_to);
      *in_x = from_x + part * (to_x - from_x);
      *in_y = from_y + part * (to_y - from_y);
      leave(*in_x++, *in_y++);
    }
    *in_x = to_x;
    *in_y = to_y;
    const int is_inside = at_to <= 0 ? 1 : 0;
    in_x += is_inside;
    in_y += is_inside;
    if (at_to >= 0) leave(to_x, to_y);
    from_x = to_x;
    from_y = to_y;
    at_from = at_to;
  }
  cut_count_ = static_cast<std::size_t>(in_x - next_x_.data());
  cut_x_.swap(next_x_);
  cut_y_.swap(next_y_);
}

/// What lies beyond the line is lost.
void ShadowCut::keep_inside() {
  cut_at_line([](double, double) {});
}

/// What lies beyond the line becomes a part.
void ShadowCut::split() {
  const std::size_t start = x_.size();
  x_.resize(start + 2 * cut_count_);
  y_.resize(start + 2 * cut_count_);
  double *out_x = x_.data() + start, *out_y = y_.data() + start;
  Part rest{start, 0, {}};
  cut_at_line([&](double x, double y) {
    rest.box.add(x, y);
    *out_x++ = x;
    *out_y++ = y;
  });
  rest.count = static_cast<std::size_t>(out_x - x_.data()) - start;
  x_.resize(start + rest.count);
  y_.resize(start + rest.count);
  parts_.push_back(rest);
}

/// What is cut starts as this.
void ShadowCut::take(Corners polygon) {
  reserve(polygon.count);
  cut_count_ = polygon.count;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    cut_x_[k] = polygon.x[k];
    cut_y_[k] = polygon.y[k];
  }
}

ShadowCut::Heights ShadowCut::find_heights(const ShadowSide& side, double nearness) {
  const double near = side.near(nearness);
  Heights range{HUGE_VAL, -HUGE_VAL};
  for (std::size_t k = 0; k < cut_count_; ++k) {
    const double height = side.ax * cut_x_[k] + side.ay * cut_y_[k] + side.b;
    heights_[k] = std::abs(height) < near ? 0 : height;
    range.least = std::min(range.least, heights_[k]);
    range.most = std::max(range.most, heights_[k]);
  }
  return range;
}

ShadowCut::Corners ShadowCut::common(Corners polygon, std::span<const ShadowSide> shadow,
                                     double nearness) {
  take(polygon);
  for (const ShadowSide& side : shadow) {
    const Heights range = find_heights(side, nearness);
    if (range.most <= 0) continue;
    if (range.least >= 0) return {nullptr, nullptr, 0};
    keep_inside();
  }
  return {cut_x_.data(), cut_y_.data(), cut_count_};
}

/// What lies outside of the shadow is added to the parts. False if all does.
bool ShadowCut::cut_off(std::span<const ShadowSide> shadow, const Part& part, double nearness,
                        bool needs_rest) {
  const std::size_t corners_before = x_.size(), parts_before = parts_.size();
  take({x_.data() + part.first, y_.data() + part.first, part.count});
  // Most of the many parts that shadows leave lie outside of the next one: that takes no cut.
  crossing_.clear();
  for (const ShadowSide& side : shadow) {
    const Heights range = find_heights(side, nearness);
    if (range.least >= 0) return false;
    if (range.most > 0) crossing_.push_back(side);
  }
  for (const ShadowSide& side : crossing_) {
    const Heights range = find_heights(side, nearness);
    if (range.most <= 0) continue;
    if (range.least >= 0) {
      x_.resize(corners_before);
      y_.resize(corners_before);
      parts_.resize(parts_before);
      return false;
    }
    if (needs_rest) {
      split();
      continue;
    }
    // What is only counted has no size.
    keep_inside();
    parts_.push_back({x_.size(), 0, {}});
  }
  return true;
}

}  // namespace halfshade
