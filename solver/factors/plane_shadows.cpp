#include "solver/factors/plane_shadows.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Points this near to a plane, relative to their distance, see it edge-on.
constexpr double edge_on_plane = 1e-12;
/// Shadows of corners that are thrown farther than this, as a multiple of how
/// far off they are, may be anywhere; and all others are exact to this,
/// relative to how far off they are.
constexpr double thrown_far = 1e3, exactness_of_reach = 1e-11;
/// Directions this near to an axis, as a slope, may lead to either side of it.
constexpr double nearly_along = 1e-9;

}  // namespace

const Outlines::Edges& Outlines::of(int body) {
  Edges& edges = known_[at(body)];
  if (stand_[at(body)] == now_) return edges;
  stand_[at(body)] = now_;
  const ConvexBody& shape = scene_.bodies[at(body)];
  find_fronts(shape, point_, is_front_);
  edges.clear();
  for (const auto& [ends, sides] : shape.edges) {
    const bool left = is_front_[at(sides[0])] != 0;
    if (left == (is_front_[at(sides[1])] != 0)) continue;
    edges.push_back({ends[left ? 0 : 1], ends[left ? 1 : 0]});
  }
  return edges;
}

int PlaneShadows::add(const Shadow& shadow, std::span<const Vec3> corners) {
  Shadow& added = shadows_.emplace_back(shadow);
  for (const Vec3& p : corners) {
    const Vec3 corner = in_frame(p);
    added.x.push_back(corner.x());
    added.y.push_back(corner.y());
    added.z.push_back(corner.z());
  }
  const bool is_few = corners.size() <= added.u.size();
  if (is_few) added.around = (corners.size() + 1) / 2 * 2;
  // A box in space holds things with more corners, and lies hardly farther off.
  Eigen::AlignedBox3d box;
  for (const Vec3& p : corners) box.extend(p);
  for (std::size_t k = 0; k < added.u.size(); ++k) {
    const Vec3 corner =
        in_frame(is_few ? corners[std::min(k, corners.size() - 1)]
                        : Vec3(box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k))));
    added.u[k] = corner.x();
    added.v[k] = corner.y();
    added.w[k] = corner.z();
  }
  reaches_.emplace_back();
  return static_cast<int>(shadows_.size()) - 1;
}

int PlaneShadows::number_of_body(int body) {
  const auto known = of_body_.find(body);
  if (known != of_body_.end()) return known->second;
  Shadow shadow;
  shadow.body = body;
  return of_body_[body] = add(shadow, scene_.bodies[at(body)].vertices);
}

int PlaneShadows::number_of_polygon(const Blocker& polygon) {
  const auto known = of_polygon_.find(&polygon);
  if (known != of_polygon_.end()) return known->second;
  Shadow shadow;
  shadow.polygon = &polygon;
  shadow.plane = {frame_.e1.dot(polygon.normal), frame_.e2.dot(polygon.normal),
                  polygon.normal.dot(frame_.origin - polygon.corners.front())};
  return of_polygon_[&polygon] = add(shadow, polygon.corners);
}

void PlaneShadows::move() {
  stand_ = outlines_.now();
  point_ = in_frame(outlines_.point());
}

int PlaneShadows::side_of(const Shadow& shadow) const {
  if (!shadow.polygon) return 1;
  const Vec3 towards = outlines_.point() - shadow.polygon->corners.front();
  const double height = shadow.polygon->normal.dot(towards);
  if (!(std::abs(height) > edge_on_plane * towards.lpNorm<1>())) return 0;
  return height > 0 ? 1 : -1;
}

void PlaneShadows::find_box(const Shadow& shadow, Reach& reach) const {
  reach.has_box = true;
  using Two = Eigen::Array2d;
  const auto two = [](const std::array<double, 8>& values, std::size_t k) -> Two {
    return Eigen::Map<const Two>(values.data() + k);
  };
  const double x = point_.x(), y = point_.y(), z = point_.z();
  Two least_x = Two::Constant(HUGE_VAL), least_y = least_x, least_part = least_x;
  Two most_x = -least_x, most_y = -least_x, most_part = -least_x;
  for (std::size_t k = 0; k < shadow.around; k += 2) {
    const Two part = z / (z - two(shadow.w, k));
    const Two on_x = x + part * (two(shadow.u, k) - x), on_y = y + part * (two(shadow.v, k) - y);
    least_part = least_part.min(part);
    most_part = most_part.max(part);
    least_x = least_x.min(on_x);
    most_x = most_x.max(on_x);
    least_y = least_y.min(on_y);
    most_y = most_y.max(on_y);
  }
  // Corners that are not nearer to the plane than the point have a part that is not positive.
  if (!(least_part[0] > 0 && least_part[1] > 0 && most_part[0] < thrown_far &&
        most_part[1] < thrown_far)) {
    find_open_box(shadow, reach.box);
    return;
  }
  const double left = std::min(least_x[0], least_x[1]), right = std::max(most_x[0], most_x[1]);
  const double low = std::min(least_y[0], least_y[1]), high = std::max(most_y[0], most_y[1]);
  const double off = exactness_of_reach * (std::abs(x) + std::abs(y) + z + right - left + high -
                                           low + std::abs(left - x) + std::abs(low - y));
  reach.box = {left - off, low - off, right + off, high + off};
}

/// Where some corners are not nearer to the plane than the point, or hardly: what is nowhere nearer
/// hides nothing, and from polygons that are nearer in part shadows go on for ever.
void PlaneShadows::find_open_box(const Shadow& shadow, FlatBox& box) const {
  const double x = point_.x(), y = point_.y(), z = point_.z();
  const auto part_of = [&](double height) { return z / (z - height); };
  const auto is_nearer = [&](double height) { return z - height > edge_on_plane * z; };
  // Rounding does not tell on which side of the point's level a corner lies.
  const auto is_farther = [&](double height) { return height - z > edge_on_plane * z; };
  box = {};
  if (std::none_of(shadow.w.begin(), shadow.w.end(), is_nearer)) return;
  box = FlatBox::everywhere();
  if (!shadow.polygon) return;
  FlatBox open;
  bool is_any_ahead = false;
  const auto add_far = [&](double to_x, double to_y) {
    const double little = nearly_along * (std::abs(to_x) + std::abs(to_y));
    if (!(to_x > little)) open.left = -HUGE_VAL;
    if (!(to_x < -little)) open.right = HUGE_VAL;
    if (!(to_y > little)) open.low = -HUGE_VAL;
    if (!(to_y < -little)) open.high = HUGE_VAL;
  };
  double reach = std::abs(x) + std::abs(y) + z;
  const std::size_t count = shadow.x.size();
  for (std::size_t from = count - 1, to = 0; to < count; from = to++) {
    const double dx = shadow.x[to] - x, dy = shadow.y[to] - y, height = shadow.z[to];
    // What is thrown far lies from there on in its direction: not beyond all others for certain.
    const double part = std::min(part_of(height), thrown_far);
    if (height < z) {
      open.add(x + part * dx, y + part * dy);
      reach = std::max({reach, part * std::abs(dx), part * std::abs(dy)});
      is_any_ahead = is_any_ahead || part < thrown_far;
    }
    if (!(height < z && part < thrown_far) && !is_farther(height)) add_far(dx, dy);
    const double before = shadow.z[from];
    if ((before < z) == (height < z)) continue;
    const double crossing = (z - before) / (height - before);
    add_far(shadow.x[from] + crossing * (shadow.x[to] - shadow.x[from]) - x,
            shadow.y[from] + crossing * (shadow.y[to] - shadow.y[from]) - y);
  }
  if (!is_any_ahead) return;
  const double off = exactness_of_reach * reach;
  box = {open.left - off, open.low - off, open.right + off, open.high + off};
}

/// The plane through the point and an edge, from the edge on: the point may be so far off that
/// rounding there is more than the edge is long.
void PlaneShadows::add_side(std::size_t from, std::size_t to, double sign, Shadow& shadow) const {
  const double x = shadow.x[from], y = shadow.y[from], z = shadow.z[from];
  const double from_x = x - point_.x(), from_y = y - point_.y(), from_z = z - point_.z();
  const double along_x = shadow.x[to] - x, along_y = shadow.y[to] - y, along_z = shadow.z[to] - z;
  const double ax = sign * (from_y * along_z - from_z * along_y);
  const double ay = sign * (from_z * along_x - from_x * along_z);
  const double az = sign * (from_x * along_y - from_y * along_x);
  const double steepness = std::abs(ax) + std::abs(ay), b = -(ax * x + ay * y + az * z);
  if (steepness > edge_on_plane * (steepness + std::abs(az)))
    shadow.sides.push_back({ax, ay, b});
  else if (b > 0)  // Parallel to this plane, all of which lies outside.
    shadow.sides.push_back({0, 0, 1});
}

void PlaneShadows::find_sides(Shadow& shadow, int side) {
  shadow.stand = stand_;
  shadow.sides.clear();
  if (shadow.body >= 0) {
    const Outlines::Edges& outline = outlines_.of(shadow.body);
    for (const auto& [from, to] : outline) add_side(at(from), at(to), 1, shadow);
    // From inside it hides nothing, but from an open side, on which only what looks in lies, all.
    const bool hides_all = outline.empty() && scene_.bodies[at(shadow.body)].open_sides > 0;
    if (shadow.sides.empty() && !hides_all) shadow.sides.push_back({0, 0, 1});
    return;
  }
  shadow.sides.push_back({side * shadow.plane.ax, side * shadow.plane.ay, side * shadow.plane.b});
  for (std::size_t from = shadow.x.size() - 1, to = 0; to < shadow.x.size(); from = to++)
    add_side(from, to, side, shadow);
}

}  // namespace halfshade
