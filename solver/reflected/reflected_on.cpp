#include "solver/reflected/reflected_on.h"

#include "solver/reflected/loss_balance.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

constexpr double residual_of_estimate = 0.02;
/// Hardly more can be missing in an element than there is. Where points fell on one of many small
/// elements, what they stand for is so much more.
constexpr double outlier = 4;

/// All channels alike: one of them is solved for.
bool is_grey(const ReflectedSystem& system) {
  const auto& [mesh, light, exchange, systems] = system;
  const auto is_even = [](const Rgb& x) { return (x == x[0]).all(); };
  for (int e = 0; e < mesh.count(); ++e) {
    const int root = mesh.root(e);
    if (light.painted.is_painted(root) || !is_even(light.rho[at(root)]) ||
        !is_even(light.exitance[at(root)]))
      return false;
  }
  return true;
}

/// What comes of what points find missing, beside that itself; `missing(e, c)` of an element in a
/// channel.
template <class Missing>
ElementField comes_of(const Missing& missing, const ReflectedSystem& system,
                      const ElementField& irradiance, const ReflectionEstimate& estimate,
                      const std::vector<UnsureLoss>& unsure) {
  const ReflectedMesh& mesh = system.mesh;
  ElementField source = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e)
    if (const double reach = estimate.reach[at(e)]; reach > 0)
      for (int c = 0; c < 3; ++c)
        source.of(e)(0, c) = missing(e, c) * estimate.probed[at(e)] / (reach * mesh.area(e));
  ElementField all = all_light_of(system, source, residual_of_estimate);
  balance_change(system, irradiance, unsure, all);
  all.coefficients -= source.coefficients;
  return all;
}

/// The same of all points together, or of each part of them.
std::vector<ElementField> reflected_parts(const ReflectedSystem& system,
                                          const ElementField& irradiance,
                                          const ReflectionEstimate& estimate,
                                          const std::vector<UnsureLoss>& unsure, PointParts which) {
  const auto come_of = [&](const auto& missing) {
    return comes_of(missing, system, irradiance, estimate, unsure);
  };
  if (which == PointParts::one)
    return {come_of([&](int e, int c) {
      double mean = 0;
      for (const Rgb& part : estimate.missing[at(e)]) mean += part[c] / parts_of_probes;
      return mean;
    })};
  const bool is_one_a_channel = is_grey(system);
  const std::size_t at_once = is_one_a_channel ? 3 : 1;
  static_assert(parts_of_probes % 3 == 0);
  std::vector<ElementField> parts;
  for (std::size_t p = 0; p < parts_of_probes; p += at_once) {
    const ElementField all = come_of(
        [&](int e, int c) { return estimate.missing[at(e)][is_one_a_channel ? p + at(c) : p][c]; });
    for (std::size_t k = 0; k < at_once; ++k) {
      parts.push_back(all);
      if (is_one_a_channel)
        for (int c = 0; c < 3; ++c)
          parts.back().coefficients.col(c) = all.coefficients.col(static_cast<Eigen::Index>(k));
    }
  }
  return parts;
}

/// What each part is in the mean over an element (parts × channels), less where the mean of them is
/// an outlier beside what is `there`.
Eigen::MatrixXd means_of_parts(const std::vector<ElementField>& parts, int element,
                               const Rgb& there) {
  const int n = static_cast<int>(parts.size());
  Eigen::MatrixXd means(n, 3);
  for (int p = 0; p < n; ++p) means.row(p) = parts[at(p)].of(element).row(0).matrix();
  for (int c = 0; c < 3; ++c) {
    const double mean = means.col(c).mean();
    const double noise =
        n > 1 ? (means.col(c).array() - mean).matrix().norm() / std::sqrt(n * (n - 1.)) : 0;
    const double size = std::hypot(mean, noise), most = outlier * std::abs(there[c]);
    if (size > 0) means.col(c) *= most / (most + size);
  }
  return means;
}

}  // namespace

double ReflectedOn::at_most() const { return std::max(square, 0.) + 2 * deviation; }

ReflectedOn square_of_mean(const Eigen::MatrixXd& products) {
  const auto n = static_cast<double>(products.rows());
  const Eigen::ArrayXd with = products.rowwise().sum() - products.diagonal();  // of each part
  const double all = with.sum();                                               // each pair twice
  const Eigen::ArrayXd without = (all - 2 * with) / ((n - 1) * (n - 2));
  const double spread = (without - without.mean()).square().sum();
  return {all / (n * (n - 1)), std::sqrt((n - 1) / n * spread)};
}

ReflectedOn reflected_on(const ReflectedSystem& system, const SplitIrradiance& irradiance,
                         const ReflectionEstimate& estimate, const std::vector<UnsureLoss>& unsure,
                         const std::vector<double>& weight, PointParts which) {
  const ReflectedMesh& mesh = system.mesh;
  const std::vector<ElementField> parts =
      reflected_parts(system, irradiance.rest, estimate, unsure, which);
  const ElementField there = irradiance.whole(mesh, system.systems);
  const int n = static_cast<int>(parts.size());
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
  for (int e = 0; e < mesh.count(); ++e) {
    const Eigen::MatrixXd means = means_of_parts(parts, e, there.of(e).row(0).transpose());
    products += mesh.area(e) * weight[at(e)] * means * means.transpose();
  }
  return n > 1 ? square_of_mean(products) : ReflectedOn{products(0, 0), 0};
}

}  // namespace halfshade
