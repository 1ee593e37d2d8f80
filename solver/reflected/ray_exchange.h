#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/field_noise.h"
#include "solver/reflected/gathering.h"
#include "solver/reflected/irradiance_operator.h"
#include "solver/reflected/ray_losses.h"
#include "solver/reflected/reflected_mesh.h"

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <stop_token>
#include <vector>

namespace halfshade {

/// The rays from the nodes of an element, which end on triangles of the forest. Those of each node
/// are two halves, 2 node and 2 node + 1, that tell their noise.
struct NodeRays {
  GatheredRays halves;
  int strata = 0;  ///< squared, rays of a half over the hemisphere
};

/// K, irradiance from leaving light, by a few rays from each node that are traced once and kept:
/// two halves of strata² each, and less where very many elements are smaller than most of the area.
/// Only the elements that change are traced anew.
class RayExchange : public IrradianceOperator {
 public:
  /// Both must outlive it.
  RayExchange(const ReflectingScene& scene, const FirstLight& light, int strata)
      : scene_(scene), light_(light), strata_(strata) {}

  bool update(const ReflectedMesh& mesh, const Progress& progress) override;
  ElementField source(const ReflectedMesh& mesh) const override;
  ElementField apply(const ReflectedMesh& mesh, const ElementField& leaving) const override;
  std::vector<int> seen_from(const ReflectedMesh& mesh, int element) const override;
  bool stopped() const override { return stop_.stop_requested(); }
  /// Updates, and makes elements constant that face others within half of their own width, as
  /// shelves do that all but lie on each other, where both reflect much. What polynomials on either
  /// side of such a gap make of each other at the nodes may be more than it was: light that goes to
  /// and fro grew with each bounce, or hardly fell. Those are to be updated again. False if
  /// stopped.
  bool lower_orders_in_gaps(ReflectedMesh& mesh, const Progress& progress);

  bool find_losses(const ReflectedMesh& mesh, const LightSystems& systems, double enough,
                   const Progress& progress) override;
  double unsure_loss(int element) const override { return losses_.unsure[at(element)]; }
  Eigen::VectorXd seen(int element) const override { return losses_.seen[at(element)]; }
  const BackShadow* shadow(int element) const override;

  /// What K (S + leaving) is off because the rays are few.
  FieldNoise noise(const ReflectedMesh& mesh, const ElementField& leaving) const;

  /// Makes the noise of each element what 2 strata² rays from each node would leave.
  void scale_to_all_rays(const ReflectedMesh& mesh, std::vector<double>& noise) const;

  std::size_t rays() const { return traced_; }

  /// Rays over the hemisphere from a node, but for elements that are small among many.
  double most_rays() const { return 2. * strata_ * strata_; }

  /// The same of each element.
  std::vector<double> rays_of_nodes(const ReflectedMesh& mesh) const;

 private:
  bool is_in_gap(const ReflectedMesh& mesh, int element) const;

  const ReflectingScene& scene_;
  const FirstLight& light_;
  int strata_;
  std::size_t traced_ = 0;
  std::stop_token stop_;                                ///< of the last update
  std::vector<std::unique_ptr<NodeRays>> of_triangle_;  ///< of the forest; none where split
  RayLosses losses_;
};

/// The origin of rays at a place of an element.
RayOrigin ray_origin(const ReflectingScene& scene, const ReflectedMesh& mesh, int element,
                     const TrianglePlace& place);

/// A seed for the rays of a node of an element; `use` tells apart what is to be independent.
std::uint64_t ray_seed(const ReflectedMesh& mesh, int element, int node, int use);

/// Two hemispheres of strata² rays above each node of an element, of two uses.
std::vector<RayHemisphere> halves_of_nodes(const ReflectingScene& scene, const ReflectedMesh& mesh,
                                           int element, int strata, std::array<int, 2> uses);

/// ρ times a field.
ElementField reflected_part(const ReflectedMesh& mesh, const FirstLight& light,
                            const ElementField& field);

}  // namespace halfshade
