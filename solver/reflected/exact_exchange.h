#pragma once

#include "solver/reflected/direct_projection.h"
#include "solver/reflected/irradiance_operator.h"
#include "solver/reflected/irradiance_row.h"
#include "solver/reflected/near_backs.h"

#include <stop_token>
#include <vector>

namespace halfshade {

/// K by exactly visible parts: nothing is sampled. All rows are made anew when the mesh changes.
class ExactExchange : public IrradianceOperator {
 public:
  /// All must outlive it; `direct` must be up to date with the mesh.
  ExactExchange(const ExactSight& sight, const ReflectingScene& scene, const FirstLight& light,
                const DirectProjection& direct, const RowAccuracy& accuracy)
      : sight_(sight),
        scene_(scene),
        light_(light),
        direct_(direct),
        accuracy_(accuracy),
        backs_(scene) {}

  bool update(const ReflectedMesh& mesh, const Progress& progress) override;
  ElementField source(const ReflectedMesh& mesh) const override;
  ElementField apply(const ReflectedMesh& mesh, const ElementField& leaving) const override;
  std::vector<int> seen_from(const ReflectedMesh& mesh, int element) const override;
  bool stopped() const override { return stop_.stop_requested(); }
  double unsure(int element) const override;
  Eigen::VectorXd seen(int element) const override { return seen_[at(element)]; }
  const BackShadow* shadow(int element) const override { return &shadows_[at(element)]; }

  /// The most that moments of a row missed its form factors by, before they were put right; in
  /// closed cells also what form factors miss 1 by.
  double row_error() const;
  /// Memory that rows take, in numbers.
  std::size_t moments() const;

 private:
  /// Whether the rows are those of this mesh, which may have been refined since.
  bool fits(const ReflectedMesh& mesh) const;
  void make_rows(const RowMaker& maker, const ReflectedMesh& mesh, int element);

  const ExactSight& sight_;
  const ReflectingScene& scene_;
  const FirstLight& light_;
  const DirectProjection& direct_;
  RowAccuracy accuracy_;
  NearBacks backs_;
  std::stop_token stop_;                          ///< of the last update
  std::vector<std::vector<IrradianceRow>> rows_;  ///< of each element's nodes
  std::vector<Eigen::VectorXd> seen_;             ///< of each element, as the next
  std::vector<BackShadow> shadows_;
};

/// A row for a point of a part of a root, in the place of another one; in a closed cell it is
/// scaled to sum to one, and `off` is at least what it did not, as is `unsure` if that is more than
/// is allowed.
void make_closed_row(const RowMaker& maker, const ReflectingScene& scene, int root,
                     const Vec3& position, std::span<const Sighted> targets, IrradianceRow& row);

}  // namespace halfshade
