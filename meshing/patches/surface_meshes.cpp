#include "meshing/patches/surface_meshes.h"

#include "meshing/core/error.h"
#include "meshing/core/parallel.h"
#include "meshing/patches/margins.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

namespace halfshade {
namespace {

// Neighbours mostly agree after one to four; what is left then is split plainly.
constexpr int most_rounds = 8;

CurveMesh coarse_mesh(const Outline& outline) {
  CurveMesh result;
  result.mesh = triangulate(outline.rings, outline.contacts);
  result.mesh.complete = false;
  result.is_d0.assign(result.mesh.constrained_edges.size(), true);
  result.curve_begin.assign(result.mesh.constrained_edges.size() + 1, 0);
  return result;
}

void check_count(std::size_t count, std::size_t surfaces, std::size_t allowed) {
  if (count > allowed)
    throw Error(ErrorCode::too_large, {},
                fmt::format("the {} surfaces take more than the {} elements that are allowed",
                            surfaces, allowed));
}

}  // namespace

SurfaceMeshInput without_curves(const SoundScene& scene, const PlanarMeshOptions& options) {
  SurfaceMeshInput input;
  input.curves.resize(scene.surfaces.size());
  for (const Surface& surface : scene.surfaces) {
    CurveMeshOptions& own = input.options.emplace_back();
    own.quality = options;
    ++own.quality.max_triangles;  // so that what ends early there is too large
    own.snap = tolerance_of(surface).length;
    own.shortest = margins::shortest_without_curves * size_of(surface);
    if (options.max_length > 0)
      own.shortest = std::min(own.shortest, margins::shortest_of_longest * options.max_length);
    own.shortest = std::max(own.shortest, 2 * own.snap);
  }
  return input;
}

SurfaceMeshes mesh_surfaces(const SurfaceMeshInput& input, SharedEdges& shared,
                            std::size_t max_triangles, const Progress& progress) {
  const std::size_t count = input.options.size();
  SurfaceMeshes result;
  std::vector<CurveMesh>& meshes = result.meshes;
  meshes.resize(count);
  std::atomic<std::size_t> triangles{0};
  const auto mesh = [&](int r) {
    // What is too large need not be finished: refinement only ever adds triangles.
    if (triangles > max_triangles) return;
    triangles -= meshes[at(r)].mesh.triangles.size();
    const Outline outline = shared.outline(r);
    meshes[at(r)] = mesh_with_curves(outline.rings, outline.contacts, input.curves[at(r)],
                                     input.options[at(r)]);
    triangles += meshes[at(r)].mesh.triangles.size();
  };
  std::vector<int> open(count);
  std::iota(open.begin(), open.end(), 0);
  while (!open.empty()) {
    ++result.rounds;
    const bool is_complete = parallel_for(
        open.size(), [&](std::size_t i) { mesh(open[i]); }, progress, "mesh");
    check_count(triangles, count, max_triangles);
    if (!is_complete || result.rounds == most_rounds) break;
    open = shared.compare(meshes);
  }
  for (std::size_t r = 0; r < count; ++r)
    if (meshes[r].mesh.triangles.empty())
      meshes[r] = coarse_mesh(shared.outline(static_cast<int>(r)));
  std::size_t made = 0;
  for (const CurveMesh& mesh : meshes) made += mesh.mesh.triangles.size();
  check_count(made, count, max_triangles);
  return result;
}

// No triangle with edges up to h is larger than the equilateral one.
void check_size(const SoundScene& scene, const PlanarMeshOptions& options) {
  double least = 0;
  if (options.max_length > 0)
    for (const Surface& surface : scene.surfaces)
      least += area(surface) / options.max_length / options.max_length / (std::sqrt(3.0) / 4);
  if (least > static_cast<double>(options.max_triangles))
    throw Error(ErrorCode::too_large, {},
                fmt::format("edges of at most {} need at least {:.0f} elements; {} are allowed",
                            options.max_length, least, options.max_triangles));
}

}  // namespace halfshade
