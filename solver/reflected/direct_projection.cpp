#include "solver/reflected/direct_projection.h"

#include "meshing/core/parallel.h"
#include "solver/reflected/ray_exchange.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Of all points: in one element.
constexpr double most_of_points = 0.05;

/// The projection of `direct`, light at a place of an element: by a rule, and of what is left of it
/// by strata² random points, one in each of as many parts of equal area. Light breaks anywhere, and
/// where breaks are parallel to elements a regular pattern would miss them all alike.
template <class LightAt>
ChannelArray project(const ReflectedMesh& mesh, const LightAt& direct, int element, int strata) {
  const int triangle = mesh.triangle[at(element)], order = mesh.order[at(triangle)];
  const ElementNodes& nodes = element_nodes_of(order);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(nodes.places.size()), 3);
  for (std::size_t k = 0; k < nodes.places.size(); ++k)
    values.row(static_cast<Eigen::Index>(k)) = direct(nodes.places[k]).transpose();
  const Eigen::MatrixXd by_rule = nodes.fit * values;

  Eigen::MatrixXd rest = Eigen::MatrixXd::Zero(by_rule.rows(), 3);
  Eigen::VectorXd basis(by_rule.rows());
  const std::uint64_t seed = ray_seed(mesh, element, 0, 1);
  std::uint64_t number = 0;
  for (int i = 0; i < strata; ++i)
    for (int j = 0; j < strata; ++j, number += 2) {
      const double across = std::sqrt((i + random_number(seed, number)) / strata);
      const double along = (j + random_number(seed, number + 1)) / strata;
      const TrianglePlace place(across * (1 - along), across * along);
      basis_at(order, place, basis);
      rest += basis * (direct(place).transpose() - basis.transpose() * by_rule);
    }
  return (by_rule + rest / (strata * strata)).array();
}

}  // namespace

void DirectProjection::update(const ReflectedMesh& mesh, const FirstLight& light) {
  of_triangle_.resize(at(mesh.forest.count()));
  painted_.resize(at(mesh.forest.count()));
  double total = 0;
  for (int e = 0; e < mesh.count(); ++e) total += mesh.counts(e) ? mesh.area(e) : 0;
  parallel_for(at(mesh.count()), [&](std::size_t i) {
    const int e = static_cast<int>(i), t = mesh.triangle[i];
    auto& kept = of_triangle_[at(t)];
    if (kept && kept->rows() == basis_size(mesh.order[at(t)])) return;
    const double points = points_ * std::min(mesh.area(e) / total, most_of_points);
    const int strata = std::max(1, static_cast<int>(std::lround(std::sqrt(points))));
    const int root = mesh.root(e);
    kept = std::make_unique<ChannelArray>(project(
        mesh,
        [&](const TrianglePlace& place) -> Vec3 {
          return light.direct_at(root, mesh.position(e, place)).matrix();
        },
        e, strata));
    if (!light.painted.is_painted(root) || light.through_operator) return;
    painted_[at(t)] = std::make_unique<ChannelArray>(project(
        mesh,
        [&](const TrianglePlace& place) -> Vec3 {
          return light.leaving(root, mesh.position(e, place)).matrix();
        },
        e, strata));
  });
}

Rgb DirectProjection::mean_leaving(const ReflectedMesh& mesh, const FirstLight& light,
                                   int element) const {
  const auto& painted = painted_[at(mesh.triangle[at(element)])];
  return painted ? Rgb(painted->row(0).transpose())
                 : Rgb(light.rho[at(mesh.root(element))] * mean(mesh, element));
}

ElementField DirectProjection::leaving(const ReflectedMesh& mesh, const FirstLight& light) const {
  ElementField field = zero_field(mesh);
  for (int e = 0; e < mesh.count(); ++e) {
    const std::size_t root = at(mesh.root(e)), triangle = at(mesh.triangle[at(e)]);
    if (light.through_operator)
      field.of(e).row(0) = light.exitance[root].transpose();
    else if (painted_[triangle])
      field.of(e) = *painted_[triangle];
    else
      field.of(e) = of_triangle_[triangle]->rowwise() * light.rho[root].transpose();
  }
  return field;
}

}  // namespace halfshade
