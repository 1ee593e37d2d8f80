#include "solver/reflected/leaving_field.h"

#include "meshing/core/parallel.h"

#include <algorithm>

namespace halfshade {

LeavingField::LeavingField(const ReflectedMesh& mesh, const ElementField& field) {
  for (const int p : field.order) order_ = std::max(order_, p);
  const std::size_t size = at(basis_size(order_));
  powers_.resize(at(mesh.forest.count()) * size);
  parallel_for(at(mesh.count()), [&](std::size_t e) {
    const int order = field.order[e];
    const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, basis_size(max_reflected_order), 3> powers =
        change_to_powers(order) * field.of(static_cast<int>(e)).matrix();
    Rgb* to = powers_.data() + at(mesh.triangle[e]) * size;
    std::fill_n(to, size, Rgb::Zero());
    for (int k = 0; k < basis_size(order); ++k) to[k] = powers.row(k).transpose();
  });
}

}  // namespace halfshade
