#include "solver/exchange/assemble.h"

#include "meshing/core/parallel.h"
#include "solver/exchange/form_factor.h"
#include "solver/exchange/ray_factor.h"
#include "solver/exchange/surface_pairs.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <iterator>
#include <vector>

namespace halfshade {
namespace {

/// Rays for a pair lie between a quarter of the number asked for and four times that.
constexpr double ray_spread = 4;
/// Errors below this share of the tolerance times the smaller element's squared size do not matter.
constexpr double negligible = 0.01;
/// Rows of closed enclosures whose sums are off by more get more rays, this many times as many in
/// each of so many rounds; in the later ones only those that are off by much.
constexpr std::array near_closed = {4e-3, 1.5e-2, 1.5e-2};
constexpr int more_rays = 4;
struct Factor {
  int column;
  double value;
};

/// An element as the pair loop sees it.
struct Shape {
  PairEnd end;
  Vec3 centre;
  double radius, area;
  Eigen::AlignedBox3d box;
};

std::vector<Shape> make_shapes(const SoundScene& scene, const ElementTable& elements) {
  std::vector<Shape> shapes(elements.corners.size());
  for (int e = 0; e < elements.count(); ++e) {
    const auto k = static_cast<std::size_t>(e);
    const auto t = elements.triangle(e);
    Shape& shape = shapes[k];
    const int plane = scene.surfaces[static_cast<std::size_t>(elements.surface[k])].plane;
    shape.end = {t, elements.normal[k], plane};
    shape.centre = (t[0] + t[1] + t[2]) / 3;
    shape.radius = 0;
    shape.area = elements.area[k];
    for (const Vec3& p : t) {
      shape.radius = std::max(shape.radius, (p - shape.centre).norm());
      shape.box.extend(p);
    }
  }
  return shapes;
}

double lowest(const std::array<Vec3, 3>& triangle, const Vec3& point, const Vec3& normal) {
  return std::min({normal.dot(triangle[0] - point), normal.dot(triangle[1] - point),
                   normal.dot(triangle[2] - point)});
}

double highest(const std::array<Vec3, 3>& triangle, const Vec3& point, const Vec3& normal) {
  return std::max({normal.dot(triangle[0] - point), normal.dot(triangle[1] - point),
                   normal.dot(triangle[2] - point)});
}

/// A F of two elements as if nothing were between them.
double unobstructed(const Shape& a, const Shape& b, double tolerance, double margin) {
  const Vec3 &a_point = a.end.triangle[0], &b_point = b.end.triangle[0];
  if (highest(b.end.triangle, a_point, a.end.normal) <= margin ||
      highest(a.end.triangle, b_point, b.end.normal) <= margin)
    return 0;
  const double distance = (a.centre - b.centre).norm();
  const bool a_outside = a.radius <= b.radius;
  const Shape &outer = a_outside ? a : b, &inner = a_outside ? b : a;
  const int degree = sufficient_degree((distance - inner.radius) / outer.radius, tolerance);
  if (degree > 0 && lowest(b.end.triangle, a_point, a.end.normal) >= 0 &&
      lowest(a.end.triangle, b_point, b.end.normal) >= 0)
    return mutual_area_by_rule(outer.end.triangle, outer.end.normal, inner.end.triangle, degree);
  FormFactorOptions options;
  options.tolerance = tolerance;
  options.floor = negligible * tolerance * outer.radius * outer.radius;
  return std::max(0., mutual_area(outer.end.triangle, inner.end.triangle, options).value);
}

class Assembly {
 public:
  Assembly(const SoundScene& scene, const ElementTable& elements, const SpaceCells& cells,
           const VisibilityIndex& visibility, const ExchangeOptions& options,
           const Progress& progress)
      : scene_(scene),
        elements_(elements),
        cells_(cells),
        visibility_(visibility),
        options_(options),
        shapes_(make_shapes(scene, elements)),
        pairs_(scene, visibility, progress),
        run_end_(shapes_.size()),
        upper_(shapes_.size()),
        is_missing_(shapes_.size(), 1),
        effort_(shapes_.size(), 1) {
    for (std::size_t e = run_end_.size(); e-- > 0;) {
      const bool last = e + 1 == run_end_.size() || elements.surface[e] != elements.surface[e + 1];
      run_end_[e] = last ? static_cast<int>(e) + 1 : run_end_[e + 1];
    }
  }

  /// False if stopped.
  bool run(const Progress& progress) {
    return parallel_for(
               shapes_.size(), [&](std::size_t i) { fill_row(static_cast<int>(i)); }, progress,
               "form factors") &&
           refine(progress);
  }

  std::size_t rays() const { return rays_; }
  const std::vector<char>& is_missing() const { return is_missing_; }

  /// Rows that took more rays than others.
  std::size_t refined() const {
    return static_cast<std::size_t>(
        std::count_if(effort_.begin(), effort_.end(), [](int effort) { return effort > 1; }));
  }

  ExchangeMatrix matrix() const {
    const auto n = static_cast<Eigen::Index>(upper_.size());
    Eigen::VectorXi entries = Eigen::VectorXi::Zero(n);
    for (std::size_t i = 0; i < upper_.size(); ++i) {
      entries[static_cast<Eigen::Index>(i)] += static_cast<int>(upper_[i].size());
      for (const Factor& factor : upper_[i]) ++entries[factor.column];
    }
    // Rows come in ascending order, so each row receives its left half in order, then its right
    // half.
    ExchangeMatrix matrix(n, n);
    matrix.reserve(entries);
    for (std::size_t i = 0; i < upper_.size(); ++i)
      for (const Factor& factor : upper_[i]) {
        matrix.insert(static_cast<Eigen::Index>(i), factor.column) = factor.value;
        matrix.insert(factor.column, static_cast<Eigen::Index>(i)) = factor.value;
      }
    matrix.makeCompressed();
    return matrix;
  }

 private:
  /// More rays where more light is at stake: pairs with the mean form factor 1/n get the number
  /// asked for.
  int ray_count(int i, int j, double mutual_area) const {
    const Shape &a = shapes_[at(i)], &b = shapes_[at(j)];
    const double F = mutual_area / std::min(a.area, b.area);
    const double stake = std::sqrt(F * static_cast<double>(shapes_.size()));
    const int rays = std::max(1, static_cast<int>(options_.rays_per_pair *
                                                  std::clamp(stake, 1 / ray_spread, ray_spread)));
    return rays * std::max(effort_[at(i)], effort_[at(j)]);
  }

  /// Σ_j A_i F(i,j) of all rows, as they are.
  std::vector<double> row_sums() const {
    std::vector<double> sums(upper_.size());
    for (std::size_t i = 0; i < upper_.size(); ++i)
      for (const Factor& factor : upper_[i]) {
        sums[i] += factor.value;
        sums[at(factor.column)] += factor.value;
      }
    return sums;
  }

  /// In closed cells a row's sum is known: where it is off, rays missed or met too much. False if
  /// stopped.
  bool refine(const Progress& progress) {
    for (const double near : near_closed) {
      const std::vector<double> sums = row_sums();
      std::vector<char> is_off(sums.size());
      for (std::size_t i = 0; i < sums.size(); ++i)
        is_off[i] = cells_.closed[at(cells_.of_side[i][0])] && sums[i] > 0 &&
                    std::abs(sums[i] / shapes_[i].area - 1) > near;
      if (std::find(is_off.begin(), is_off.end(), 1) == is_off.end()) break;
      for (std::size_t i = 0; i < sums.size(); ++i)
        if (is_off[i]) effort_[i] *= more_rays;
      const auto again = [&](std::size_t i) { fill_row(static_cast<int>(i), &is_off); };
      if (!parallel_for(shapes_.size(), again, progress, "form factors")) return false;
    }
    return true;
  }

  /// The row's part right of the diagonal; with `only`, of it what belongs to one marked.
  void fill_row(int i, const std::vector<char>* only = nullptr) {
    RayVisibility sampler(visibility_);
    const Shape& a = shapes_[static_cast<std::size_t>(i)];
    const int r = elements_.surface[static_cast<std::size_t>(i)];
    const int cell = cells_.before(i);
    std::size_t rays = 0;
    auto& row = upper_[static_cast<std::size_t>(i)];
    std::vector<Factor> kept;
    if (only) {
      if (!(*only)[at(i)])
        std::copy_if(row.begin(), row.end(), std::back_inserter(kept),
                     [&](const Factor& factor) { return !(*only)[at(factor.column)]; });
      row.clear();
    }
    const std::size_t old = kept.size();
    for (int j = i + 1; j < elements_.count(); ++j) {
      const int s = elements_.surface[static_cast<std::size_t>(j)];
      const Sight sight = r == s ? Sight::none : pairs_.sight(r, s);
      if (sight == Sight::none) {
        j = run_end_[static_cast<std::size_t>(j)] - 1;
        continue;
      }
      if (cells_.before(j) != cell || (only && !(*only)[at(i)] && !(*only)[at(j)])) continue;
      const Shape& b = shapes_[static_cast<std::size_t>(j)];
      const double margin = tolerance_of(scene_.surfaces[at(r)], scene_.surfaces[at(s)]).length;
      double value = unobstructed(a, b, options_.tolerance, margin);
      if (!(value > 0)) continue;
      if (sight == Sight::sampled && a.box.merged(b.box).intersects(pairs_.blockers(r, s))) {
        const int count = ray_count(i, j, value);
        const auto seed =
            static_cast<std::uint64_t>(i) * shapes_.size() + static_cast<std::uint64_t>(j);
        value *= sampler.visible_fraction(a.end, b.end, count, seed);
        rays += static_cast<std::size_t>(count);
      }
      if (value > 0) row.push_back({j, value});
    }
    std::vector<Factor> all;
    all.reserve(old + row.size());
    std::merge(kept.begin(), kept.end(), row.begin(), row.end(), std::back_inserter(all),
               [](const Factor& p, const Factor& q) { return p.column < q.column; });
    row = std::move(all);
    is_missing_[at(i)] = 0;
    rays_ += rays;
  }

  const SoundScene& scene_;
  const ElementTable& elements_;
  const SpaceCells& cells_;
  const VisibilityIndex& visibility_;
  ExchangeOptions options_;
  std::vector<Shape> shapes_;
  SurfacePairs pairs_;
  std::vector<int> run_end_;  ///< element → end of the run of elements of its surface
  std::vector<std::vector<Factor>> upper_;
  std::vector<char> is_missing_;  ///< row of upper_ → not reached
  std::vector<int> effort_;       ///< element → times as many rays
  std::atomic<std::size_t> rays_ = 0;
};

}  // namespace

AssembledFactors assemble_factors(const SoundScene& scene, const ElementTable& elements,
                                  const SpaceCells& cells, const VisibilityIndex& visibility,
                                  const ExchangeOptions& options, const Progress& progress) {
  Assembly assembly(scene, elements, cells, visibility, options, progress);
  AssembledFactors result;
  result.complete = assembly.run(progress);
  result.rays = assembly.rays();
  result.refined_rows = assembly.refined();
  result.matrix = assembly.matrix();
  result.is_missing = assembly.is_missing();
  return result;
}

}  // namespace halfshade
