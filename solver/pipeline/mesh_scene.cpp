#include "solver/pipeline/mesh_scene.h"

#include "meshing/backprojection/visible_part.h"
#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/discontinuity/search_budget.h"
#include "solver/direct/direct_light.h"
#include "solver/pipeline/middle.h"
#include "solver/pipeline/plan.h"
#include "solver/pipeline/prepared_scene.h"
#include "solver/pipeline/solve_mesh.h"
#include "solver/pipeline/sources.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace halfshade {
namespace {

/// Of the work that a tolerance is worth.
constexpr double share_to_label = 0.2;
/// Where curves take too many elements, the tolerance by which they are left out is so many times
/// as large, and again, up to so many times the mean irradiance: no curve of order 1 and more
/// matters then.
constexpr double raise = 4, all_light = 1e6;

void check(const MeshOptions& options) {
  const auto is_usable = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!is_usable(options.tolerance) || !is_usable(options.max_length) || options.secondary < 0 ||
      !is_usable(options.label_work) || !(options.deviation >= 0 && options.deviation < 1))
    throw Error(
        ErrorCode::contract, "mesh_scene",
        fmt::format("tolerance ({}), max_length ({}), label_work ({}) and secondary ({}) must be "
                    "finite and not negative, and deviation ({}) in [0, 1)",
                    options.tolerance, options.max_length, options.label_work, options.secondary,
                    options.deviation));
}

/// Work that it takes to see what an element sees of a source: the mean of some surfaces.
double mean_look_work(const PreparedScene& prepared, const std::vector<LightSource>& sources) {
  constexpr std::size_t most = 32;
  const std::vector<Surface>& surfaces = prepared.scene().surfaces;
  const std::size_t count = sources.empty() ? 0 : std::min(most, surfaces.size());
  VisiblePartFinder finder(prepared.opaque());
  VisiblePart part;
  for (std::size_t k = 0; k < count; ++k) {
    const Surface& surface = surfaces[k * surfaces.size() / count];
    finder.find(middle(surface), surface.frame.normal, sources[k % sources.size()].surface, part);
  }
  return count > 0 ? work_of(finder.effort()) / static_cast<double>(count) : 0;
}

/// So many elements can be labelled in the time that a tolerance is worth.
std::size_t most_elements(const PreparedScene& prepared, const std::vector<LightSource>& sources,
                          const MeshOptions& options) {
  const std::size_t most = DiscontinuityMeshOptions{}.max_triangles;
  if (!(options.tolerance > 0)) return most;
  // Each source's part, and what all give.
  const double for_one =
      mean_look_work(prepared, sources) * static_cast<double>(sources.size() + 1);
  const double affordable = options.label_work > 0
                                ? options.label_work
                                : share_to_label * affordable_work(options.tolerance);
  return for_one * static_cast<double>(most) > affordable
             ? static_cast<std::size_t>(std::max(affordable / for_one, 1.))
             : most;
}

[[noreturn]] void refuse_labels(const PreparedScene& prepared, std::size_t most) {
  throw Error(ErrorCode::too_large, {},
              fmt::format("the {} surfaces with their contact lines and curves take more than {} "
                          "elements, which is all that can be labelled in the time that a "
                          "tolerance is worth; --tolerance 0 takes all the time there is",
                          prepared.scene().surfaces.size(), most));
}

bool is_limited(const DiscontinuityMeshOptions& options) {
  return options.max_triangles < DiscontinuityMeshOptions{}.max_triangles;
}

/// Nothing if it takes more elements than can be labelled.
std::optional<DiscontinuityMesh> mesh_within(const PreparedScene& prepared,
                                             const Discontinuities& found,
                                             const DiscontinuityMeshOptions& options,
                                             const Progress& progress) {
  try {
    return mesh_discontinuities(prepared.scene(), found, options, progress);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::too_large || !is_limited(options)) throw;
    return std::nullopt;
  }
}

/// Throws Error(too_large) where surfaces and contact lines alone are too many, before time goes
/// into finding curves.
void require_room(const PreparedScene& prepared, const DiscontinuityMeshOptions& options,
                  const Progress& progress) {
  if (is_limited(options) && (least_elements(prepared.scene()) > options.max_triangles ||
                              !mesh_within(prepared, {}, options, progress)))
    refuse_labels(prepared, options.max_triangles);
}

Warning fewer_curves_warning(const DiscontinuityMeshReport& mesh, std::size_t most) {
  return {Warning::Kind::curves_left_out,
          fmt::format("elements follow only {} of the {} curves, those that change light most: "
                      "with more they are more than the {} that can be labelled in the time that a "
                      "tolerance is worth; --tolerance 0 takes all the time there is",
                      mesh.kept, mesh.kept + mesh.culled, most)};
}

/// Finds the curves, and what their effect is measured against.
void find_curves(const PreparedScene& prepared, const std::vector<LightSource>& sources,
                 const MeshOptions& options, const Progress& progress, Stages& stages,
                 MeshResult& result) {
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

/// Along those curves that matter most where all would take more elements than can be labelled.
DiscontinuityMesh make_mesh(const PreparedScene& prepared, const MeshOptions& asked_for,
                            DiscontinuityMeshOptions options, const Progress& progress,
                            MeshResult& result) {
  auto mesh = mesh_within(prepared, result.found, options, progress);
  const bool fits = mesh.has_value();
  for (double share = asked_for.tolerance; !mesh && share < all_light; share *= raise) {
    result.irradiance_tolerance *= raise;
    options.irradiance_tolerance = result.irradiance_tolerance;
    mesh = mesh_within(prepared, result.found, options, progress);
  }
  if (!mesh) refuse_labels(prepared, options.max_triangles);
  if (!fits) add({fewer_curves_warning(mesh->report, options.max_triangles)}, result.warnings);
  return *std::move(mesh);
}

/// Whether nothing was left out, so that all of a cell between curves sees the same of a source.
bool is_complete(const MeshResult& result, const DiscontinuityOptions& events) {
  const DiscontinuityReport& search = result.found.report;
  return events.contact && events.face && events.ev && events.eee && events.horizon &&
         !search.interrupted && result.irradiance_tolerance == 0 && result.mesh.culled == 0 &&
         result.mesh.unfinished_surfaces == 0 &&
         std::all_of(search.left_out.begin(), search.left_out.end(),
                     [](double work) { return work == 0; });
}

/// Labels of each element with respect to the strongest emitter there, which is among the sources.
std::vector<Region> strongest_regions(const DirectLightIndex& index, const MeshResult& result,
                                      const Progress& progress) {
  const std::vector<LightSource>& sources = result.found.sources;
  std::map<int, std::size_t> column;
  for (std::size_t s = 0; s < sources.size(); ++s) column.emplace(sources[s].surface, s);
  const std::vector<SurfacePoint> centres = element_centres(result.elements);
  std::vector<Region> strongest(centres.size(), Region::away);
  parallel_for(
      centres.size(),
      [&](std::size_t e) {
        const int emitter = index.strongest_emitter(centres[e]);
        if (emitter >= 0) strongest[e] = result.regions[e * sources.size() + column.at(emitter)];
      },
      progress, "regions");
  return strongest;
}

/// Meshes and labels what was found.
void make_elements(const PreparedScene& prepared, const DiscontinuityMeshOptions& mesh_options,
                   const MeshOptions& options, const Progress& progress, Stages& stages,
                   MeshResult& result) {
  stages.run("mesh", [&] {
    const DiscontinuityMesh mesh = make_mesh(prepared, options, mesh_options, progress, result);
    result.mesh = mesh.report;
    result.elements = mesh.patches.elements();
    return result.elements.corners.size();
  });
  stages.run("regions", [&] {
    const auto label = is_complete(result, options.events) ? label_cells : label_elements;
    result.regions =
        label(prepared.scene(), prepared.opaque(), result.elements, result.found.sources, progress);
    result.region = strongest_regions(prepared.direct_light(), result, progress);
    return result.regions.size();
  });
}

}  // namespace

ContactLimit mesh_contact_limit() {
  const std::size_t most = DiscontinuityMeshOptions{}.max_triangles;
  return {static_cast<double>(most), contacts_warning()};
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
  std::vector<LightSource> sources;
  stages.run("sources", [&] {
    sources = all_sources(prepared, options.secondary, progress);
    return sources.size();
  });
  DiscontinuityMeshOptions mesh_options;
  mesh_options.max_length = options.max_length;
  mesh_options.deviation = options.deviation;
  if (options.with_elements) {
    mesh_options.max_triangles = most_elements(prepared, sources, options);
    require_room(prepared, mesh_options, progress);
  }
  find_curves(prepared, sources, options, progress, stages, result);
  mesh_options.irradiance_tolerance = result.irradiance_tolerance;
  add(search_warnings(result.found.report, options.tolerance), result.warnings);
  if (options.with_elements)
    make_elements(prepared, mesh_options, options, progress, stages, result);
  stages.leave_out_if(!options.with_elements, "mesh", "only the curves were asked for");
  result.interrupted = progress.stopped();
  return result;
}

}  // namespace halfshade
