#include "meshing/core/parallel.h"
#include "meshing/geometry/mix_bits.h"
#include "solver/factors/row_rays.h"
#include "solver/factors/surface_exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

namespace halfshade {
namespace {

/// Independent sequences of each row: what their means differ by is the error.
constexpr int scrambles = 16;
/// Standard errors that count as a bound; with so few sequences one in eight hundred is off by
/// more.
constexpr double deviations = 4;
/// Points of each sequence to begin with.
constexpr std::uint32_t fewest_points = 64;
/// Memory that counts of rows that are looked from at once may fill.
constexpr std::size_t most_counts = 1 << 24;

using Counts = std::vector<std::uint32_t>;

/// A row that rays are sent from, and what they have met, sequence by sequence.
struct SentRow {
  int row;
  std::array<Counts, scrambles> hits;
};

/// Form factors of a row, and their errors: to rows, to the surroundings together with unused
/// backs, to these backs alone.
struct RowMeans {
  Eigen::ArrayXd factor, error;
};

RowMeans means_of(const SentRow& sent, std::uint32_t points) {
  const auto columns = static_cast<Eigen::Index>(sent.hits.front().size());
  Eigen::ArrayXXd all(columns, scrambles);
  for (int s = 0; s < scrambles; ++s)
    all.col(s) = Eigen::Map<const Eigen::Array<std::uint32_t, Eigen::Dynamic, 1>>(
                     sent.hits[at(s)].data(), columns)
                     .cast<double>() /
                 points;
  all.row(columns - 2) += all.row(columns - 1);
  RowMeans means{all.rowwise().mean(), {}};
  const Eigen::ArrayXd variance =
      (all.colwise() - means.factor).square().rowwise().sum() / (scrambles * (scrambles - 1));
  // One ray more or less, where there are none or few.
  const double one = 1 / (static_cast<double>(scrambles) * points);
  means.error = deviations * (variance + one * one).sqrt();
  return means;
}

/// As errors go at best: with the number of rays to the power of −¾. By that it is told how many
/// rays a row takes at least.
constexpr double best_rate = 0.75;

struct RayLimits {
  std::uint32_t first, most;  ///< points of each sequence of a row
  double rays = HUGE_VAL;     ///< of all rows
};

std::uint32_t points_for(int rays) {
  return static_cast<std::uint32_t>(rays / scrambles + (rays % scrambles > 0 ? 1 : 0));
}

class RaySender {
 public:
  RaySender(const FactorScene& scene, const ReflectingScene& reflecting, double tolerance,
            const RayLimits& limits, const Progress& progress)
      : scene_(scene),
        reflecting_(reflecting),
        tolerance_(tolerance),
        limits_(limits),
        progress_(progress) {
    for (std::vector<int>& roots : roots_of_rows(scene, reflecting))
      places_.emplace_back(reflecting, std::move(roots));
  }

  /// Of some rows; false if stopped or given up.
  bool see(int first, int last, const std::function<void(int, const RowMeans&)>& use) {
    std::vector<SentRow> open;
    for (int row = first; row < last; ++row) {
      open.push_back({row, {}});
      open.back().hits.fill(Counts(at(scene_.rows() + 2)));
    }
    for (std::uint32_t points = 0, next = limits_.first; !open.empty();
         points = next, next = std::min(2 * next, limits_.most)) {
      const auto send = [&](std::size_t k) {
        SentRow& sent = open[k / scrambles];
        const std::size_t s = k % scrambles;
        const std::uint64_t seed = mix_bits(at(sent.row) * scrambles + s);
        count_rays(scene_, reflecting_, places_[at(sent.row)], {seed, points, next}, sent.hits[s]);
      };
      if (!parallel_for(open.size() * scrambles, send, progress_, "rays")) return false;
      rays_ += open.size() * scrambles * (next - points);
      double least_more = 0;
      std::erase_if(open, [&](const SentRow& sent) {
        const RowMeans means = means_of(sent, next);
        const double times_too_large = means.error.maxCoeff() / tolerance_;
        if (next < limits_.most && times_too_large > 1) {
          least_more += scrambles * next * (std::pow(times_too_large, 1 / best_rate) - 1);
          return false;
        }
        use(sent.row, means);
        return true;
      });
      const double share = static_cast<double>(last) / scene_.rows();
      if (static_cast<double>(rays_) + least_more > share * limits_.rays) return false;
    }
    return true;
  }

  std::size_t rays() const { return rays_; }

 private:
  const FactorScene& scene_;
  const ReflectingScene& reflecting_;
  double tolerance_;
  RayLimits limits_;
  const Progress& progress_;
  std::vector<RowPlaces> places_;  // of the rows
  std::size_t rays_ = 0;
};

/// The two directions of each pair, weighed by how exact the rows are that they start from: so
/// their mean is no less exact than either of these. `off` is the largest error of each row, as
/// mutual area.
void weigh_directions(const Eigen::ArrayXd& off, RowExchange& exchange) {
  RowMajorMatrix &mutual = exchange.mutual, &error = exchange.mutual_error;
  for (Eigen::Index i = 0; i < mutual.rows(); ++i)
    for (Eigen::Index j = i + 1; j < mutual.cols(); ++j) {
      // Weights are 1 / off², with nothing that may overflow.
      const double least = std::min(off[i], off[j]);
      const double p = std::pow(least / off[i], 2), q = std::pow(least / off[j], 2);
      mutual(i, j) = mutual(j, i) = (p * mutual(i, j) + q * mutual(j, i)) / (p + q);
      error(i, j) = error(j, i) = std::hypot(p * error(i, j), q * error(j, i)) / (p + q);
    }
}

/// Not complete if stopped or given up.
RowExchange exchange_by_rays(const FactorScene& scene, const ReflectingScene& reflecting,
                             double tolerance, const RayLimits& limits, const Progress& progress) {
  const int rows = scene.rows();
  RowExchange exchange(rows);
  exchange.report.method = FactorMethod::rays;
  Eigen::ArrayXd off(rows);
  const auto use = [&](int row, const RowMeans& means) {
    const double area = scene.areas[at(row)];
    exchange.mutual.row(row) = area * means.factor.head(rows);
    exchange.mutual_error.row(row) = area * means.error.head(rows);
    exchange.space[row] = area * means.factor[rows];
    exchange.space_error[row] = area * means.error[rows];
    exchange.backs[row] = area * means.factor[rows + 1];
    off[row] = area * means.error.head(rows).maxCoeff();
  };
  RaySender sender(scene, reflecting, tolerance, limits, progress);
  const std::size_t of_row = scrambles * at(rows + 2);
  const int together = static_cast<int>(std::max<std::size_t>(1, most_counts / of_row));
  for (int first = 0; first < rows && exchange.report.is_complete; first += together)
    exchange.report.is_complete = sender.see(first, std::min(rows, first + together), use);
  exchange.report.rays = sender.rays();
  if (exchange.report.is_complete) weigh_directions(off, exchange);
  return exchange;
}

}  // namespace

RowExchange sampled_exchange(const FactorScene& scene, const ReflectingScene& reflecting,
                             const FactorOptions& options, const Progress& progress) {
  const std::uint32_t most = points_for(options.rays > 0 ? options.rays : most_rays);
  return exchange_by_rays(scene, reflecting, options.tolerance,
                          {options.rays > 0 ? most : fewest_points, most}, progress);
}

std::optional<RowExchange> sampled_exchange_within(std::size_t rays, const FactorScene& scene,
                                                   const ReflectingScene& reflecting,
                                                   const FactorOptions& options,
                                                   const Progress& progress) {
  const RayLimits limits{fewest_points, points_for(most_rays), static_cast<double>(rays)};
  RowExchange exchange = exchange_by_rays(scene, reflecting, options.tolerance, limits, progress);
  if (!exchange.report.is_complete && !progress.stopped()) return {};
  return exchange;
}

}  // namespace halfshade
