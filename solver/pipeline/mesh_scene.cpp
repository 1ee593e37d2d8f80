#include "solver/pipeline/mesh_scene.h"

#include "meshing/core/error.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

/// Of the work that a tolerance is worth.
constexpr double share_to_label = 0.06;

void check(const MeshOptions& options) {
  const auto is_usable = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!is_usable(options.tolerance) || !is_usable(options.max_length) || options.secondary < 0)
    throw Error(ErrorCode::contract, "mesh_scene",
                fmt::format("tolerance ({}), max_length ({}) and secondary ({}) must be finite and "
                            "not negative",
                            options.tolerance, options.max_length, options.secondary));
}

/// Finds the curves, and what their effect is measured against.
void find_curves(const PreparedScene& prepared, const MeshOptions& options,
                 const Progress& progress, Stages& stages, MeshResult& result) {
  std::vector<LightSource> sources;
  stages.run("sources", [&] {
    sources = all_sources(prepared, options.secondary, progress);
    return sources.size();
  });
  if (options.tolerance > 0)
    stages.run("tolerance", [&] {
      result.irradiance_tolerance = options.tolerance * mean_direct_irradiance(prepared, progress);
      return std::size_t{1};
    });
  stages.run("discontinuities", [&] {
    DiscontinuityOptions events = options.events;
    events.irradiance_tolerance = result.irradiance_tolerance;
    events.max_length = options.max_length;
    if (!(events.most_work > 0)) events.most_work = affordable_work(options.tolerance);
    result.found =
        find_discontinuities(prepared.scene(), prepared.opaque(), sources, events, progress);
    return result.found.curves.size();
  });
}

/// Refuses what would take too long to label.
DiscontinuityMesh make_mesh(const PreparedScene& prepared, const MeshOptions& options,
                            const Progress& progress, const MeshResult& result) {
  DiscontinuityMeshOptions mesh_options;
  mesh_options.max_length = options.max_length;
  mesh_options.irradiance_tolerance = result.irradiance_tolerance;
  const double for_one =
      result.found.report.look_work * static_cast<double>(result.found.sources.size() + 1);
  const double most = share_to_label * affordable_work(options.tolerance) / std::max(for_one, 1.);
  if (most > 0 && most < static_cast<double>(mesh_options.max_triangles))
    mesh_options.max_triangles = static_cast<std::size_t>(std::max(most, 1.));
  try {
    return mesh_discontinuities(prepared.scene(), result.found, mesh_options, progress);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::too_large || !(most > 0)) throw;
    throw Error(ErrorCode::too_large, "mesh_scene",
                fmt::format("the {} surfaces with their contact lines and curves take more than {} "
                            "elements, which is all that can be labelled in the time that a "
                            "tolerance is worth; --tolerance 0 takes all the time there is",
                            prepared.scene().surfaces.size(), mesh_options.max_triangles));
  }
}

/// Meshes and labels what was found.
void make_elements(const PreparedScene& prepared, const MeshOptions& options,
                   const Progress& progress, Stages& stages, MeshResult& result) {
  stages.run("mesh", [&] {
    const DiscontinuityMesh mesh = make_mesh(prepared, options, progress, result);
    result.mesh = mesh.report;
    result.elements = mesh.patches.elements();
    return result.elements.corners.size();
  });
  stages.run("regions", [&] {
    result.regions = label_elements(prepared.scene(), prepared.opaque(), result.elements,
                                    result.found.sources, progress);
    for (const DirectLight& light :
         prepared.direct_light().irradiance(element_centres(result.elements), progress))
      result.region.push_back(light.region);
    return result.regions.size();
  });
}

}  // namespace

ContactLimit mesh_contact_limit() {
  const std::size_t most = DiscontinuityMeshOptions{}.max_triangles;
  return {static_cast<double>(most), contacts_warning(static_cast<int>(most), false)};
}

MeshResult mesh_scene(const Scene& scene, const MeshOptions& options, const Progress& progress) {
  check(options);
  return use_prepared(scene, mesh_contact_limit(), progress, [&](const PreparedScene& prepared) {
    return mesh_scene(prepared, options, progress);
  });
}

MeshResult mesh_scene(const PreparedScene& prepared, const MeshOptions& options,
                      const Progress& progress) {
  check(options);
  auto result = begin_result<MeshResult>(prepared);
  Stages stages(result.stages);
  find_curves(prepared, options, progress, stages, result);
  add(search_warnings(result.found.report, options.tolerance), result.warnings);
  if (options.with_elements) make_elements(prepared, options, progress, stages, result);
  stages.leave_out_if(!options.with_elements, "mesh", "only the curves were asked for");
  result.interrupted = progress.stopped();
  return result;
}

}  // namespace halfshade
