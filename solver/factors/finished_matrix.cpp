#include "solver/factors/finished_matrix.h"

#include "solver/exchange/exchange.h"
#include "solver/factors/row_sums.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Rows sum to one: so no entry is off by more than their sum is, and all the others together. That
/// is sharp where one is worse than the others.
void sharpen_errors(const RowSums& sums, RowExchange& exchange) {
  RowMajorMatrix& errors = exchange.mutual_error;
  for (Eigen::Index i = 0; i < errors.rows(); ++i) {
    for (Eigen::Index j = i; j < errors.cols(); ++j) {
      const double error = errors(i, j);
      errors(i, j) = std::min({error, sums.bound(i, error), sums.bound(j, error)});
      errors(j, i) = errors(i, j);
    }
    double& error = exchange.space_error[i];
    error = std::min(error, sums.bound(i, error));
  }
}

FactorMatrix matrix_of(const FactorScene& scene, const RowExchange& exchange) {
  FactorMatrix result;
  result.names = scene.names;
  result.unit = scene.unit;
  result.scene.repairs = scene.sound.repairs;
  result.scene.face_lines = scene.sound.face_lines;
  result.report = exchange.report;
  result.area = Eigen::Map<const Eigen::ArrayXd>(scene.areas.data(), scene.rows());
  result.factors = result.area.inverse().matrix().asDiagonal() * exchange.mutual;
  result.space = exchange.space / result.area;
  result.backs = exchange.backs / result.area;
  result.row_sum = result.factors.rowwise().sum().array() + result.space;
  result.error =
      exchange.mutual_error.rowwise().maxCoeff().array().max(exchange.space_error) / result.area;
  result.left_out = Eigen::ArrayXd::Zero(result.area.size());
  return result;
}

void fill_report(double tolerance, const RowSums& sums, FactorMatrix& result) {
  FactorReport& report = result.report;
  for (Eigen::Index i = 0; i < result.area.size(); ++i) {
    const double missing = std::abs(result.row_sum[i] - 1);
    // Entries are off by far less than they claim as a rule: what a sum misses is in one of them,
    // unless there are so many that even small errors add up to more than the tolerance.
    result.error[i] = std::max(result.error[i], std::min(missing, tolerance));
    // Space is found on its own: what a sum of many good entries misses is in one that is not. The
    // others may make it look smaller than it is.
    if (missing > 2 * tolerance || sums.is_refuted(i)) result.error[i] += missing;
    const bool is_off = result.error[i] > tolerance;
    report.rows_not_reached += is_off ? 1 : 0;
    report.row_sum_error_max = std::max(report.row_sum_error_max, missing);
    if (result.backs[i] <= report.backs_max) continue;
    report.backs_max = result.backs[i];
    report.backs_row = static_cast<int>(i);
  }
}

/// Leaves out pairs neither of whose factors can reach the limit.
void make_sparse(double limit, RowExchange& exchange, FactorMatrix& result) {
  const auto most = [&](Eigen::Index i, Eigen::Index j) {
    return result.factors(i, j) + exchange.mutual_error(i, j) / result.area[i];
  };
  const auto leave_out = [&](Eigen::Index i, Eigen::Index j) {
    result.error[i] = std::max(result.error[i], most(i, j));
    result.left_out[i] += result.factors(i, j);
    result.factors(i, j) = exchange.mutual(i, j) = 0;
    ++result.report.left_out;
  };
  for (Eigen::Index i = 0; i < result.area.size(); ++i)
    for (Eigen::Index j = i; j < result.area.size(); ++j) {
      if (result.factors(i, j) == 0 || most(i, j) >= limit || most(j, i) >= limit) continue;
      leave_out(i, j);
      if (i != j) leave_out(j, i);
    }
  result.report.sparse_below = limit;
  result.report.left_out_max = result.left_out.maxCoeff();
}

/// A F with the surroundings as one more row.
ExchangeMatrix with_surroundings(const RowExchange& exchange) {
  const Eigen::Index n = exchange.mutual.rows();
  RowMajorMatrix all = RowMajorMatrix::Zero(n + 1, n + 1);
  all.topLeftCorner(n, n) = exchange.mutual;
  all.col(n).head(n) = exchange.space.matrix();
  all.row(n).head(n) = exchange.space.matrix().transpose();
  return all.sparseView();
}

/// Scales A F symmetrically until Σ F + space = 1 in every row. What the surroundings see is not
/// known to sum to anything.
void enforce(const RowExchange& exchange, FactorMatrix& result) {
  const Eigen::Index n = result.area.size();
  ExchangeMatrix scaled = with_surroundings(exchange);
  Eigen::ArrayXd area = Eigen::ArrayXd::Ones(n + 1);
  area.head(n) = result.area;
  std::vector<bool> rows(static_cast<std::size_t>(n), true);
  rows.push_back(false);
  if (!enforce_closure(scaled, area, rows)) return;
  const RowMajorMatrix dense(scaled);
  const RowMajorMatrix factors =
      result.area.inverse().matrix().asDiagonal() * dense.topLeftCorner(n, n);
  const Eigen::ArrayXd space = dense.col(n).head(n).array() / result.area;
  FactorReport& report = result.report;
  report.is_enforced = true;
  const auto note = [&](Eigen::Index i, double before, double after, double error) {
    if (before == after) return;
    report.enforced_by = std::max(report.enforced_by, std::abs(after / before - 1));
    result.error[i] = std::max(result.error[i], error / result.area[i] + std::abs(after - before));
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < n; ++j)
      note(i, result.factors(i, j), factors(i, j), exchange.mutual_error(i, j));
    note(i, result.space[i], space[i], exchange.space_error[i]);
  }
  result.factors = factors;
  result.space = space;
  result.left_out.setZero();
}

}  // namespace

FactorMatrix finished_matrix(const FactorScene& scene, RowExchange exchange, double tolerance,
                             const FactorOptions& options) {
  // Nothing sends less than nothing, whatever it is off by.
  exchange.mutual = exchange.mutual.cwiseMax(0);
  exchange.space = exchange.space.max(0);
  const RowSums sums(scene, exchange);
  if (exchange.report.method == FactorMethod::exact) sharpen_errors(sums, exchange);
  FactorMatrix result = matrix_of(scene, exchange);
  fill_report(tolerance, sums, result);
  if (options.sparse_below > 0) make_sparse(options.sparse_below, exchange, result);
  if (options.enforce) enforce(exchange, result);
  return result;
}

}  // namespace halfshade
