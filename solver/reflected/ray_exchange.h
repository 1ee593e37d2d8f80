#pragma once

#include "meshing/core/progress.h"
#include "solver/reflected/field_noise.h"
#include "solver/reflected/first_light.h"
#include "solver/reflected/irradiance_operator.h"
#include "solver/reflected/quick_field.h"
#include "solver/reflected/reflected_mesh.h"

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace halfshade {

/// Where the rays from the nodes of an element end, and what comes from there first. Those of each
/// node are two halves, 2 node and 2 node + 1, that tell their noise.
struct NodeRays {
  std::vector<RayEnd> ends;  ///< on triangles of the forest
  std::vector<int> first;    ///< half → its first end, and the number of ends
  std::vector<int> rays;     ///< half → number of rays that its ends are taken from
  ChannelArray source;       ///< half → irradiance from S
  int strata = 0;            ///< squared, rays of a half over the hemisphere
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
  const ReflectingScene& scene_;
  const FirstLight& light_;
  int strata_;
  std::size_t traced_ = 0;
  std::vector<std::unique_ptr<NodeRays>> of_triangle_;  ///< of the forest; none where split
};

/// The origin of rays at a place of an element.
RayOrigin ray_origin(const ReflectingScene& scene, const ReflectedMesh& mesh, int element,
                     const TrianglePlace& place);

/// Rays over the hemisphere above a place, as strata² and others aimed at hot cells.
struct Gathering {
  const ReflectingScene& scene;
  const FirstLight& light;
  Looks looks = Looks::exact;

  /// Irradiance from S. Puts the ends on roots into `ends`, and returns the number of rays that
  /// each of them is one of.
  struct Result {
    Rgb first;
    int rays;
  };
  Result operator()(const RayOrigin& from, int strata, std::uint64_t seed,
                    std::vector<RayEnd>& ends) const;

  /// How many rays that takes.
  std::size_t rays(int strata) const;
};

/// The same from S and from a field on the elements, by triangles.
Rgb gathered(const Gathering& gathering, const ReflectedMesh& mesh, const QuickField& leaving,
             const RayOrigin& from, int strata, std::uint64_t seed);

/// A seed for the rays of a node of an element; `use` tells apart what is to be independent.
std::uint64_t ray_seed(const ReflectedMesh& mesh, int element, int node, int use);

/// ρ times a field.
ElementField reflected_part(const ReflectedMesh& mesh, const FirstLight& light,
                            const ElementField& field);

}  // namespace halfshade
