#include "solver/reflected/leaving_field.h"

#include <algorithm>

namespace halfshade {

LeavingField::LeavingField(const ReflectedMesh& mesh, const ElementField& field) {
  for (const int p : field.order) order_ = std::max(order_, p);
  powers_.resize(at(mesh.forest.count()) * at(basis_size(order_)), Rgb::Zero());
  const QuickField quick(field);
  for (int e = 0; e < mesh.count(); ++e)
    std::copy_n(quick.powers(e), basis_size(field.order[at(e)]),
                powers_.data() + at(mesh.triangle[at(e)]) * at(basis_size(order_)));
}

}  // namespace halfshade
