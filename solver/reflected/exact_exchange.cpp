#include "solver/reflected/exact_exchange.h"

#include "meshing/core/parallel.h"
#include "solver/reflected/forest_field.h"
#include "solver/reflected/near_slits.h"
#include "solver/reflected/ray_exchange.h"

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

void add_leaves(const ReflectedMesh& mesh, int triangle, std::vector<int>& elements) {
  if (mesh.forest.is_leaf(triangle)) {
    elements.push_back(mesh.element[at(triangle)]);
    return;
  }
  const int half = mesh.forest.first_half(triangle);
  add_leaves(mesh, half, elements);
  add_leaves(mesh, half + 1, elements);
}

}  // namespace

void make_closed_row(const RowMaker& maker, const ReflectingScene& scene, int root,
                     const Vec3& position, std::span<const Sighted> targets, IrradianceRow& row) {
  maker.make(maker.sight().point_of(root, position), targets, row);
  if (!scene.cells.closed[at(scene.cells.before(root))] || !(row.sum > 0)) return;
  row.off = std::max(row.off, std::abs(row.sum - 1));
  // What is more than one is counted already.
  if (1 - row.sum > maker.accuracy().allowed()) row.unsure += 1 - row.sum;
  for (double& m : row.moments) m /= row.sum;
}

bool ExactExchange::fits(const ReflectedMesh& mesh) const {
  if (rows_.size() != at(mesh.count())) return false;
  for (std::size_t e = 0; e < rows_.size(); ++e)
    if (rows_[e].size() != element_nodes_of(mesh.order[at(mesh.triangle[e])]).places.size())
      return false;
  return true;
}

bool ExactExchange::update(const ReflectedMesh& mesh, const Progress& progress) {
  stop_ = progress.stop;
  if (fits(mesh)) return true;
  const RowMaker maker(sight_, mesh, accuracy_);
  rows_.assign(at(mesh.count()), {});
  seen_.assign(at(mesh.count()), {});
  shadows_.assign(at(mesh.count()), {});
  return parallel_for(
      at(mesh.count()), [&](std::size_t e) { make_rows(maker, mesh, static_cast<int>(e)); },
      progress, "exact parts of reflected light");
}

void ExactExchange::make_rows(const RowMaker& maker, const ReflectedMesh& mesh, int element) {
  const int t = mesh.triangle[at(element)], root = mesh.root(element);
  std::vector<IrradianceRow>& rows = rows_[at(element)];
  const std::vector<Sighted> targets = sight_.may_see(mesh.forest.corners(t), root);
  IrradianceRow row;  // grows once; what is kept of it takes no more memory than it needs
  for (const TrianglePlace& place : element_nodes_of(mesh.order[at(t)]).places) {
    make_closed_row(maker, scene_, root, mesh.position(element, place), targets, row);
    rows.push_back(row);
  }
  BackShadow& shadow = shadows_[at(element)];
  shadow = backs_.shadow(mesh, element, looks_to_put_right);
  if (shadow.share != 0) return;
  Eigen::VectorXd seen(static_cast<Eigen::Index>(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) seen[static_cast<Eigen::Index>(k)] = rows[k].sum;
  const bool is_closed = scene_.cells.closed[at(scene_.cells.before(root))];
  if (!is_closed && light_.mean_rho(mesh, element).maxCoeff() > bright)
    shadow = slit_shadow({sight_, mesh, element, scene_.roots.normal[at(root)], targets}, seen);
  seen_[at(element)] = element_nodes_of(mesh.order[at(t)]).fit * seen;
  seen_[at(element)][0] += shadow.share;
}

ElementField ExactExchange::source(const ReflectedMesh& mesh) const {
  return apply(mesh, direct_.leaving(mesh, light_));
}

ElementField ExactExchange::apply(const ReflectedMesh& mesh, const ElementField& leaving) const {
  const QuickField quick(forest_field(mesh, leaving));
  ElementField result = zero_field(mesh);
  parallel_for(at(mesh.count()), [&](std::size_t e) {
    const std::vector<IrradianceRow>& rows = rows_[e];
    Eigen::MatrixXd values(static_cast<Eigen::Index>(rows.size()), 3);
    for (std::size_t k = 0; k < rows.size(); ++k)
      values.row(static_cast<Eigen::Index>(k)) = irradiance(rows[k], quick).matrix().transpose();
    const int order = mesh.order[at(mesh.triangle[e])];
    auto coefficients = result.of(static_cast<int>(e));
    coefficients = (element_nodes_of(order).fit * values).array();
    if (const Eigen::RowVectorXd& missed = shadows_[e].of_nodes; missed.size() > 0)
      coefficients.row(0) += (missed * values).array();
  });
  return result;
}

std::vector<int> ExactExchange::seen_from(const ReflectedMesh& mesh, int element) const {
  std::vector<int> seen;
  for (const IrradianceRow& row : rows_[at(element)])
    for (const int t : row.triangle) add_leaves(mesh, t, seen);
  return seen;
}

double ExactExchange::unsure(int element) const {
  double sum = 0;
  for (const IrradianceRow& row : rows_[at(element)]) sum += row.unsure * row.unsure;
  return std::sqrt(sum / static_cast<double>(rows_[at(element)].size()));
}

double ExactExchange::row_error() const {
  double most = 0;
  for (const auto& rows : rows_)
    for (const IrradianceRow& row : rows) most = std::max(most, row.off);
  return most;
}

std::size_t ExactExchange::moments() const {
  std::size_t count = 0;
  for (const auto& rows : rows_)
    for (const IrradianceRow& row : rows) count += row.moments.size();
  return count;
}

}  // namespace halfshade
