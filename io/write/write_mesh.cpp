#include "io/write/write_mesh.h"

#include "io/files/atomic_file.h"
#include "io/files/consistency.h"
#include "io/write/detail/vtk_file.h"
#include "io/write/ply_file.h"
#include "meshing/core/error.h"
#include "solver/elements/material_arrays.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointSet.h>

#include <iterator>

namespace halfshade {
namespace {

using namespace detail;

void add_cell_data(const MeshResult& result, vtkFieldData* data) {
  const ElementTable& elements = result.elements;
  const MaterialArrays materials = material_arrays(result.scene, elements);
  add_channels(data, "exitance", materials.exitance);
  add_channels(data, "reflectance", materials.rho);
  add_integers(data, "region", region_codes(result.region));
  if (!result.found.sources.empty())
    add_integers(data, "regions", region_codes(result.regions),
                 static_cast<int>(result.found.sources.size()));
  add_element_data(elements, data);
  add_edge_orders(elements, data);
}

void add_field_data(const MeshResult& result, vtkFieldData* data) {
  add_interrupted(data, result.interrupted);
  add_cameras(data, result.cameras);
  add_sources(data, result.found.sources);
  add_numbers(data, "irradiance_tolerance", {result.irradiance_tolerance});
  add_numbers(data, "curve_deviation", {result.mesh.deviation});
}

std::string vtk(const MeshResult& result, std::string_view extension) {
  const auto grid = element_grid(result.elements, extension);
  add_cell_data(result, grid->GetCellData());
  add_field_data(result, grid->GetFieldData());
  return vtk_bytes(grid, "write_mesh");
}

/// As text, because meshio reads numbers of faces beside their corners in no other form.
/// Coordinates keep all their digits.
std::string ply(const MeshResult& result, const Provenance& provenance) {
  const ElementTable& elements = result.elements;
  std::string bytes = fmt::format(
      "{}{}"
      "element vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n"
      "element face {}\n"
      "property list uchar int vertex_indices\n"
      "property int surface\nproperty uchar region\n"
      "end_header\n",
      ply_head(text_ply, provenance, result.unit),
      result.interrupted ? "comment interrupted: the mesh is not complete\n" : "",
      elements.points.size(), elements.count());
  const auto out = std::back_inserter(bytes);
  for (const Vec3& p : elements.points) fmt::format_to(out, "{} {} {}\n", p.x(), p.y(), p.z());
  for (std::size_t e = 0; e < elements.corners.size(); ++e)
    fmt::format_to(out, "3 {} {} {}\n", fmt::join(elements.corners[e], " "), elements.surface[e],
                   static_cast<int>(result.region[e]));
  return bytes;
}

void require_labels(const MeshResult& result) {
  const std::size_t n = result.elements.corners.size(), orders = result.elements.edge_order.size();
  const std::size_t sources = result.found.sources.size();
  if (result.region.size() != n || result.regions.size() != n * sources ||
      (orders != n && orders != 0))
    throw Error(ErrorCode::contract, "write_mesh",
                fmt::format("{} elements and {} sources have {} and {} labels and {} edge orders",
                            n, sources, result.region.size(), result.regions.size(), orders));
}

}  // namespace

void write_mesh(const MeshResult& result, const Provenance& provenance,
                const std::filesystem::path& path) {
  require_format(path, mesh_formats);
  require_consistent(result.elements, "write_mesh");
  require_labels(result);
  const std::string extension = extension_of(path);
  write_atomically(path, extension == ".ply" ? ply(result, provenance) : vtk(result, extension));
}

}  // namespace halfshade
