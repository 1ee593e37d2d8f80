#include "solver/reflected/unstable_elements.h"

#include "meshing/geometry/mix_bits.h"
#include "solver/reflected/ray_exchange.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace halfshade {
namespace {

/// Until what falls is small beside what does not; the last two tell how much is left.
constexpr int first_reflections = 8, last_reflections = 2;
/// What is uneven within elements, as real light leaves it after a reflection, at most.
constexpr double most_left = 0.9;
/// Of the unevenness in all: less in an element is not its own.
constexpr double own_share = 1e-3;
/// Where less is reflected nothing grows.
constexpr double least_reflectance = 0.5;

/// ∫ of the square of what is uneven within each element, and of its mean.
struct Squares {
  double uneven = 0, even = 0;
};

Squares squares(const ReflectedMesh& mesh, const ElementField& field, int element) {
  const auto f = field.of(element);
  const double even = f.row(0).square().sum();
  return {mesh.area(element) * (f.square().sum() - even), mesh.area(element) * even};
}

/// Uneven within each element, in a way of its own, and 0 in the mean.
ElementField uneven_field(const ReflectedMesh& mesh) {
  ElementField field = zero_field(mesh);
  for (int e = 0; e < field.count(); ++e) {
    auto f = field.of(e);
    for (Eigen::Index k = 1; k < f.rows(); ++k) {
      const std::uint64_t bits = mix_bits(static_cast<std::uint64_t>(field.first[at(e)] + k));
      f.row(k) = (bits & 1U) != 0 ? 1 : -1;
    }
  }
  return field;
}

bool reflects_much(const ReflectedSystem& system) {
  return std::ranges::any_of(system.light.rho,
                             [](const Rgb& rho) { return rho.maxCoeff() > least_reflectance; });
}

}  // namespace

std::vector<int> unstable_elements(const ReflectedSystem& system) {
  const auto& [mesh, light, exchange, systems] = system;
  if (!reflects_much(system)) return {};
  ElementField field = uneven_field(mesh);
  const auto reflect = [&](int times) {
    for (int k = 0; k < times && !exchange.stopped(); ++k)
      field = exchange.apply(mesh, reflected_part(mesh, light, field));
  };
  reflect(first_reflections);
  const double largest = field.coefficients.abs().maxCoeff();
  if (!(largest > 0)) return {};
  field.coefficients /= largest;
  const ElementField before = field;
  reflect(last_reflections);
  if (exchange.stopped()) return {};
  double all = 0;
  for (int e = 0; e < mesh.count(); ++e) all += squares(mesh, field, e).uneven;
  std::vector<int> unstable;
  for (int e = 0; e < mesh.count(); ++e) {
    const auto [uneven, even] = squares(mesh, field, e);
    const double left = std::pow(most_left, 2 * last_reflections) * squares(mesh, before, e).uneven;
    if (uneven > own_share * all && uneven > even && uneven > left) unstable.push_back(e);
  }
  return unstable;
}

bool make_stable(const ReflectedSystem& system, ReflectedMesh& mesh) {
  const std::vector<int> unstable = unstable_elements(system);
  make_constant(mesh, unstable);
  return !unstable.empty();
}

}  // namespace halfshade
