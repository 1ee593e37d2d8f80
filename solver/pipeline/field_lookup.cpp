#include "solver/pipeline/field_lookup.h"

#include "solver/reflected/reflected_mesh.h"

namespace halfshade {
namespace {

QuickField low_orders(const ElementField& field) {
  std::vector<int> order = field.order;
  for (int& p : order) p = p <= max_reflected_order ? p : 0;
  ElementField low = zero_field(std::move(order));
  for (int e = 0; e < low.count(); ++e)
    if (low.order[at(e)] == field.order[at(e)]) low.of(e) = field.of(e);
  return QuickField(low);
}

}  // namespace

FieldLookup::FieldLookup(const ElementTable& elements, const ElementField& field)
    : lookup_(elements), field_(field), low_(low_orders(field)) {}

Rgb FieldLookup::operator()(int surface, const Vec3& position) const {
  const auto [e, here] = place(surface, position);
  if (e < 0) return Rgb::Zero();
  const Rgb value =
      field_.order[at(e)] <= max_reflected_order ? low_.value(e, here) : value_at(field_, e, here);
  return value.max(0);
}

}  // namespace halfshade
