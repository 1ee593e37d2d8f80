#include "meshing/patches/patch_mesh.h"

#include "meshing/core/error.h"
#include "meshing/patches/build_element_mesh.h"
#include "meshing/patches/detail/element_mesh.h"
#include "meshing/patches/make_element_table.h"
#include "meshing/patches/merge_elements.h"
#include "meshing/patches/refine_elements.h"
#include "meshing/patches/surface_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {

struct PatchMesh::Impl {
  std::vector<SurfaceLabels> surfaces;
  ElementMesh elements;
};

PatchMesh::PatchMesh(const SoundScene& scene, const PlanarMeshOptions& options,
                     const Progress& progress) {
  check_size(scene, options);
  SharedEdges shared(scene);
  const SurfaceMeshes made =
      mesh_surfaces(without_curves(scene, options), shared, options.max_triangles, progress);
  impl_ = std::make_unique<Impl>(
      Impl{surface_labels(scene), build_element_mesh(scene, shared, made.meshes, {})});
}

PatchMesh::PatchMesh(const SoundScene& scene, const SharedEdges& shared,
                     std::span<const CurveMesh> meshes, std::span<const int> curve_order) {
  if (meshes.size() != scene.surfaces.size())
    throw Error(
        ErrorCode::contract, "PatchMesh",
        fmt::format("{} meshes are given for {} surfaces", meshes.size(), scene.surfaces.size()));
  impl_ = std::make_unique<Impl>(
      Impl{surface_labels(scene), build_element_mesh(scene, shared, meshes, curve_order)});
}

PatchMesh::~PatchMesh() = default;
PatchMesh::PatchMesh(PatchMesh&&) noexcept = default;
PatchMesh& PatchMesh::operator=(PatchMesh&&) noexcept = default;

int PatchMesh::element_count() const {
  return static_cast<int>(impl_->elements.triangles.n_faces());
}

ElementTable PatchMesh::elements() const {
  return make_element_table(impl_->elements, impl_->surfaces);
}

PatchHierarchy PatchMesh::hierarchy() const {
  const ElementForest& forest = impl_->elements.forest;
  PatchHierarchy result{forest.parent, forest.level, std::vector<int>(at(forest.count()), -1)};
  int element = 0;
  for (const auto face : ordered_faces(impl_->elements))
    result.element[at(impl_->elements.triangles.data(face).node)] = element++;
  return result;
}

std::array<Vec3, 3> PatchMesh::triangle(int node) const {
  auto corners = impl_->elements.forest.corners.at(at(node));
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::array<Vec3, 3> result;
  for (std::size_t k = 0; k < 3; ++k) result[k] = position(impl_->elements.triangles, corners[k]);
  return result;
}

void PatchMesh::split_in_four(std::span<const int> elements) {
  halfshade::split_in_four(impl_->elements, elements);
}

void PatchMesh::bisect(std::span<const int> elements) {
  halfshade::bisect(impl_->elements, elements);
}

std::vector<int> PatchMesh::merge(std::span<const int> elements) {
  return merge_parts(impl_->elements, elements);
}

double length_for_count(const SoundScene& scene, int element_count) {
  if (element_count < 1)
    throw Error(ErrorCode::contract, "length_for_count",
                fmt::format("{} elements are asked for; it takes at least 1", element_count));
  // Measured over rooms: triangles of a mesh with longest edge h have 0.2 h² on average.
  constexpr double mean_area = 0.2;
  double total = 0;
  for (const Surface& surface : scene.surfaces) total += area(surface);
  return std::sqrt(total / (mean_area * element_count));
}

}  // namespace halfshade
