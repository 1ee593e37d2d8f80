#include "solver/exchange/exchange.h"

#include "meshing/core/error.h"
#include "solver/exchange/assemble.h"
#include "solver/exchange/cells.h"
#include "solver/exchange/enclosures.h"
#include "solver/exchange/estimated_factors.h"
#include "solver/exchange/point_factors.h"
#include "solver/exchange/scaled_operator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unistd.h>
#include <vector>

namespace halfshade {
namespace {

/// The part of the machine's memory that a matrix may fill.
constexpr double memory_share = 0.7;
/// Rows that are off by more than this are not put right by scaling: light was lost on the way.
constexpr double far_off = 0.03;
/// The same where factors are from points: those of neighbours are off by much, and scaling is all
/// that can be done.
constexpr double far_off_from_points = 0.5;
/// Estimated rows may be off by so many standard deviations more.
constexpr double most_deviations = 6;
/// A non-zero of the matrix (12 bytes) and its half of a pair that is held before (16 bytes).
constexpr double bytes_per_factor = 20;
/// The same with factors from points, of which each pair has two.
constexpr double bytes_per_point_factor = 40;

void require_memory(const ElementTable& elements, FactorsBy factors) {
  // Elements of one surface do not see each other.
  std::vector<double> in_surface;
  for (const int r : elements.surface) {
    in_surface.resize(std::max(in_surface.size(), static_cast<std::size_t>(r) + 1));
    ++in_surface[static_cast<std::size_t>(r)];
  }
  const double n = static_cast<double>(elements.corners.size());
  double pairs = n * n;
  for (const double m : in_surface) pairs -= m * m;
  const double available = static_cast<double>(sysconf(_SC_PHYS_PAGES)) *
                           static_cast<double>(sysconf(_SC_PAGESIZE)) * memory_share;
  const double needed =
      pairs * (factors == FactorsBy::rays ? bytes_per_factor : bytes_per_point_factor);
  if (needed > available || pairs > std::numeric_limits<int>::max())
    throw Error(
        ErrorCode::too_large, "compute_exchange",
        fmt::format("form factors among {} elements may take {:.1f} GB, more than {:.1f} GB that "
                    "can be used, or too many to count; ask for fewer elements",
                    elements.corners.size(), needed / 1e9, available / 1e9));
}

void report_closure(Exchange& exchange) {
  const Eigen::ArrayXd missing =
      1 - multiply(exchange.matrix, Eigen::VectorXd::Ones(exchange.area.size())).array() /
              exchange.area;
  ExchangeReport& report = exchange.report;
  report.closed = true;
  double closed_area = 0, lit_area = 0;
  for (int e = 0; e < exchange.area.size(); ++e) {
    const double area = exchange.area[e], error = missing[e];
    if (exchange.enclosures.is_closed(e)) {
      report.closure_error_max = std::max(report.closure_error_max, std::abs(error));
      report.closure_error_rms += area * error * error;
      closed_area += area;
    }
    if (exchange.enclosures.is_lit(e)) {
      report.closed = report.closed && exchange.enclosures.is_closed(e);
      report.escaping_fraction += area * std::max(error, 0.);
      lit_area += area;
    }
  }
  if (closed_area > 0) report.closure_error_rms = std::sqrt(report.closure_error_rms / closed_area);
  if (lit_area > 0) report.escaping_fraction /= lit_area;
}

/// Variance of the share of its light that a row's estimated factors account for.
Eigen::ArrayXd variance_of_rows(const Exchange& exchange) {
  if (exchange.variance.nonZeros() == 0) return Eigen::ArrayXd::Zero(exchange.area.size());
  return multiply(exchange.variance, Eigen::VectorXd::Ones(exchange.area.size())).array() /
         exchange.area.square();
}

/// Which rows are to sum to one. Leaves out what scaling would only hide.
std::vector<bool> closed_rows(Exchange& exchange, Closure closure, double most_off) {
  const Enclosures& enclosures = exchange.enclosures;
  const Eigen::ArrayXd sees =
      multiply(exchange.matrix, Eigen::VectorXd::Ones(exchange.area.size())).array();
  const Eigen::ArrayXd variance = variance_of_rows(exchange);
  std::vector<bool> is_off(enclosures.closed.size());
  for (std::size_t e = 0; e < enclosures.of_element.size(); ++e) {
    const auto row = static_cast<Eigen::Index>(e);
    if (sees[row] > 0 && std::abs(sees[row] / exchange.area[row] - 1) >
                             most_off + most_deviations * std::sqrt(variance[row]))
      is_off[at(enclosures.of_element[e])] = true;
  }
  for (std::size_t k = 0; k < is_off.size(); ++k)
    exchange.report.unfinished += enclosures.closed[k] && enclosures.lit[k] && is_off[k];
  std::vector<bool> rows(enclosures.of_element.size());
  for (std::size_t e = 0; e < rows.size(); ++e) {
    const std::size_t k = at(enclosures.of_element[e]);
    rows[e] = closure == Closure::enforce ||
              (closure == Closure::automatic && enclosures.closed[k] && !is_off[k]);
  }
  return rows;
}

void close(Exchange& exchange, const ExchangeOptions& options, bool has_all_rows) {
  const double most_off = options.factors == FactorsBy::rays ? far_off : far_off_from_points;
  const std::vector<bool> rows = closed_rows(exchange, options.closure, most_off);
  ExchangeReport& report = exchange.report;
  if (has_all_rows && std::find(rows.begin(), rows.end(), true) != rows.end())
    report.closure_enforced = enforce_closure(exchange.matrix, exchange.area, rows);
  exchange.lost = exchange.area -
                  multiply(exchange.matrix, Eigen::VectorXd::Ones(exchange.area.size())).array();
  if (!report.closure_enforced) return;
  for (std::size_t e = 0; e < rows.size(); ++e)
    // What sees nothing cannot be scaled.
    if (rows[e] && exchange.lost[static_cast<Eigen::Index>(e)] <
                       most_off * exchange.area[static_cast<Eigen::Index>(e)])
      exchange.lost[static_cast<Eigen::Index>(e)] = 0;
}

void add_estimates(EstimatedFactors estimates, Exchange& exchange) {
  const double known = exchange.matrix.sum(), estimated = estimates.matrix.sum();
  if (estimated > 0) exchange.report.estimated_share = estimated / (known + estimated);
  exchange.report.rays += estimates.rays;
  ExchangeMatrix all = exchange.matrix + estimates.matrix;
  exchange.matrix.swap(all);
  exchange.variance.swap(estimates.variance);
}

}  // namespace

Exchange compute_exchange(const SoundScene& scene, const ElementTable& elements,
                          const VisibilityIndex& visibility, const ExchangeOptions& options,
                          const Progress& progress) {
  if (!(options.tolerance > 0 && options.tolerance < 1) || options.rays_per_pair < 1)
    throw Error(ErrorCode::contract, "compute_exchange",
                fmt::format("tolerance {} must lie in (0, 1) and rays per pair {} be at least 1",
                            options.tolerance, options.rays_per_pair));
  require_memory(elements, options.factors);
  Exchange exchange;
  exchange.area = Eigen::Map<const Eigen::ArrayXd>(elements.area.data(),
                                                   static_cast<Eigen::Index>(elements.area.size()));
  const SpaceCells cells = find_cells(scene, elements);
  const bool was_stopped = progress.stopped();
  AssembledFactors factors =
      options.factors == FactorsBy::rays
          ? assemble_factors(scene, elements, cells, visibility, options, progress)
          : factors_from_points(scene, elements, cells, visibility, options, progress);
  exchange.report.by = options.factors;
  exchange.report.complete = factors.complete;
  exchange.report.rays = factors.rays;
  exchange.report.refined_rows = factors.refined_rows;
  exchange.matrix.swap(factors.matrix);
  const bool is_cut_short = std::find(factors.is_missing.begin(), factors.is_missing.end(), 1) !=
                            factors.is_missing.end();
  if (is_cut_short && !was_stopped)
    add_estimates(estimate_factors(scene, elements, cells, visibility, factors.is_missing),
                  exchange);
  exchange.report.factors = static_cast<std::size_t>(exchange.matrix.nonZeros());
  exchange.enclosures = find_enclosures(scene, elements, cells, exchange.matrix);
  report_closure(exchange);
  close(exchange, options, !(is_cut_short && was_stopped));
  return exchange;
}

Exchange enclosures_alone(const SoundScene& scene, const ElementTable& elements) {
  Exchange exchange;
  exchange.area = Eigen::Map<const Eigen::ArrayXd>(elements.area.data(),
                                                   static_cast<Eigen::Index>(elements.area.size()));
  exchange.matrix.resize(exchange.area.size(), exchange.area.size());
  exchange.enclosures =
      find_enclosures(scene, elements, find_cells(scene, elements), exchange.matrix);
  exchange.report.closed = true;
  exchange.lost = exchange.area;
  for (int e = 0; e < elements.count(); ++e) {
    if (exchange.enclosures.is_closed(e)) exchange.lost[e] = 0;
    if (exchange.enclosures.is_lit(e) && !exchange.enclosures.is_closed(e))
      exchange.report.closed = false;
  }
  return exchange;
}

}  // namespace halfshade
