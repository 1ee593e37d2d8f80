#pragma once

#include "meshing/backprojection/sight_effort.h"
#include "meshing/backprojection/visible_part.h"
#include "meshing/core/progress.h"
#include "meshing/patches/element_table.h"
#include "solver/elements/solution.h"

#include <memory>
#include <span>
#include <vector>

namespace halfshade {

/// A point on a surface.
struct SurfacePoint {
  Vec3 position;
  Vec3 normal;  ///< unit length; light from behind it does not count
};

/// Where a field on surfaces is asked for.
struct FieldPoint {
  SurfacePoint point;
  int surface;
};

/// The light that reaches a point straight from one emitter, per unit of exitance.
struct PointFactor {
  double visible = 0;  ///< form factor to the visible part: exactly 0 in umbra
  double unobstructed =
      0;  ///< form factor to the whole emitter above the horizon; equal to `visible` if lit
  Region region = Region::away;
  std::uint64_t signature = 0;
};

/// The same with derivatives with respect to the point, for a fixed normal.
struct PointFactorDerivatives {
  PointFactor factor;
  Vec3 gradient = Vec3::Zero();                       ///< ∂F/∂x
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();  ///< ∂²F/∂x²
};

struct DirectLight {
  Rgb irradiance = Rgb::Zero();  ///< H in W/m²
  /// Share of the light that would arrive unobstructed, weighted with the emitters' exitance (mean
  /// of the channels): 0 in umbra of all, 1 if nothing is hidden; 1 where no emitter lies above the
  /// horizon.
  double visible = 1;
  Region region =
      Region::away;  ///< with respect to the emitter that gives the most unobstructed light
  /// How much was looked at where so much lies before an emitter that it is cut into cells, in
  /// faces and crossings, 1 to 2 µs each; 0 elsewhere. Follows from point and scene alone.
  std::size_t crowd_work = 0;
  SightEffort effort;  ///< what it took, the same
};

/// About how many rays take as long as looks that took so much.
double in_rays(const SightEffort& effort, double crowd_work);

/// Exact direct light of a scene: no sampling, correct to rounding. All calls may run concurrently;
/// buffers are kept between calls, so that in the steady state nothing is allocated per point.
class DirectLightIndex {
 public:
  explicit DirectLightIndex(const SoundScene& scene);
  /// On an opaque scene that others use, too; `opaque` must be made of `scene`.
  DirectLightIndex(const SoundScene& scene, std::shared_ptr<const OpaqueScene> opaque);
  ~DirectLightIndex();
  DirectLightIndex(DirectLightIndex&&) noexcept;
  DirectLightIndex& operator=(DirectLightIndex&&) noexcept;

  /// The surfaces with E > 0.
  std::span<const int> emitters() const;

  /// Form factor from a point to the visible part of one emitter; any other surface will do, too.
  /// Throws Error(contract) for an id that does not exist.
  PointFactor factor(const SurfacePoint& point, int emitter) const;

  /// The same with derivatives by closed forms, exact within a cell of the discontinuity mesh.
  PointFactorDerivatives factor_derivatives(const SurfacePoint& point, int emitter) const;

  /// What the point sees of one surface.
  void visible_part(const SurfacePoint& point, int surface, VisiblePart& part) const;

  /// Irradiance at points from all emitters, on all threads; the result does not depend on their
  /// number. If stopped, points not reached keep the defaults.
  std::vector<DirectLight> irradiance(std::span<const SurfacePoint> points,
                                      const Progress& progress = {}) const;

  /// The same for one point on the calling thread, from all emitters or one.
  DirectLight irradiance(const SurfacePoint& point) const;
  DirectLight irradiance(const SurfacePoint& point, int emitter) const;

  /// The emitter that gives a point the most light if nothing is in between; −1 if none does.
  int strongest_emitter(const SurfacePoint& point) const;

  /// DirectLight::region alone, which takes one emitter's visible part.
  Region region(const SurfacePoint& point) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The centroid of each element, for exact light there.
std::vector<SurfacePoint> element_centres(const ElementTable& elements);

/// Direct light on the elements of a mesh, per unit of exitance.
struct ElementDirectLight {
  std::vector<int> emitters;  ///< surfaces with E > 0
  Eigen::ArrayXXd factor;     ///< mean form factor: one row an element, one column an emitter
  std::vector<Region>
      region;  ///< of each element, with respect to the emitter that is strongest there
};

/// Form factors from points to the visible parts of all emitters, averaged over each element by the
/// symmetric rule with at least `points_per_element` nodes (at most 12); see triangle_rule. Only
/// the averaging is approximate. An element is in the penumbra if its points do not agree. On all
/// threads; if stopped, elements not reached stay zero.
ElementDirectLight element_direct_light(const SoundScene& scene, const ElementTable& elements,
                                        const DirectLightIndex& index, int points_per_element,
                                        const Progress& progress = {});

/// Irradiance in W/m² that comes of it, one row an element.
ChannelArray irradiance_of(const ElementDirectLight& light, const SoundScene& scene);

}  // namespace halfshade
