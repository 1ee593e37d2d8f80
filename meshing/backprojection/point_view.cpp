#include "meshing/backprojection/point_view.h"

#include "meshing/backprojection/margins.h"
#include "meshing/geometry/mix_bits.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace halfshade {
namespace {

/// A vector in [−length, length)³ that looks random; of another length by a power of two, the same
/// with that length.
Vec3 scatter(std::int64_t rank, double length, double attempt) {
  Vec3 v;
  int exponent = 0;
  const std::uint64_t seed = std::bit_cast<std::uint64_t>(std::frexp(length, &exponent)) ^
                             std::bit_cast<std::uint64_t>(attempt);
  for (int axis = 0; axis < 3; ++axis) {
    std::uint64_t x = 3 * static_cast<std::uint64_t>(rank) + static_cast<std::uint64_t>(axis);
    x = mix_bits(mix_bits(x) + seed);
    v[axis] = length * (static_cast<double>(x >> 11) * 0x1p-52 - 1);
  }
  return v;
}

double reach(const Bounds& box, const Vec3& normal) {
  return normal.cwiseAbs().dot(box.half_size());
}

}  // namespace

/// A box that reaches far away is rounded more coarsely than what is near the pyramid.
double SightPyramid::margin(const Bounds& box) const {
  return slack + spread * (box.high - box.low).maxCoeff();
}

void SightPyramid::make_planes() {
  box_slack = margins::pyramid_boxes * slack;
  box_spread = 2 * margins::pyramid_boxes * spread;
  planes.assign(sides.size() / 4 + 1, {});
  // The sides along the border come first, for they keep out most.
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Vec3& out = sides[(k + 1) % sides.size()];
    planes[k / 4].set(k % 4, out, out.dot(eye));
  }
  planes.back().set(sides.size() % 4, -normal, -normal.dot(plane_point));
}

bool SightPyramid::is_outside(const Vec3& from, const Vec3& to) const {
  for (std::size_t k = sides.size(); k-- > 0;)
    if (sides[k].dot(from) > slack && sides[k].dot(to) > slack) return true;
  return false;
}

bool SightPyramid::is_before_plane(const Bounds& box) const {
  return normal.dot(0.5 * (box.low + box.high) - plane_point) - reach(box, normal) > margin(box);
}

bool SightPyramid::crosses_plane(const Bounds& box) const {
  return std::abs(normal.dot(0.5 * (box.low + box.high) - plane_point)) <=
         reach(box, normal) + margin(box);
}

PointView::PointView(const OpaqueScene& scene)
    : topology_(scene.topology()),
      silhouette_trees_(scene.silhouette_trees()),
      face_tree_(scene.face_tree()),
      everything_(all_candidates(face_tree_)),
      vertices_(topology_.vertices.size()),
      cuts_(topology_.edges.size()),
      signs_(topology_.triangles.size()),
      edge_on_(topology_.surfaces.size()),
      edges_(topology_.edges.size()),
      sides_beyond_(topology_.vertices.size()),
      of_emitter_(topology_.vertices.size()) {}

void PointView::start(const Vec3& point, const Vec3& normal, int emitter, double jitter) {
  if (++query_ == 0) {  // after 2^32 queries every mark would look fresh
    for (auto* marks : {&vertices_, &cuts_, &signs_, &edge_on_, &edges_, &sides_beyond_})
      std::fill(marks->begin(), marks->end(), Kept{});
    std::fill(of_emitter_.begin(), of_emitter_.end(), 0);
    query_ = 1;
  }
  ++effort_.looks;
  corners.clear();
  next_rank_ = static_cast<std::int64_t>(topology_.vertices.size() + topology_.edges.size());
  among_ = nullptr;
  candidates_ = &everything_;
  point_ = point;
  jitter_ = jitter;
  normal_ = normal;
  emitter_id_ = emitter;
  emitter_ = &topology_.surfaces[at(emitter)].frame;
  distance_ = emitter_->height(point);
  magnitude_ = std::max(topology_.surfaces[at(emitter)].magnitude, point.lpNorm<Eigen::Infinity>());
  slack_ = margins::slack * magnitude_;
  mark_vertices(emitter);
}

void PointView::mark_vertices(int emitter) {
  const OpaqueTopology::OpaqueSurface& surface = topology_.surfaces[at(emitter)];
  for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r)
    for (const OpaqueTopology::OutlineVertex& corner : topology_.ring(r))
      of_emitter_[at(corner.vertex)] = query_;
}

double PointView::slack_at(const Vec3& position) const {
  return margins::slack *
         std::max(position.lpNorm<Eigen::Infinity>(), point_.lpNorm<Eigen::Infinity>());
}

double PointView::jitter_at(const Vec3& position) const {
  return jitter_ / margins::slack * slack_at(position);
}

int PointView::add_corner(const Vec3& position) { return add_corner(position, next_rank_++); }

int PointView::add_corner(const Vec3& position, std::int64_t rank) {
  Corner corner;
  corner.true_position = corner.position = position;
  if (jitter_ > 0) corner.position += scatter(rank, jitter_at(position), jitter_);
  corner.direction = corner.position - point_;
  corner.rank = rank;
  corner.height = emitter_->height(position);
  const double slack = std::max(slack_, slack_at(position));
  if (corner.height <= slack)
    corner.side = corner.height < -slack ? PlaneSide::beyond : PlaneSide::on;
  const double depth = -emitter_->normal.dot(corner.direction);
  corner.is_ahead = depth > margins::nearest_image * distance_;
  if (corner.is_ahead)
    corner.image = distance_ / depth *
                   Vec2(emitter_->e1.dot(corner.direction), emitter_->e2.dot(corner.direction));
  corners.push_back(corner);
  return static_cast<int>(corners.size()) - 1;
}

int PointView::corner_of_vertex(int vertex) {
  Kept& kept = vertices_[at(vertex)];
  if (is_fresh(kept)) return kept.value;
  kept = {query_, add_corner(topology_.vertices[at(vertex)], vertex)};
  if (of_emitter_[at(vertex)] == query_) {
    // Where it is joined with others it may lie off the plane.
    corners.back().height = 0;
    corners.back().side = PlaneSide::on;
  }
  return kept.value;
}

int PointView::corner_of_cut(int edge) {
  Kept& kept = cuts_[at(edge)];
  if (!is_fresh(kept)) {
    int from = corner_of_vertex(topology_.edges[at(edge)].from);
    int to = corner_of_vertex(topology_.edges[at(edge)].to);
    if (corners[at(from)].side == PlaneSide::beyond) std::swap(from, to);
    const Corner &a = corners[at(from)], &b = corners[at(to)];
    const Vec3 position =
        a.true_position + a.height / (a.height - b.height) * (b.true_position - a.true_position);
    const auto rank = static_cast<std::int64_t>(topology_.vertices.size()) + edge;
    kept = {query_, add_corner(position, rank)};
    corners.back().is_cut = true;
    corners.back().side = PlaneSide::on;
  }
  return kept.value;
}

int PointView::turn(int a, int b, int c) const {
  ++effort_.turns;
  const Corner &first = corners[at(a)], &second = corners[at(b)], &third = corners[at(c)];
  if (const int sign = clear_turn(first, second, third)) return sign;
  ++effort_.exact_turns;
  return turn_exactly(point_, first, second, third);
}

bool PointView::is_edge_on(int surface) {
  Kept& kept = edge_on_[at(surface)];
  if (!is_fresh(kept)) {
    const OpaqueTopology::OpaqueSurface& opaque = topology_.surfaces[at(surface)];
    const PlaneFrame& frame = opaque.frame;
    const double height = std::abs(frame.height(point_));
    const double slack =
        margins::slack * std::max(opaque.magnitude, point_.lpNorm<Eigen::Infinity>());
    kept = {query_,
            height <= slack ||
                (height <= opaque.tolerance.length &&
                 std::abs(frame.normal.dot(normal_)) > margins::same_normal && touches(surface))};
  }
  return kept.value != 0;
}

/// Whether the point lies over the surface or within the tolerance of its border.
bool PointView::touches(int id) const {
  const OpaqueTopology::OpaqueSurface& surface = topology_.surfaces[at(id)];
  bool inside = false;
  for (int r = surface.first_ring; r < surface.first_ring + surface.ring_count; ++r) {
    const auto ring = topology_.ring(r);
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const Vec2 a = surface.frame.to_plane(topology_.vertices[at(ring[k].vertex)]);
      const Vec2 b =
          surface.frame.to_plane(topology_.vertices[at(ring[(k + 1) % ring.size()].vertex)]);
      const Vec2 p = surface.frame.to_plane(point_), along = b - a;
      const double t = std::clamp(along.dot(p - a) / along.squaredNorm(), 0., 1.);
      if ((p - a - t * along).norm() <= surface.tolerance.length) return true;
      if ((a.y() > p.y()) != (b.y() > p.y()) &&
          p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        inside = !inside;
    }
  }
  return inside;
}

int PointView::face_sign(int triangle) {
  Kept& kept = signs_[at(triangle)];
  if (!is_fresh(kept)) {
    const OpaqueTopology::Triangle& face = topology_.triangles[at(triangle)];
    if (face.surface == emitter_id_) {
      kept = {query_, 0};
      return 0;
    }
    std::array<int, 3> c{};
    bool blocks = false, flat = true;
    const double length = topology_.surfaces[at(face.surface)].tolerance.length;
    for (std::size_t k = 0; k < 3; ++k) {
      c[k] = corner_of_vertex(face.corner[k]);
      blocks = blocks || corners[at(c[k])].side == PlaneSide::before;
      flat = flat && std::abs(corners[at(c[k])].height) <= length;
    }
    kept = {query_, blocks && !flat && !is_edge_on(face.surface) ? turn(c[0], c[1], c[2]) : 0};
  }
  return kept.value;
}

std::uint32_t PointView::sides_beyond(int vertex, const SightPyramid& pyramid) {
  Kept& kept = sides_beyond_[at(vertex)];
  if (!is_fresh(kept)) {
    const Vec3 direction = jitter_ > 0 ? corners[at(corner_of_vertex(vertex))].direction
                                       : Vec3(topology_.vertices[at(vertex)] - point_);
    std::uint32_t sides = 0;
    for (std::size_t k = 0; k < pyramid.sides.size(); ++k)
      if (pyramid.sides[k].dot(direction) > pyramid.slack) sides |= std::uint32_t{1} << k;
    kept = {query_, static_cast<int>(sides)};
  }
  return static_cast<std::uint32_t>(kept.value);
}

int PointView::clipped(int triangle, std::array<int, 4>& polygon) {
  const OpaqueTopology::Triangle& face = topology_.triangles[at(triangle)];
  std::array<int, 3> c{};
  bool is_beyond = false;
  for (std::size_t k = 0; k < 3; ++k) {
    polygon[k] = c[k] = corner_of_vertex(face.corner[k]);
    is_beyond = is_beyond || corners[at(c[k])].side == PlaneSide::beyond;
  }
  if (!is_beyond) return 3;
  int count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto from = static_cast<int>(corners[at(c[k])].side);
    const auto to = static_cast<int>(corners[at(c[(k + 1) % 3])].side);
    if (from <= 0) polygon[at(count++)] = c[k];
    if (from * to < 0) polygon[at(count++)] = corner_of_cut(face.edge[k]);
  }
  return count;
}

int PointView::winding(int a, int b, int c, const DirectionBeside& direction, int sign) const {
  const auto [v, w, side] = direction;
  if (v == b) return winding(b, c, a, direction, sign);
  if (v == c) return winding(c, a, b, direction, sign);
  if (sign == 0) sign = turn(a, b, c);
  if (v == a) {
    if (w == b) return side == sign ? sign : 0;
    if (w == c) return side == -sign ? sign : 0;
    return turn(a, b, w) == sign && turn(a, w, c) == sign ? sign : 0;
  }
  return turn(a, b, v) == sign && turn(b, c, v) == sign && turn(c, a, v) == sign ? sign : 0;
}

int PointView::layers_of(int triangle, const DirectionBeside& direction) {
  const int sign = face_sign(triangle);
  if (sign == 0) return 0;
  std::array<int, 4> p{};
  const int count = clipped(triangle, p);
  // A face that is not clipped runs as its sign says.
  const int known = count == 3 && !corners[at(p[0])].is_cut && !corners[at(p[1])].is_cut &&
                            !corners[at(p[2])].is_cut
                        ? sign
                        : 0;
  int sum = 0;
  for (int k = 2; k < count; ++k) sum += winding(p[0], p[at(k - 1)], p[at(k)], direction, known);
  if (sum != 0) layer_surfaces_.push_back(topology_.triangles[at(triangle)].surface);
  return sign * sum;
}

/// Calls visit(triangle) for all that may lie over a direction, and perhaps others, until it
/// returns true.
template <class Visit>
void PointView::visit_faces_along(const Vec3& direction, const Visit& visit) {
  if (among_ != nullptr) {
    std::find_if(among_->begin(), among_->end(), visit);
    return;
  }
  const double last = std::max(1., distance_ / -emitter_->normal.dot(direction));
  // The direction is off by its rounding, which grows along the ray; what reaches far is rounded as
  // far as it reaches.
  const Vec3 margin = Vec3::Constant(blur() * last);
  const double spread = 1 + margins::slack + 4 * jitter_;
  const Vec3 inverse = direction.unaryExpr(
      [](double d) { return 1 / (std::abs(d) > margins::least_slope ? d : margins::least_slope); });
  bool is_done = false;
  const auto is_passed = [&](int index) {
    if (is_done) return true;
    ++effort_.boxes;
    const Bounds& box = face_tree_.nodes[at(index)].box;
    const Vec3 low = (box.low - margin - point_).cwiseProduct(inverse);
    const Vec3 high = (box.high + margin - point_).cwiseProduct(inverse);
    const double enter = std::max(low.cwiseMin(high).maxCoeff(), 0.);
    const double leave = std::min(low.cwiseMax(high).minCoeff(), last * (1 + margins::slack));
    return enter > leave * spread;
  };
  walk_tree(face_tree_, is_passed, [&](int triangle) { is_done = is_done || visit(triangle); });
}

int PointView::layers_over(const DirectionBeside& direction) {
  layer_surfaces_.clear();
  // That of the corner may move while others are added.
  const Vec3 along = corners[at(direction.from)].direction;
  int sum = 0;
  visit_faces_along(along, [&](int triangle) {
    sum += layers_of(triangle, direction);
    return false;
  });
  return sum;
}

ClearSight PointView::clear_sight_past(int triangle, const Vec3& direction) {
  const int sign = face_sign(triangle);
  if (sign == 0) return ClearSight::seen;
  std::array<Vec3, 3> p;
  bool is_before = true;
  double nearest = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const Corner& c = corners[at(corner_of_vertex(topology_.triangles[at(triangle)].corner[k]))];
    p[k] = c.direction;
    is_before = is_before && c.side == PlaneSide::before;
    nearest = std::min(nearest, c.direction.norm());
  }
  const double margin = (margins::clearly_inside + 4 * blur() / nearest) * direction.norm();
  bool is_inside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 normal = p[k].cross(p[(k + 1) % 3]);
    // Corners that run counter-clockwise seen from the point turn the other way round its sight.
    const double depth = -sign * normal.dot(direction), border = margin * normal.norm();
    if (depth < -border) return ClearSight::seen;
    is_inside = is_inside && depth > border;
  }
  return is_inside && is_before ? ClearSight::hidden : ClearSight::unsure;
}

ClearSight PointView::clear_sight(const Vec3& direction) {
  ClearSight sight = ClearSight::seen;
  visit_faces_along(direction, [&](int triangle) {
    if (const ClearSight past = clear_sight_past(triangle, direction); past != ClearSight::seen)
      sight = past;
    return sight == ClearSight::hidden;
  });
  return sight;
}

}  // namespace halfshade
