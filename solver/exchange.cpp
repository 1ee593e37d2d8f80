#include "solver/exchange.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "solver/form_factor.h"
#include "solver/ray_factor.h"
#include "solver/receiver_pairs.h"
#include "solver/scaled_operator.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <unistd.h>
#include <vector>

namespace halfshade {
namespace {

/// Rays an element sends out to find an opening of the scene.
constexpr int escape_rays = 64;
/// The part of the machine's memory that a matrix may fill.
constexpr double memory_share = 0.7;
/// A non-zero of the matrix (12 bytes) and of the half of it that is held before (16 bytes).
constexpr double bytes_per_factor = 20;

struct Factor {
  int column;
  double value;
};

/// An element as the pair loop sees it.
struct Shape {
  PairEnd end;
  Vec3 centre;
  double radius;
  Eigen::AlignedBox3d box;
  bool emits;
};

std::vector<Shape> make_shapes(const SoundScene& scene, const ElementTable& elements) {
  std::vector<Shape> shapes(elements.corners.size());
  for (int e = 0; e < elements.count(); ++e) {
    const auto k = static_cast<std::size_t>(e);
    const auto t = elements.triangle(e);
    Shape& shape = shapes[k];
    const int plane = scene.receivers[static_cast<std::size_t>(elements.receiver[k])].plane;
    shape.end = {t, elements.normal[k], plane};
    shape.centre = (t[0] + t[1] + t[2]) / 3;
    shape.radius = 0;
    for (const Vec3& p : t) {
      shape.radius = std::max(shape.radius, (p - shape.centre).norm());
      shape.box.extend(p);
    }
    const auto material = static_cast<std::size_t>(elements.material[k]);
    shape.emits = (scene.materials[material].exitance > 0).any();
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
  options.floor = 0.01 * tolerance * outer.radius * outer.radius;
  return std::max(0., mutual_area(outer.end.triangle, inner.end.triangle, options).value);
}

class Assembly {
 public:
  Assembly(const SoundScene& scene, const ElementTable& elements, const VisibilityIndex& visibility,
           const ExchangeOptions& options, const Progress& progress)
      : scene_(scene),
        elements_(elements),
        visibility_(visibility),
        options_(options),
        shapes_(make_shapes(scene, elements)),
        pairs_(scene, visibility, progress),
        upper_(shapes_.size()) {}

  /// False if stopped.
  bool run(const Progress& progress) {
    return parallel_for(
        shapes_.size(), [&](std::size_t i) { fill_row(static_cast<int>(i)); }, progress,
        "form factors");
  }

  std::size_t rays() const { return rays_; }

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
  void fill_row(int i) {
    RayVisibility sampler(visibility_);
    const Shape& a = shapes_[static_cast<std::size_t>(i)];
    const int r = elements_.receiver[static_cast<std::size_t>(i)];
    std::size_t rays = 0;
    auto& row = upper_[static_cast<std::size_t>(i)];
    for (int j = i + 1; j < elements_.count(); ++j) {
      const int s = elements_.receiver[static_cast<std::size_t>(j)];
      const Sight sight = r == s ? Sight::none : pairs_.sight(r, s);
      if (sight == Sight::none) continue;
      const Shape& b = shapes_[static_cast<std::size_t>(j)];
      double value = unobstructed(a, b, options_.tolerance, scene_.tolerance.length);
      if (!(value > 0)) continue;
      if (sight == Sight::sampled && a.box.merged(b.box).intersects(pairs_.blockers(r, s))) {
        const int count =
            a.emits || b.emits ? options_.rays_per_emitter_pair : options_.rays_per_pair;
        const auto seed =
            static_cast<std::uint64_t>(i) * shapes_.size() + static_cast<std::uint64_t>(j);
        value *= sampler.visible_fraction(a.end, b.end, count, seed);
        rays += static_cast<std::size_t>(count);
      }
      if (value > 0) row.push_back({j, value});
    }
    row.shrink_to_fit();
    rays_ += rays;
  }

  const SoundScene& scene_;
  const ElementTable& elements_;
  const VisibilityIndex& visibility_;
  ExchangeOptions options_;
  std::vector<Shape> shapes_;
  ReceiverPairs pairs_;
  std::vector<std::vector<Factor>> upper_;
  std::atomic<std::size_t> rays_ = 0;
};

/// Where rays from one element end.
enum class Surroundings { closed, open, sealed /* sees only back sides: inside a solid */ };

Surroundings look_round(const SoundScene& scene, const ElementTable& elements,
                        const VisibilityIndex& visibility, int element) {
  const auto e = static_cast<std::size_t>(element);
  const auto t = elements.triangle(element);
  const PlaneFrame frame =
      make_frame((t[0] + t[1] + t[2]) / 3 + scene.tolerance.planarity * elements.normal[e],
                 elements.normal[e]);
  int fronts = 0, backs = 0;
  for (int k = 0; k < escape_rays; ++k) {
    // Cosine-distributed directions on a spiral (Vogel 1979): equal shares of the projected
    // hemisphere.
    const double radius = std::sqrt((k + 0.5) / escape_rays);
    const double angle = k * std::numbers::pi * (3 - std::sqrt(5.));
    const Vec3 direction = radius * std::cos(angle) * frame.e1 +
                           radius * std::sin(angle) * frame.e2 +
                           std::sqrt(1 - radius * radius) * frame.normal;
    const auto hit = visibility.first_hit(frame.origin, direction);
    if (!hit) return Surroundings::open;
    const Receiver& receiver = scene.receivers[static_cast<std::size_t>(hit->owner)];
    const bool front = receiver.frame.normal.dot(direction) < 0 ||
                       scene.materials[static_cast<std::size_t>(receiver.material)].two_sided;
    ++(front ? fronts : backs);
  }
  if (backs == 0) return Surroundings::closed;
  return fronts == 0 ? Surroundings::sealed : Surroundings::open;
}

bool is_closed(const SoundScene& scene, const ElementTable& elements,
               const VisibilityIndex& visibility) {
  std::vector<Surroundings> around(elements.corners.size());
  parallel_for(around.size(), [&](std::size_t e) {
    around[e] = look_round(scene, elements, visibility, static_cast<int>(e));
  });
  return std::find(around.begin(), around.end(), Surroundings::open) == around.end() &&
         std::find(around.begin(), around.end(), Surroundings::closed) != around.end();
}

void require_memory(std::size_t elements) {
  const double available = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                           static_cast<double>(sysconf(_SC_PAGESIZE)) * memory_share;
  const double n = static_cast<double>(elements), needed = n * n * bytes_per_factor;
  if (needed > available || n * n >= 2147483648.)
    throw Error(
        ErrorCode::too_large, "compute_exchange",
        fmt::format("form factors among {} elements may take {:.1f} GB, more than {:.1f} GB that "
                    "can be used (and at most 46340 elements); ask for fewer elements",
                    elements, needed / 1e9, available / 1e9));
}

void report_closure(Exchange& exchange) {
  const Eigen::ArrayXd sums =
      multiply(exchange.matrix, Eigen::VectorXd::Ones(exchange.area.size())).array() /
      exchange.area;
  // Elements that see nothing lie sealed inside a solid; closure says nothing about them.
  const Eigen::ArrayXd missing = (sums > 0).select(1 - sums, 0.);
  const double total = exchange.area.sum();
  exchange.report.closure_error_max = missing.abs().maxCoeff();
  exchange.report.closure_error_rms = std::sqrt((exchange.area * missing.square()).sum() / total);
  exchange.report.escaping_fraction = (exchange.area * missing.max(0.)).sum() / total;
}

}  // namespace

Exchange compute_exchange(const SoundScene& scene, const ElementTable& elements,
                          const VisibilityIndex& visibility, const ExchangeOptions& options,
                          const Progress& progress) {
  if (!(options.tolerance > 0 && options.tolerance < 1) || options.rays_per_pair < 1 ||
      options.rays_per_emitter_pair < 1)
    throw Error(
        ErrorCode::contract, "compute_exchange",
        fmt::format(
            "tolerance {} must lie in (0, 1) and rays per pair {} and {} must be at least 1",
            options.tolerance, options.rays_per_pair, options.rays_per_emitter_pair));
  require_memory(elements.corners.size());
  Exchange exchange;
  exchange.area = Eigen::Map<const Eigen::ArrayXd>(elements.area.data(),
                                                   static_cast<Eigen::Index>(elements.area.size()));
  {
    Assembly assembly(scene, elements, visibility, options, progress);
    exchange.report.complete = assembly.run(progress);
    exchange.report.rays = assembly.rays();
    exchange.matrix = assembly.matrix();
  }
  exchange.report.factors = static_cast<std::size_t>(exchange.matrix.nonZeros());
  exchange.report.closed = is_closed(scene, elements, visibility);
  report_closure(exchange);
  const bool wanted = options.closure == Closure::enforce ||
                      (options.closure == Closure::automatic && exchange.report.closed);
  if (wanted && exchange.report.complete)
    exchange.report.closure_enforced = enforce_closure(exchange.matrix, exchange.area);
  return exchange;
}

}  // namespace halfshade
