#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/near_backs.h"
#include "solver/reflected/reflected_mesh.h"

#include <vector>

namespace halfshade {

struct LightSystems;

/// K, irradiance from leaving light, between the elements of a mesh. All of one call belong to the
/// mesh of the last update.
class IrradianceOperator {
 public:
  virtual ~IrradianceOperator() = default;

  /// Makes what is missing for this mesh. False if stopped before all was.
  virtual bool update(const ReflectedMesh& mesh, const Progress& progress) = 0;

  /// K S.
  virtual ElementField source(const ReflectedMesh& mesh) const = 0;

  /// K B.
  virtual ElementField apply(const ReflectedMesh& mesh, const ElementField& leaving) const = 0;

  /// The elements that are seen from an element; some more than once.
  virtual std::vector<int> seen_from(const ReflectedMesh& mesh, int element) const = 0;

  /// Whether the call of the last update was told to stop: what takes many applications should.
  virtual bool stopped() const { return false; }

  /// Form factor from an element of which it is not known where it leads, in the root of the mean
  /// square; 0 where that shows as noise.
  virtual double unsure(int /*element*/) const { return 0; }

  /// Looks for the light that open systems lose, to a share `enough` of it, as far as `update` did
  /// not. False if stopped.
  virtual bool find_losses(const ReflectedMesh& /*mesh*/, const LightSystems& /*systems*/,
                           double /*enough*/, const Progress& /*progress*/) {
    return true;
  }

  /// What is not known of that for lack of rays: form factors of an element to all others, in the
  /// mean.
  virtual double unsure_loss(int /*element*/) const { return 0; }

  /// Coefficients of the share of the hemisphere of an element's places that holds surfaces; what
  /// nodes miss of it is in the mean. Empty where that is not known, as before backs close to it.
  virtual Eigen::VectorXd seen(int /*element*/) const { return {}; }

  /// How much darker backs close before an element make it than its nodes see, where that is put
  /// right; null where it is not.
  virtual const BackShadow* shadow(int /*element*/) const { return nullptr; }
};

}  // namespace halfshade
