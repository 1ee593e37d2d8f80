#include "meshing/patches/discontinuity_mesh.h"

#include "meshing/core/error.h"
#include "meshing/patches/curve_polylines.h"
#include "meshing/patches/margins.h"
#include "meshing/patches/shared_edges.h"
#include "meshing/patches/surface_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

void check(const SoundScene& scene, const Discontinuities& found,
           const DiscontinuityMeshOptions& options) {
  const auto refuse = [](const std::string& sentence) {
    throw Error(ErrorCode::contract, "mesh_discontinuities", sentence);
  };
  if (!(options.max_length >= 0 && std::isfinite(options.max_length)))
    refuse(fmt::format("max_length is {}; it must be finite and not negative", options.max_length));
  if (!(options.irradiance_tolerance >= 0 && std::isfinite(options.irradiance_tolerance)))
    refuse(fmt::format("irradiance_tolerance is {}; it must be finite and not negative",
                       options.irradiance_tolerance));
  if (!(options.deviation >= 0 && options.deviation < 1))
    refuse(fmt::format("deviation is {}; it must be in [0, 1)", options.deviation));
  for (std::size_t i = 0; i < found.curves.size(); ++i) {
    const DiscontinuityCurve& curve = found.curves[i];
    if (curve.receiver < 0 || at(curve.receiver) >= scene.surfaces.size())
      refuse(fmt::format("curve {} lies in surface {} of {}", i, curve.receiver,
                         scene.surfaces.size()));
    if (curve.order < 0) refuse(fmt::format("curve {} has order {}", i, curve.order));
  }
}

CurveMeshOptions curve_mesh_options(const Surface& surface,
                                    const DiscontinuityMeshOptions& options) {
  const double size = size_of(surface);
  CurveMeshOptions result;
  result.quality = {options.max_length, options.min_angle, options.max_triangles};
  result.snap = std::min(margins::snap_of_magnitude * surface.scale.magnitude,
                         margins::snap_of_surface * size);
  // What is drawn more closely must not be snapped away again.
  if (options.deviation > 0)
    result.snap = std::min(result.snap, margins::snap_of_deviation * options.deviation * size);
  result.snap = std::max(result.snap, tolerance_of(surface).length);
  result.shortest = margins::shortest_with_curves * size;
  if (options.max_length > 0)
    result.shortest = std::min(result.shortest, margins::shortest_of_longest * options.max_length);
  result.shortest = std::max(result.shortest, 2 * result.snap);
  return result;
}

// Curves on both sides of a shared edge end there in the same point but for rounding.
void share_ends(SharedEdges& shared, const SurfaceMeshInput& input) {
  std::vector<SharedEdges::End> ends;
  for (std::size_t r = 0; r < input.curves.size(); ++r)
    for (const CurvePolyline& curve : input.curves[r])
      for (const Vec2& p : {curve.points.front(), curve.points.back()})
        ends.push_back({static_cast<int>(r), p, input.options[r].snap});
  shared.add(ends);
}

}  // namespace

DiscontinuityMesh mesh_discontinuities(const SoundScene& scene, const Discontinuities& found,
                                       const DiscontinuityMeshOptions& options,
                                       const Progress& progress) {
  check(scene, found, options);
  check_size(scene, {options.max_length, options.min_angle, options.max_triangles});
  CurvePolylines curves = curve_polylines(scene, found, options);
  SurfaceMeshInput input{std::move(curves.of_surface), {}};
  for (const Surface& surface : scene.surfaces)
    input.options.push_back(curve_mesh_options(surface, options));
  SharedEdges shared(scene);
  share_ends(shared, input);
  const SurfaceMeshes made = mesh_surfaces(input, shared, options.max_triangles, progress);

  DiscontinuityMeshReport report;
  report.kept = curves.kept;
  report.culled = curves.culled;
  report.boundary_rounds = made.rounds;
  for (std::size_t r = 0; r < made.meshes.size(); ++r) {
    const CurveMesh& mesh = made.meshes[r];
    // Without those that were stopped before their curves were in.
    if (!input.curves[r].empty() && (mesh.mesh.complete || !mesh.curves.empty()))
      report.deviation = std::max(report.deviation, mesh.deviation + curves.deviation[r]);
    if (!mesh.mesh.complete) ++report.unfinished_surfaces;
  }
  std::vector<int> order;
  for (const DiscontinuityCurve& curve : found.curves) order.push_back(curve.order);
  return {PatchMesh(scene, shared, made.meshes, order), report};
}

}  // namespace halfshade
