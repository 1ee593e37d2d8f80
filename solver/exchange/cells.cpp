#include "solver/exchange/cells.h"

#include "meshing/core/parallel.h"
#include "meshing/geometry/flat_tree.h"
#include "meshing/patches/shared_lines.h"
#include "solver/exchange/shells.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace halfshade {
namespace {

/// From the outermost point of a shell in this direction, a ray meets nothing of the shell itself.
/// No scene has edges in planes with it but by chance.
const Vec3 outwards = Vec3(0.5346127, 0.2803411, 0.7972053).normalized();
/// Barycentric coordinates this little below zero count as inside, so that no ray slips through an
/// edge.
constexpr double edge_margin = 1e-12;
/// What rounding may put a corner off, relative to its largest coordinate: shells thinner than this
/// are sheets.
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
/// So are those thinner than so many times what corners lie off their planes: splinters between
/// such corners may turn any way, and their sides may belong to no shell or to a wrong one.
constexpr double off_planes = 4;

struct RayHit {
  double distance = HUGE_VAL;
  int element = -1;
  bool is_front = false;
};

/// Distance along the ray to where it meets the element's triangle.
std::optional<double> meet(const std::array<Vec3, 3>& t, const Vec3& origin) {
  const Vec3 u = t[1] - t[0], v = t[2] - t[0], w = origin - t[0];
  const Vec3 p = outwards.cross(v), q = w.cross(u);
  const double determinant = u.dot(p);
  if (determinant == 0) return std::nullopt;
  const double b = w.dot(p) / determinant, c = outwards.dot(q) / determinant;
  if (!(b >= -edge_margin && c >= -edge_margin && b + c <= 1 + edge_margin)) return std::nullopt;
  return v.dot(q) / determinant;
}

/// The volume that a shell bounds: positive for the outside of a bounded cell, negative for a body
/// in a cell, zero for a sheet with both its sides.
std::vector<double> volumes(const SoundScene& scene, const ElementTable& elements,
                            const Shells& shells) {
  const std::size_t count = static_cast<std::size_t>(shells.count);
  std::vector<double> volume(count), doubt(count), area(count), off(count);
  std::vector<int> origin(count, -1);
  for (int e = 0; e < elements.count(); ++e) {
    const auto [front, back] = shells.of_side[at(e)];
    const auto [a, b, c] = elements.triangle(e);
    const PlaneFrame& frame = scene.surfaces[at(elements.surface[at(e)])].frame;
    const double height =
        std::max({std::abs(frame.height(a)), std::abs(frame.height(b)), std::abs(frame.height(c))});
    for (const auto& [shell, sign] : {std::pair(front, -1.), std::pair(back, 1.)}) {
      area[at(shell)] += elements.area[at(e)];
      off[at(shell)] = std::max(off[at(shell)], height);
      if (front == back) continue;
      int& first = origin[at(shell)];
      if (first < 0) first = elements.corners[at(e)][0];
      const Vec3& o = elements.points[at(first)];
      volume[at(shell)] += sign * (a - o).dot((b - o).cross(c - o)) / 6;
      doubt[at(shell)] +=
          rounding * elements.area[at(e)] * (a.lpNorm<1>() + b.lpNorm<1>() + c.lpNorm<1>());
    }
  }
  for (std::size_t k = 0; k < count; ++k)
    if (std::abs(volume[k]) <= doubt[k] + off_planes * off[k] * area[k]) volume[k] = 0;
  return volume;
}

/// The outermost point of every shell.
std::vector<Vec3> outermost_points(const ElementTable& elements, const Shells& shells) {
  std::vector<Vec3> points(static_cast<std::size_t>(shells.count));
  std::vector<double> highest(points.size(), -HUGE_VAL);
  for (int e = 0; e < elements.count(); ++e)
    for (const int shell : shells.of_side[at(e)])
      for (const Vec3& p : elements.triangle(e))
        if (const double height = outwards.dot(p); height > highest[at(shell)]) {
          highest[at(shell)] = height;
          points[at(shell)] = p;
        }
  return points;
}

/// Finds the elements that rays outwards may meet.
class RayIndex {
 public:
  explicit RayIndex(const ElementTable& elements) {
    across_ << outwards.unitOrthogonal(), outwards.cross(outwards.unitOrthogonal()), outwards;
    std::vector<Bounds> boxes(at(elements.count()));
    for (int e = 0; e < elements.count(); ++e) {
      Bounds box;
      double magnitude = 0;
      for (const Vec3& corner : elements.triangle(e)) {
        box.include(across_.transpose() * corner);
        magnitude = std::max(magnitude, corner.lpNorm<1>());
      }
      boxes[at(e)] =
          box.grown(edge_margin * (box.high - box.low).lpNorm<1>() + rounding * magnitude);
    }
    tree_ = make_flat_tree(boxes, 4);
  }

  /// Those that a ray may meet from `slack` behind its origin on, in their order.
  std::vector<int> near_ray(const Vec3& origin, double slack) const {
    Bounds ray;
    ray.include(across_.transpose() * (origin - slack * outwards));
    ray.high.z() = HUGE_VAL;
    std::vector<int> near;
    visit_overlaps(tree_, ray, [&](int e) { near.push_back(e); });
    std::sort(near.begin(), near.end());
    return near;
  }

 private:
  Eigen::Matrix3d across_;  ///< columns: two directions across, and outwards
  FlatTree tree_;
};

/// Shell → whether it is one of those that a ray starts from.
using IsOwn = std::function<bool(int)>;

bool has_own_side(const Shells& shells, int element, const IsOwn& is_own) {
  const auto [front, back] = shells.of_side[at(element)];
  return is_own(front) || is_own(back);
}

/// The planes of own elements, among some, that have a corner here.
std::vector<int> planes_at(const SoundScene& scene, const ElementTable& elements,
                           const Shells& shells, const IsOwn& is_own, const Vec3& corner,
                           const std::vector<int>& near) {
  std::vector<int> planes;
  for (const int e : near) {
    if (!has_own_side(shells, e, is_own)) continue;
    const auto corners = elements.triangle(e);
    if (std::find(corners.begin(), corners.end(), corner) != corners.end())
      planes.push_back(scene.surfaces[at(elements.surface[at(e)])].plane);
  }
  return planes;
}

/// The first thing that a ray from the outermost point of a shell, or of several, meets.
RayHit first_beyond(const SoundScene& scene, const ElementTable& elements, const RayIndex& index,
                    const Shells& shells, const IsOwn& is_own, const Vec3& origin) {
  // A point that touches another surface may lie beyond it by rounding.
  const double slack = tolerance_of({origin.lpNorm<Eigen::Infinity>(), scene.diagonal}).length;
  const std::vector<int> near = index.near_ray(origin, slack);
  // The other sides of the shell's own elements lie behind it.
  const std::vector<int> own = planes_at(scene, elements, shells, is_own, origin, near);
  const auto plane = [&](int element) {
    return scene.surfaces[at(elements.surface[at(element)])].plane;
  };
  RayHit hit;
  for (const int e : near) {
    if (has_own_side(shells, e, is_own)) continue;
    const std::optional<double> distance = meet(elements.triangle(e), origin);
    if (!distance || *distance < -slack) continue;
    if (*distance <= slack && std::find(own.begin(), own.end(), plane(e)) != own.end()) continue;
    const bool is_front = outwards.dot(elements.normal[at(e)]) < 0;
    // Of two that cover each other, the ray comes to the one first that looks at it.
    const bool covers = hit.element >= 0 && plane(e) == plane(hit.element);
    if (covers ? is_front && !hit.is_front : *distance < hit.distance)
      hit = {*distance, e, is_front};
  }
  return hit;
}

/// Shell → whether fronts look into it.
std::vector<bool> with_fronts(const Shells& shells) {
  std::vector<bool> has_fronts(at(shells.count));
  for (const auto& [front, back] : shells.of_side) has_fronts[at(front)] = true;
  return has_fronts;
}

/// Joins shells to those around them, or to the last set, which is what extends to infinity.
JoinedSets join_cells(const SoundScene& scene, const ElementTable& elements, const Shells& shells) {
  const std::vector<double> volume = volumes(scene, elements, shells);
  const std::vector<bool> has_fronts = with_fronts(shells);
  const std::vector<Vec3> points = outermost_points(elements, shells);
  const RayIndex index(elements);
  const auto beyond = [&](int shell, const IsOwn& is_own) {
    const RayHit hit = first_beyond(scene, elements, index, shells, is_own, points[at(shell)]);
    return hit.element < 0 ? shells.count : shells.of_side[at(hit.element)][hit.is_front ? 0 : 1];
  };
  // The outside of a bounded cell has none around it. Backs without any volume are those of
  // elements that cover each other.
  const auto is_outmost = [&](int k) {
    return volume[at(k)] > 0 || (volume[at(k)] == 0 && !has_fronts[at(k)]);
  };
  std::vector<int> around(volume.size());
  parallel_for(volume.size(), [&](std::size_t k) {
    const int shell = static_cast<int>(k);
    around[k] = is_outmost(shell) ? shell : beyond(shell, [&](int s) { return s == shell; });
  });
  JoinedSets sets(shells.count + 1);
  for (int k = 0; k < shells.count; ++k) sets.join(k, around[at(k)]);
  // Shells that touch at the outermost point of both are around each other: all of them look on.
  for (bool all_settled = false; !all_settled;) {
    const std::vector<int> set = sets.numbered();
    std::vector<bool> settled(at(shells.count + 1), false);
    settled[at(set.back())] = true;
    for (int k = 0; k < shells.count; ++k)
      if (around[at(k)] == k) settled[at(set[at(k)])] = true;
    std::vector<int> outermost(settled.size(), -1);  // set → shell
    for (int k = 0; k < shells.count; ++k)
      if (int& first = outermost[at(set[at(k)])];
          !settled[at(set[at(k)])] &&
          (first < 0 || outwards.dot(points[at(k)]) > outwards.dot(points[at(first)])))
        first = k;
    all_settled = true;
    for (const int shell : outermost) {
      if (shell < 0) continue;
      all_settled = false;
      sets.join(shell, beyond(shell, [&](int s) { return set[at(s)] == set[at(shell)]; }));
    }
  }
  return sets;
}

/// See SpaceCells::gaps.
std::vector<double> areas_of_gaps(const SoundScene& scene, const ElementTable& elements,
                                  const SpaceCells& cells) {
  std::vector<double> areas(cells.closed.size());
  if (std::none_of(cells.closed.begin(), cells.closed.end(), [](bool closed) { return closed; }))
    return areas;
  std::vector<std::vector<int>> closed_at(scene.surfaces.size());  // surface → cells
  for (int e = 0; e < elements.count(); ++e)
    if (cells.closed[at(cells.before(e))])
      closed_at[at(elements.surface[at(e)])].push_back(cells.before(e));
  const SharedLines shared = find_shared_lines(scene);
  for (const SharedLine& line : shared.lines) {
    if (line.gap <= line.length) continue;
    std::vector<int> at_line;
    for (const int w : line.borders) {
      const std::vector<int>& more = closed_at[at(shared.borders[at(w)].surface)];
      at_line.insert(at_line.end(), more.begin(), more.end());
    }
    std::sort(at_line.begin(), at_line.end());
    at_line.erase(std::unique(at_line.begin(), at_line.end()), at_line.end());
    for (const int cell : at_line) areas[at(cell)] += line.gap * line.extent;
  }
  return areas;
}

}  // namespace

SpaceCells find_cells(const SoundScene& scene, const ElementTable& elements) {
  const Shells shells = find_shells(scene, elements);
  JoinedSets sets = join_cells(scene, elements, shells);
  SpaceCells cells;
  const std::vector<int> cell_of = sets.numbered();
  const auto count =
      static_cast<std::size_t>(*std::max_element(cell_of.begin(), cell_of.end())) + 1;
  cells.closed.assign(count, true);
  cells.swallowing.assign(count, -1);
  cells.outside = cell_of.back();
  cells.closed[at(cells.outside)] = false;
  for (int e = 0; e < elements.count(); ++e) {
    const auto [front, back] = shells.of_side[at(e)];
    cells.of_side.push_back({cell_of[at(front)], cell_of[at(back)]});
    const std::size_t behind = at(cells.of_side.back()[1]);
    cells.closed[behind] = false;
    if (cells.swallowing[behind] < 0) cells.swallowing[behind] = elements.surface[at(e)];
  }
  cells.gaps = areas_of_gaps(scene, elements, cells);
  return cells;
}

}  // namespace halfshade
