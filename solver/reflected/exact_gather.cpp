#include "solver/reflected/exact_gather.h"

#include "solver/reflected/exact_exchange.h"
#include "solver/reflected/forest_field.h"

namespace halfshade {
namespace {

QuickField all_leaving(const FirstLight& light, const ReflectedMesh& mesh,
                       const ElementField& leaving, const ReflectedMesh& fine, int direct_points,
                       Rgb& brightest) {
  DirectProjection direct(direct_points);
  direct.update(fine, light);
  ElementField all = restricted(mesh, leaving, fine);
  all.coefficients += direct.leaving(fine, light).coefficients;
  for (int e = 0; e < all.count(); ++e)
    brightest = brightest.max(all.of(e).row(0).transpose().abs());
  return QuickField(forest_field(fine, all));
}

}  // namespace

ExactGather::ExactGather(const ExactSight& sight, const ReflectingScene& scene,
                         const FirstLight& light, const ReflectedMesh& mesh,
                         const ElementField& leaving, const RowAccuracy& accuracy,
                         int direct_points)
    : sight_(sight),
      scene_(scene),
      mesh_(bisected(mesh, 2)),
      leaving_(all_leaving(light, mesh, leaving, mesh_, direct_points, brightest_)),
      maker_(sight, mesh_, accuracy) {}

ExactGather::Gathered ExactGather::gather(int root, const Vec3& position,
                                          std::span<const Sighted> targets) const {
  IrradianceRow row;
  make_closed_row(maker_, scene_, root, position, targets, row);
  return {halfshade::irradiance(row, leaving_), row.sum, row.unsure};
}

Rgb ExactGather::leaving(int surface, const Vec3& position) const {
  const ForestPlace leaf = mesh_.forest.leaf_at(surface, position);
  return leaf.triangle < 0 ? Rgb(Rgb::Zero()) : leaving_.value(leaf.triangle, leaf.place);
}

Rgb ExactGather::irradiance(const SurfacePoint& point) const {
  return halfshade::irradiance(maker_.row(point, sight_.may_see(point)), leaving_);
}

}  // namespace halfshade
