#include "solver/reflected/irradiance_row.h"

#include "meshing/core/planar.h"
#include "solver/reflected/forest_field.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Parts whose area is this share of a triangle's or more are all of it, and 1 − this nothing.
constexpr double nearly_all = 1 - 1e-11;
/// Moments may miss the form factor by so many times what each part of them may be off, and are off
/// by rounding anyway.
constexpr double parts_off = 3, rounding_off = 1e-9;
/// Those that miss it by more are found with so much less for each part.
constexpr double finer = 1e-3;
/// Relative to coordinates, and far above what corners are off: those this close to a line lie on
/// it. Rings that end at triangles'
/// edges come out the same then, whatever rounding says: quadrature begins at their first corner.
constexpr double on_line = 1e-11;

/// Light changes over no less than so many times the size of the leaves that were made for it.
constexpr double even_leaves = 5;

double signed_area(const Ring& ring) {
  double twice = 0;
  for (std::size_t k = 2; k < ring.size(); ++k)
    twice += cross_2d(ring[k - 1] - ring[0], ring[k] - ring[0]);
  return 0.5 * twice;
}

/// The part on the left of the line from a to b (Sutherland and Hodgman 1974).
Ring left_of(const Vec2& a, const Vec2& b, const Ring& ring) {
  Ring result;
  const Vec2 along = b - a;
  double largest = std::max(a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff());
  for (const Vec2& p : ring) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  const double least = -on_line * largest * along.norm();
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 &p = ring[k], &q = ring[(k + 1) % ring.size()];
    const double at_p = cross_2d(along, p - a), at_q = cross_2d(along, q - a);
    if (at_p >= least) result.push_back(p);
    if ((at_p >= least) != (at_q >= least)) result.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return result;
}

std::vector<Ring> clip(const std::vector<Ring>& rings, const std::array<Vec2, 3>& triangle) {
  std::vector<Ring> result;
  for (Ring ring : rings) {
    for (std::size_t k = 0; k < 3 && ring.size() > 2; ++k)
      ring = left_of(triangle[k], triangle[(k + 1) % 3], ring);
    if (ring.size() > 2) result.push_back(std::move(ring));
  }
  return result;
}

/// The distance of the farthest corner from the centroid.
double size_of(const std::array<Vec2, 3>& triangle) {
  const Vec2 centre = (triangle[0] + triangle[1] + triangle[2]) / 3;
  double square = 0;
  for (const Vec2& p : triangle) square = std::max(square, (p - centre).squaredNorm());
  return std::sqrt(square);
}

/// The walk through the triangles of one surface.
class Walk {
 public:
  Walk(const ReflectedMesh& mesh, std::span<const std::array<Vec2, 3>> corners,
       std::span<const double> least, const RowAccuracy& accuracy, const PointAbovePlane& from,
       IrradianceRow& row)
      : mesh_(mesh),
        corners_(corners),
        least_(least),
        accuracy_(accuracy),
        from_(from),
        row_(row) {}

  /// All of a triangle is seen.
  void whole(int t) {
    if (!mesh_.forest.is_leaf(t) && !can_stand(t, true)) return halves(t, [&](int h) { whole(h); });
    KernelMoments moments(from_, corners_[at(t)], forest_order(mesh_, t), accuracy_.moments);
    const auto& [a, b, c] = corners_[at(t)];
    moments.add(a, b, c);
    keep(t, moments);
  }

  /// What of a triangle lies in rings is seen.
  void cut(int t, const std::vector<Ring>& rings) {
    const std::vector<Ring> inside = clip(rings, corners_[at(t)]);
    double area = 0;
    for (const Ring& ring : inside) area += signed_area(ring);
    const double all = mesh_.forest.area(t);
    if (area <= (1 - nearly_all) * all) return;
    if (area >= nearly_all * all) return whole(t);
    if (!mesh_.forest.is_leaf(t) && !can_stand(t, false))
      return halves(t, [&](int h) { cut(h, inside); });
    KernelMoments moments(from_, corners_[at(t)], forest_order(mesh_, t), accuracy_.moments);
    for (const Ring& ring : inside) moments.add(ring);
    keep(t, moments);
  }

  double sum() const { return sum_; }

 private:
  template <typename Visit>
  void halves(int t, const Visit& visit) {
    const int half = mesh_.forest.first_half(t);
    visit(half);
    visit(half + 1);
  }

  /// Whether the leaves below a triangle are too small to tell apart. Where all of it is seen, what
  /// the projection on it loses meets only what of the kernel it cannot take; where it is cut, it
  /// has to be near what leaves the leaves: none of them is so small that light was found to change
  /// there.
  bool can_stand(int t, bool is_whole) const {
    const auto& [a, b, c] = corners_[at(t)];
    const Vec2 centre = (a + b + c) / 3;
    const double size = size_of(corners_[at(t)]);
    const double distance =
        std::sqrt((centre - from_.foot).squaredNorm() + from_.height * from_.height);
    constexpr double too_close = 0.7;
    if (size > too_close * distance) return false;
    const double factor = std::min(1., mesh_.forest.area(t) / (M_PI * distance * distance));
    const double length = std::min(accuracy_.length, even_leaves * least_[at(t)]);
    const double share = std::min(size / (is_whole ? distance : length), 1.);
    return factor * whole_power(share, mesh_.highest_order + 1) < accuracy_.collapse;
  }

  void keep(int t, const KernelMoments& moments) {
    const auto values = moments.values();
    row_.triangle.push_back(t);
    row_.first.push_back(static_cast<int>(row_.moments.size()));
    row_.moments.insert(row_.moments.end(), values.begin(), values.end());
    sum_ += values[0];
  }

  const ReflectedMesh& mesh_;
  std::span<const std::array<Vec2, 3>> corners_;
  std::span<const double> least_;
  const RowAccuracy& accuracy_;
  PointAbovePlane from_;
  IrradianceRow& row_;
  double sum_ = 0;
};

}  // namespace

Rgb irradiance(const IrradianceRow& row, const QuickField& leaving) {
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 0; k < row.triangle.size(); ++k) {
    const Rgb* powers = leaving.powers(row.triangle[k]);
    for (int i = row.first[k]; i < row.first[k + 1]; ++i) sum += row.moments[at(i)] * *powers++;
  }
  return sum;
}

RowMaker::RowMaker(const ExactSight& sight, const ReflectedMesh& mesh, const RowAccuracy& accuracy)
    : sight_(sight), mesh_(mesh), accuracy_(accuracy) {
  std::vector<int> surface(at(mesh.forest.root_count()));
  for (int s = 0; s < static_cast<int>(sight.scene().surfaces.size()); ++s)
    for (const int root : sight.roots(s)) surface[at(root)] = s;
  for (int t = 0; t < mesh.forest.count(); ++t) {
    const auto& [a, b, c] = mesh.forest.corners(t);
    const PlaneFrame& frame = sight.scene().surfaces[at(surface[at(mesh.forest.root(t))])].frame;
    corners_.push_back({frame.to_plane(a), frame.to_plane(b), frame.to_plane(c)});
  }
  least_.resize(at(mesh.forest.count()));
  for (int t = mesh.forest.count() - 1; t >= 0; --t) {
    const int half = mesh.forest.is_leaf(t) ? -1 : mesh.forest.first_half(t);
    least_[at(t)] =
        half < 0 ? size_of(corners_[at(t)]) : std::min(least_[at(half)], least_[at(half + 1)]);
  }
}

double RowAccuracy::allowed() const { return std::max(parts_off * moments, rounding_off); }

double RowMaker::add(const SurfacePoint& point, int surface, const SeenPart& seen,
                     const RowAccuracy& accuracy, IrradianceRow& row) const {
  Walk walk(mesh_, corners_, least_, accuracy,
            above_plane(point.position, point.normal, sight_.scene().surfaces[at(surface)].frame),
            row);
  for (const int root : sight_.roots(surface))
    seen.is_whole ? walk.whole(root) : walk.cut(root, seen.rings);
  return walk.sum();
}

void RowMaker::add_scaled(const SurfacePoint& point, int surface, const SeenPart& seen,
                          IrradianceRow& row) const {
  const std::size_t triangles = row.triangle.size(), moments = row.moments.size();
  const auto take_back = [&] {
    row.triangle.resize(triangles);
    row.first.resize(triangles);
    row.moments.resize(moments);
  };
  const double allowed = accuracy_.allowed();
  double sum = add(point, surface, seen, accuracy_, row);
  if (!(std::abs(sum - seen.factor) <= allowed)) {
    take_back();
    RowAccuracy better = accuracy_;
    better.moments *= finer;
    sum = add(point, surface, seen, better, row);
  }
  double off = std::abs(sum - seen.factor);
  if (sum > 0 && std::isfinite(sum)) {
    for (std::size_t i = moments; i < row.moments.size(); ++i) row.moments[i] *= seen.factor / sum;
  } else {
    take_back();
    off = seen.factor;
  }
  row.off += off;
  if (off > allowed) row.unsure += off;
}

IrradianceRow RowMaker::row(const SurfacePoint& point, std::span<const Sighted> targets) const {
  IrradianceRow row;
  make(point, targets, row);
  return row;
}

void RowMaker::make(const SurfacePoint& point, std::span<const Sighted> targets,
                    IrradianceRow& row) const {
  row.triangle.clear();
  row.first.clear();
  row.moments.clear();
  row.sum = row.off = row.unsure = 0;
  SeenPart seen;
  for (const Sighted& target : targets) {
    sight_.see(point, target, seen);
    if (!(seen.factor > 0)) continue;
    add_scaled(point, target.surface, seen, row);
    row.sum += seen.factor;
  }
  row.first.push_back(static_cast<int>(row.moments.size()));
  if (row.sum - 1 > accuracy_.allowed()) row.unsure += row.sum - 1;
}

}  // namespace halfshade
