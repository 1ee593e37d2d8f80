#pragma once

#include "solver/adapt/adaptive_field.h"
#include "tests/support/true_error.h"

#include <functional>
#include <span>
#include <vector>

/// Fields that are known functions of a position.
namespace halfshade::test {

using Function = std::function<double(const Vec3&)>;

inline Rgb in_channels(double value) { return {value, 0.5 * value, 2 * value}; }

inline FieldAt field_of(const Function& f) {
  return [f](std::span<const FieldPoint> points, const Progress&) {
    std::vector<Rgb> values;
    for (const FieldPoint& point : points) values.push_back(in_channels(f(point.point.position)));
    return values;
  };
}

/// As true_relative_error.
inline double true_error(const AdaptiveField& fit, const Function& f, int parts = 1) {
  return true_relative_error(
      fit.elements, fit.field, [&](const Vec3& p) { return in_channels(f(p)); }, parts);
}

inline PatchMesh mesh_of(const SoundScene& scene, double max_length) {
  PlanarMeshOptions options;
  options.max_length = max_length;
  return PatchMesh(scene, options);
}

}  // namespace halfshade::test
