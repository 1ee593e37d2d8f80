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
  /// Form factor of which it is not known where it leads, or whether there is any: what surfaces
  /// missed by more than is allowed, and what all that is seen is more than one.
  double unsure = 0;
};

/// The irradiance that a field on the forest makes, see forest_field.
Rgb irradiance(const IrradianceRow& row, const QuickField& leaving);

struct RowAccuracy {
  double moments = 1e-5;   ///< of each moment, absolute
  double collapse = 1e-3;  ///< what may be lost where a triangle stands for the leaves below it
  double length = 1;       ///< over which what leaves changes, scene units; 0: any

  /// What moments may miss the form factor of a surface by, before they are put right.
  double allowed() const;
};

/// Makes rows by exactly visible parts. A surface's triangles are walked from the roots: those that
/// are seen as a whole, or hardly matter, stand for the leaves below them, by the projection of
/// what leaves these. Moments are scaled to the exact form factor of the surface's visible part, so
/// that rows of closed cells sum to one; where they miss it by more than is allowed they are found
/// once more, more exactly, and what they still miss is unsure.
class RowMaker {
 public:
  /// All must outlive it; the mesh must not change.
  RowMaker(const ExactSight& sight, const ReflectedMesh& mesh, const RowAccuracy& accuracy);

  /// `targets` are what may_see() found for a part of the surface that holds the point.
  IrradianceRow row(const SurfacePoint& point, std::span<const Sighted> targets) const;
  /// The same in the place of another row, whose memory is used again.
  void make(const SurfacePoint& point, std::span<const Sighted> targets, IrradianceRow& row) const;

  const RowAccuracy& accuracy() const { return accuracy_; }
  const ExactSight& sight() const { return sight_; }

 private:
  /// Adds moments of what is seen of a surface; their sum.
  double add(const SurfacePoint& point, int surface, const SeenPart& seen,
             const RowAccuracy& accuracy, IrradianceRow& row) const;
  /// The same, scaled to the form factor.
  void add_scaled(const SurfacePoint& point, int surface, const SeenPart& seen,
                  IrradianceRow& row) const;

  const ExactSight& sight_;
  const ReflectedMesh& mesh_;
  RowAccuracy accuracy_;
  std::vector<std::array<Vec2, 3>> corners_;  ///< of the forest's triangles, in their planes
  std::vector<double> least_;                 ///< size of the smallest leaf of each of them
};

}  // namespace halfshade
