#include "meshing/repair/planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <unordered_map>

namespace halfshade {
namespace {

// Normals of coplanar faces agree to this: six-digit coordinates turn a face of a hundredth of the
// scene by that much, while smooth surfaces bend more from face to face.
constexpr double normal_tolerance = 1e-4;

struct CellHash {
  template <std::size_t n>
  std::size_t operator()(const std::array<long long, n>& cell) const {
    std::size_t hash = 1469598103934665603u;
    for (const long long c : cell) hash = (hash ^ static_cast<std::size_t>(c)) * 1099511628211u;
    return hash ^ (hash >> 29);
  }
};

// Calls visit(cell) for every cell that can hold something within half a cell of x.
template <std::size_t n, class Visit>
void near_cells(const std::array<double, n>& x, const Visit& visit) {
  std::array<long long, n> home{};
  std::array<long long, n> step{};
  for (std::size_t d = 0; d < n; ++d) {
    home[d] = std::llround(std::floor(x[d]));
    step[d] = x[d] - std::floor(x[d]) < 0.5 ? -1 : 1;
  }
  for (std::size_t choice = 0; choice < (std::size_t{1} << n); ++choice) {
    std::array<long long, n> cell = home;
    for (std::size_t d = 0; d < n; ++d)
      if (choice >> d & 1) cell[d] += step[d];
    visit(cell);
  }
}

template <std::size_t n>
std::array<long long, n> cell_of(const std::array<double, n>& x) {
  std::array<long long, n> cell{};
  for (std::size_t d = 0; d < n; ++d) cell[d] = std::llround(std::floor(x[d]));
  return cell;
}

std::vector<Vec3> corners(std::span<const Vec3> points, const std::vector<int>& loop) {
  std::vector<Vec3> result;
  result.reserve(loop.size());
  for (const int p : loop) result.push_back(points[at(p)]);
  return result;
}

double greatest_height(const PlaneFrame& frame, std::span<const Vec3> points,
                       const std::vector<int>& loop) {
  double height = 0;
  for (const int p : loop) height = std::max(height, std::abs(frame.height(points[at(p)])));
  return height;
}

// Sorts polygons into the planes of the first ones.
class Classifier {
 public:
  // With `extrapolate`, a plane may miss a polygon by as much more as this lies farther away than
  // the polygon that defines the plane is large.
  Classifier(std::span<const Vec3> points, const Tolerance& tolerance, bool extrapolate)
      : points_(points), tolerance_(tolerance), extrapolate_(extrapolate), centre_(points[0]) {}

  int plane_of(const std::vector<int>& loop) {
    const PlaneFrame frame = fit_plane(corners(points_, loop));
    int best = -1;
    for (const double side : {1.0, -1.0})
      near_cells(key(frame, side), [&](const std::array<long long, 4>& cell) {
        const auto found = cells_.find(cell);
        if (found == cells_.end()) return;
        for (const int plane : found->second)
          if ((best < 0 || plane < best) && fits(frame, loop, plane)) best = plane;
      });
    if (best >= 0) return best;
    frames_.push_back(frame);
    extent_.push_back(extent(frame.origin, loop));
    const int plane = static_cast<int>(frames_.size()) - 1;
    cells_[cell_of(key(frame, 1))].push_back(plane);
    return plane;
  }

  const std::vector<PlaneFrame>& frames() const { return frames_; }

 private:
  // Planes of one class differ by less than half a cell in every coordinate.
  std::array<double, 4> key(const PlaneFrame& frame, double side) const {
    constexpr double cell = 4 * normal_tolerance;
    const Vec3 n = side * frame.normal / cell;
    const double offset =
        side * frame.normal.dot(frame.origin - centre_) / (cell * tolerance_.scene_size);
    return {n.x(), n.y(), n.z(), offset};
  }

  double extent(const Vec3& centre, const std::vector<int>& loop) const {
    double farthest = 0;
    for (const int p : loop) farthest = std::max(farthest, (points_[at(p)] - centre).norm());
    return farthest;
  }

  bool fits(const PlaneFrame& frame, const std::vector<int>& loop, int plane) const {
    const PlaneFrame& other = frames_[at(plane)];
    if (frame.normal.cross(other.normal).norm() > normal_tolerance) return false;
    double limit = tolerance_.planarity;
    if (extrapolate_) limit *= 1 + extent(other.origin, loop) / extent_[at(plane)];
    return greatest_height(other, points_, loop) <= limit;
  }

  std::span<const Vec3> points_;
  const Tolerance& tolerance_;
  bool extrapolate_;
  Vec3 centre_;
  std::vector<PlaneFrame> frames_;
  std::vector<double> extent_;  // of the polygon that defines the plane
  std::unordered_map<std::array<long long, 4>, std::vector<int>, CellHash> cells_;
};

// The plane of several polygons: the mean of their corners, the sum of their area vectors. Errors
// of inner corners cancel in the sum.
PlaneFrame common_plane(std::span<const Vec3> points, std::span<const std::vector<int>> loops,
                        const std::vector<std::size_t>& members, const PlaneFrame& first) {
  Vec3 normal = Vec3::Zero(), offset = Vec3::Zero();
  double count = 0;
  for (const std::size_t m : members) {
    const Vec3 area = area_vector(corners(points, loops[m]));
    normal += area.dot(first.normal) > 0 ? area : Vec3(-area);
    for (const int p : loops[m]) offset += points[at(p)] - first.origin;
    count += static_cast<double>(loops[m].size());
  }
  return make_frame(first.origin + offset / count, normal);
}

}  // namespace

WeldedVertices weld(const Scene& scene, const Tolerance& tolerance) {
  WeldedVertices result;
  result.of_vertex.assign(scene.vertices.size(), -1);
  std::vector<bool> used(scene.vertices.size(), false);
  std::optional<Vec3> origin;
  for (const Face& face : scene.faces)
    for (const int v : face.vertices) used[at(v)] = true;
  std::unordered_map<std::array<long long, 3>, std::vector<int>, CellHash> cells;
  for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
    if (!used[v]) continue;
    const Vec3& p = scene.vertices[v];
    if (!origin) origin = p;
    const Vec3 scaled = (p - *origin) / (2 * tolerance.length);
    const std::array<double, 3> key = {scaled.x(), scaled.y(), scaled.z()};
    int first = -1;
    near_cells(key, [&](const std::array<long long, 3>& cell) {
      const auto found = cells.find(cell);
      if (found == cells.end()) return;
      for (const int q : found->second)
        if ((result.points[at(q)] - p).norm() <= tolerance.length && (first < 0 || q < first))
          first = q;
    });
    if (first < 0) {
      first = static_cast<int>(result.points.size());
      result.points.push_back(p);
      cells[cell_of(key)].push_back(first);
    }
    result.of_vertex[v] = first;
  }
  return result;
}

PlaneClasses classify_planes(std::span<const Vec3> points, std::span<const std::vector<int>> loops,
                             const Tolerance& tolerance) {
  PlaneClasses result;
  if (loops.empty()) return result;
  // The largest polygon defines its plane best.
  std::vector<double> area;
  for (const auto& loop : loops) area.push_back(area_vector(corners(points, loop)).norm());
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return area[a] > area[b]; });
  // First by extrapolation, so that the small pieces of a tessellated wall come together ...
  Classifier loose(points, tolerance, true);
  std::vector<std::vector<std::size_t>> members;
  for (const std::size_t i : order) {
    const std::size_t group = at(loose.plane_of(loops[i]));
    if (group == members.size()) members.emplace_back();
    members[group].push_back(i);
  }
  // ... then by the common plane of those; the polygons this leaves out find planes of their own.
  result.of_polygon.assign(loops.size(), -1);
  std::vector<std::size_t> left;
  for (std::size_t g = 0; g < members.size(); ++g) {
    const auto all_within = [&](const PlaneFrame& frame, double limit) {
      return std::all_of(members[g].begin(), members[g].end(), [&](std::size_t i) {
        return greatest_height(frame, points, loops[i]) <= limit;
      });
    };
    PlaneFrame frame = loose.frames()[g];
    if (!all_within(frame, tolerance.length))
      frame = common_plane(points, loops, members[g], frame);
    for (const std::size_t i : members[g])
      if (greatest_height(frame, points, loops[i]) <= tolerance.planarity)
        result.of_polygon[i] = static_cast<int>(result.frames.size());
      else
        left.push_back(i);
    result.frames.push_back(frame);
  }
  Classifier strict(points, tolerance, false);
  const int first = static_cast<int>(result.frames.size());
  for (const std::size_t i : left) result.of_polygon[i] = first + strict.plane_of(loops[i]);
  result.frames.insert(result.frames.end(), strict.frames().begin(), strict.frames().end());
  return result;
}

}  // namespace halfshade
