#include "meshing/repair/planes.h"

#include "meshing/geometry/flat_tree.h"
#include "meshing/repair/common_area.h"
#include "meshing/repair/written_digits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

namespace halfshade {
namespace {

// Normals of coplanar faces agree to this: six-digit coordinates turn a face of a hundredth of
// their magnitude by that much, while smooth surfaces bend more from face to face.
constexpr double normal_tolerance = 1e-4;

/// What a polygon is compared by.
struct Polygon {
  std::vector<Vec3> corners;
  PlaneFrame frame;
  LocalScale scale;
  Bounds box;
  double area = 0;
  bool two_sided = false;
};

Polygon polygon_of(std::span<const Vec3> points, const std::vector<int>& loop,
                   const LocalScale& scale) {
  Polygon polygon;
  polygon.scale = scale;
  for (const int p : loop) polygon.corners.push_back(points[at(p)]);
  polygon.frame = fit_plane(polygon.corners);
  polygon.area = area_vector(polygon.corners).norm();
  for (const Vec3& p : polygon.corners) polygon.box.include(p);
  // Of the polygon's own; a neighbour that is larger comes to it.
  polygon.box = polygon.box.grown(tolerance_of(polygon.scale).planarity);
  return polygon;
}

double greatest_height(const PlaneFrame& frame, const std::vector<Vec3>& corners) {
  double height = 0;
  for (const Vec3& p : corners) height = std::max(height, std::abs(frame.height(p)));
  return height;
}

double greatest_distance(const Vec3& centre, const std::vector<Vec3>& corners) {
  double farthest = 0;
  for (const Vec3& p : corners) farthest = std::max(farthest, (p - centre).norm());
  return farthest;
}

bool look_the_same_way(const Polygon& a, const Polygon& b) {
  return a.frame.normal.dot(b.frame.normal) > 0;
}

bool are_parallel(const Polygon& a, const Polygon& b) {
  return a.frame.normal.cross(b.frame.normal).norm() <= normal_tolerance;
}

/// Heights between two polygons that the digits of their coordinates cannot tell from none.
double least_gap(const Polygon& a, const Polygon& b) {
  const LocalTolerance tolerance = tolerance_of(joint_scale(a.scale, b.scale));
  return std::clamp(rounding_between(a.corners, b.corners, b.frame.normal), tolerance.length,
                    tolerance.planarity);
}

/// Whether a polygon has corners on both sides of a plane, farther off than that.
bool is_on_both_sides(const std::vector<Vec3>& corners, const PlaneFrame& plane, double slack) {
  const auto has = [&](double side) {
    return std::any_of(corners.begin(), corners.end(),
                       [&](const Vec3& p) { return side * plane.height(p) > slack; });
  };
  return has(1) && has(-1);
}

/// Whether two polygons lie over each other and cut through each other there: no gap was meant. Of
/// the larger, which may reach far beyond the smaller one's plane, only the plane counts.
bool cut_through(const Polygon& a, const Polygon& b) {
  const Polygon &larger = a.area < b.area ? b : a, &smaller = a.area < b.area ? a : b;
  return is_on_both_sides(smaller.corners, larger.frame, least_gap(smaller, larger)) &&
         have_common_area(smaller.corners, larger.corners, larger.frame,
                          tolerance_of(joint_scale(a.scale, b.scale)));
}

/// How far a polygon's corners may be off a plane that it is to be in, which another one defines.
double planarity_limit(const Polygon& polygon, const Polygon& plane) {
  if (look_the_same_way(polygon, plane) || cut_through(polygon, plane))
    return tolerance_of(joint_scale(polygon.scale, plane.scale)).planarity;
  return least_gap(polygon, plane);
}

/// Whether two parallel polygons, which might come into one plane, lie over each other with a gap
/// between them that was meant.
bool lie_apart(const Polygon& a, const Polygon& b) {
  const Polygon &larger = a.area < b.area ? b : a, &smaller = a.area < b.area ? a : b;
  const double gap = std::abs(larger.frame.height(smaller.frame.origin));
  const LocalTolerance tolerance = tolerance_of(joint_scale(a.scale, b.scale));
  // Those of one class are off its plane by at most the planarity.
  return gap > tolerance.length && gap <= 2 * tolerance.planarity &&
         gap > least_gap(smaller, larger) &&
         have_common_area(smaller.corners, larger.corners, larger.frame, tolerance);
}

/// Finds polygons that are near another one and parallel to it. Sorted by their normals first: of
/// large ones that fill the same space all are near each other, but few are parallel.
class ParallelNeighbours {
 public:
  explicit ParallelNeighbours(const std::vector<Polygon>& polygons) : polygons_(polygons) {
    for (std::size_t i = 0; i < polygons.size(); ++i)
      buckets_[cell_of(polygons[i].frame.normal)].polygons.push_back(static_cast<int>(i));
    for (auto& [cell, bucket] : buckets_) {
      std::vector<Bounds> boxes;
      boxes.reserve(bucket.polygons.size());
      for (const int i : bucket.polygons) boxes.push_back(polygons[at(i)].box);
      bucket.tree = make_flat_tree(boxes, 1);
    }
  }

  /// Calls use(polygon) for all whose boxes meet that of `i`, and whose normals are its own or
  /// opposite to it within twice the tolerance, and perhaps for others.
  template <class Use>
  void visit(int i, Use&& use) const {
    const Polygon& polygon = polygons_[at(i)];
    for (const double sign : {1., -1.}) {
      const Cell low = cell_of(sign * polygon.frame.normal - reach());
      const Cell high = cell_of(sign * polygon.frame.normal + reach());
      for (int x = low[0]; x <= high[0]; ++x)
        for (int y = low[1]; y <= high[1]; ++y)
          for (int z = low[2]; z <= high[2]; ++z) {
            const auto found = buckets_.find({x, y, z});
            if (found == buckets_.end()) continue;
            visit_overlaps(found->second.tree, polygon.box,
                           [&](int item) { use(found->second.polygons[at(item)]); });
          }
    }
  }

 private:
  using Cell = std::array<int, 3>;
  struct Bucket {
    std::vector<int> polygons;
    FlatTree tree;  ///< over them
  };
  /// Far above the tolerance, so that a normal and what it may agree with mostly share a cell.
  static constexpr double cell_width = 0.01;

  static Vec3 reach() { return Vec3::Constant(2 * normal_tolerance); }
  static Cell cell_of(const Vec3& normal) {
    Cell cell{};
    for (std::size_t k = 0; k < 3; ++k)
      cell[k] = static_cast<int>(std::floor(normal[static_cast<int>(k)] / cell_width));
    return cell;
  }

  const std::vector<Polygon>& polygons_;
  std::map<Cell, Bucket> buckets_;
};

/// Collects polygons that lie in the plane of a first one and are near each other.
class PlaneGrower {
 public:
  explicit PlaneGrower(const std::vector<Polygon>& polygons)
      : polygons_(polygons),
        neighbours_(polygons),
        is_free_(polygons.size(), false),
        any_two_sided_(std::any_of(polygons.begin(), polygons.end(),
                                   [](const Polygon& polygon) { return polygon.two_sided; })),
        has_gap_(polygons.size()) {}

  void release(std::size_t polygon) { is_free_[polygon] = true; }
  bool is_free(std::size_t polygon) const { return is_free_[polygon]; }

  /// Takes the members of the plane of `seed` from the free polygons, itself first. With
  /// `extrapolate`, the plane may miss a polygon by as much more as this lies farther away than the
  /// seed is large.
  std::vector<std::size_t> grow(std::size_t seed, bool extrapolate) {
    std::vector<std::size_t> members = {seed};
    is_free_[seed] = false;
    const double extent = greatest_distance(origin(seed), polygons_[seed].corners);
    std::vector<int> near;
    for (std::size_t k = 0; k < members.size(); ++k) {
      near.clear();
      neighbours_.visit(static_cast<int>(members[k]), [&](int i) {
        if (is_free_[at(i)] && fits(seed, at(i), extrapolate ? extent : HUGE_VAL))
          near.push_back(i);
      });
      std::sort(near.begin(), near.end());
      for (const int i : near) {
        is_free_[at(i)] = false;
        members.push_back(at(i));
      }
    }
    return members;
  }

 private:
  const Vec3& origin(std::size_t i) const { return polygons_[i].frame.origin; }

  bool fits(std::size_t seed, std::size_t i, double extent) {
    const PlaneFrame& plane = polygons_[seed].frame;
    const Polygon& polygon = polygons_[i];
    if (!are_parallel(polygons_[seed], polygon)) return false;
    const double stretch = 1 + greatest_distance(origin(seed), polygon.corners) / extent;
    return greatest_height(plane, polygon.corners) <=
               stretch * planarity_limit(polygon, polygons_[seed]) &&
           !has_back_between(seed, i) && !has_gap_between(seed, i, stretch);
  }

  /// Whether something that looks the other way lies between two that look the same way, or on the
  /// front one: a thin sheet above a floor. In one plane they would come out inside out.
  bool has_back_between(std::size_t seed, std::size_t i) const {
    const PlaneFrame& plane = polygons_[seed].frame;
    const double height = plane.height(origin(i));
    const double slack =
        tolerance_of(joint_scale(polygons_[seed].scale, polygons_[i].scale)).length;
    if (!look_the_same_way(polygons_[seed], polygons_[i]) || std::abs(height) <= slack)
      return false;
    const double low = std::min(height, 0.) + slack, high = std::max(height, 0.) + slack;
    bool is_between = false;
    neighbours_.visit(static_cast<int>(i), [&](int k) {
      const Polygon& other = polygons_[at(k)];
      const double h = plane.height(other.frame.origin);
      is_between = is_between || (!other.two_sided && plane.normal.dot(other.frame.normal) < 0 &&
                                  h > low && h <= high);
    });
    return is_between;
  }

  /// Whether a two-sided polygon with a gap over or under it is one of the two or between them:
  /// that gap is not to be shut. `stretch`: how much more the plane may miss what lies far away.
  bool has_gap_between(std::size_t seed, std::size_t i, double stretch) {
    if (!any_two_sided_) return false;
    const PlaneFrame& plane = polygons_[seed].frame;
    const double height = plane.height(origin(i));
    const double length =
        tolerance_of(joint_scale(polygons_[seed].scale, polygons_[i].scale)).length;
    if (std::abs(height) <= length) return false;
    const double slack = stretch * least_gap(polygons_[i], polygons_[seed]);
    if (std::abs(height) <= slack) return false;
    if (has_gap(seed) || has_gap(i)) return true;
    bool is_between = false;
    neighbours_.visit(static_cast<int>(i), [&](int k) {
      const double h = plane.height(origin(at(k)));
      is_between = is_between || (h > std::min(height, 0.) - slack &&
                                  h < std::max(height, 0.) + slack && has_gap(at(k)));
    });
    return is_between;
  }

  /// Whether a polygon is two-sided and has another one over or under it. Neighbours in a sheet of
  /// many, which are off each other's planes by more than their digits tell, have nothing there.
  bool has_gap(std::size_t i) {
    if (!has_gap_[i]) {
      bool found = false;
      if (polygons_[i].two_sided)
        neighbours_.visit(static_cast<int>(i), [&](int k) {
          found = found || (at(k) != i && are_parallel(polygons_[i], polygons_[at(k)]) &&
                            lie_apart(polygons_[i], polygons_[at(k)]));
        });
      has_gap_[i] = found;
    }
    return *has_gap_[i];
  }

  const std::vector<Polygon>& polygons_;
  ParallelNeighbours neighbours_;
  std::vector<bool> is_free_;
  bool any_two_sided_ = false;
  std::vector<std::optional<bool>> has_gap_;  // as far as it was asked for
};

/// The plane of several polygons: the mean of their corners, the sum of their area vectors. Errors
/// of inner corners cancel in the sum.
PlaneFrame common_plane(const std::vector<Polygon>& polygons,
                        const std::vector<std::size_t>& members) {
  const PlaneFrame& first = polygons[members[0]].frame;
  Vec3 normal = Vec3::Zero(), offset = Vec3::Zero();
  double count = 0;
  for (const std::size_t m : members) {
    const Vec3 area = area_vector(polygons[m].corners);
    normal += area.dot(first.normal) > 0 ? area : Vec3(-area);
    for (const Vec3& p : polygons[m].corners) offset += p - first.origin;
    count += static_cast<double>(polygons[m].corners.size());
  }
  return make_frame(first.origin + offset / count, normal);
}

/// The plane that members have in common: that of the first if arithmetic cannot tell them apart.
PlaneFrame plane_of(const std::vector<Polygon>& polygons, const std::vector<std::size_t>& members) {
  const PlaneFrame& first = polygons[members[0]].frame;
  const bool is_exact = std::all_of(members.begin(), members.end(), [&](std::size_t m) {
    const LocalScale scale = joint_scale(polygons[m].scale, polygons[members[0]].scale);
    return greatest_height(first, polygons[m].corners) <= tolerance_of(scale).length;
  });
  return is_exact ? first : common_plane(polygons, members);
}

/// The first polygon between the same points, for each. What is modelled with a front and a back
/// has both between the same corners: they are in one plane, however little of it the digits tell.
std::vector<std::size_t> first_between_same_points(std::span<const std::vector<int>> loops) {
  std::map<std::vector<int>, std::size_t> first;
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    std::vector<int> points = loops[i];
    std::sort(points.begin(), points.end());
    result.push_back(first.emplace(std::move(points), i).first->second);
  }
  return result;
}

}  // namespace

PlaneClasses classify_planes(std::span<const Vec3> points, std::span<const std::vector<int>> loops,
                             std::span<const LocalScale> scales,
                             const std::vector<bool>& two_sided) {
  PlaneClasses result;
  result.of_polygon.assign(loops.size(), -1);
  std::vector<Polygon> polygons;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    polygons.push_back(polygon_of(points, loops[i], scales[i]));
    polygons.back().two_sided = !two_sided.empty() && two_sided[i];
  }
  // The largest polygon defines its plane best.
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return polygons[a].area > polygons[b].area;
  });
  const std::vector<std::size_t> first = first_between_same_points(loops);
  PlaneGrower grower(polygons);
  for (const std::size_t i : order)
    if (first[i] == i) grower.release(i);
  // First by extrapolation, so that the small pieces of a tessellated wall come together; the
  // polygons that the common plane of those leaves out find planes of their own.
  for (const bool extrapolate : {true, false}) {
    std::vector<std::size_t> left;
    for (const std::size_t seed : order) {
      if (!grower.is_free(seed)) continue;
      const std::vector<std::size_t> members = grower.grow(seed, extrapolate);
      const PlaneFrame frame =
          extrapolate ? plane_of(polygons, members) : polygons[members[0]].frame;
      for (const std::size_t m : members) {
        const double limit = planarity_limit(polygons[m], polygons[seed]);
        if (!extrapolate || greatest_height(frame, polygons[m].corners) <= limit)
          result.of_polygon[m] = static_cast<int>(result.frames.size());
        else
          left.push_back(m);
      }
      result.frames.push_back(frame);
    }
    for (const std::size_t m : left) grower.release(m);
  }
  for (std::size_t i = 0; i < first.size(); ++i) result.of_polygon[i] = result.of_polygon[first[i]];
  return result;
}

}  // namespace halfshade
