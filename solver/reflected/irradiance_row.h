#pragma once

#include "solver/reflected/exact_sight.h"
#include "solver/reflected/kernel_moments.h"
#include "solver/reflected/quick_field.h"

#include <vector>

namespace halfshade {

/// Irradiance at a point as a sum over triangles of a forest, of what leaves them.
struct IrradianceRow {
  std::vector<int> triangle;    ///< of the forest, leaves and others, that do not overlap
  std::vector<int> first;       ///< of each triangle's moments, and their number
  std::vector<double> moments;  ///< ∫ kernel · monomials over what is seen of it
  double sum = 0;               ///< form factor to all that is seen
  double off = 0;  ///< by how much the moments missed the form factors, all surfaces' added up
};

/// The irradiance that a field on the forest makes, see forest_field.
Rgb irradiance(const IrradianceRow& row, const QuickField& leaving);

struct RowAccuracy {
  double moments = 1e-5;   ///< of each moment, absolute
  double collapse = 1e-3;  ///< what may be lost where a triangle stands for the leaves below it
  double length = 1;       ///< over which what leaves changes, scene units; 0: any
};

/// Makes rows by exactly visible parts. A surface's triangles are walked from the roots: those that
/// are seen as a whole, or hardly matter, stand for the leaves below them, by the projection of
/// what leaves these. Moments are scaled to the exact form factor of the surface's visible part, so
/// that rows of closed cells sum to one.
class RowMaker {
 public:
  /// All must outlive it; the mesh must not change.
  RowMaker(const ExactSight& sight, const ReflectedMesh& mesh, const RowAccuracy& accuracy);

  /// `targets` are what may_see() found for a part of the surface that holds the point.
  IrradianceRow row(const SurfacePoint& point, std::span<const Sighted> targets) const;

 private:
  const ExactSight& sight_;
  const ReflectedMesh& mesh_;
  RowAccuracy accuracy_;
  std::vector<std::array<Vec2, 3>> corners_;  ///< of the forest's triangles, in their planes
};

}  // namespace halfshade
