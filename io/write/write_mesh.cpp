#include "io/write/write_mesh.h"

#include "io/files/atomic_file.h"
#include "io/files/consistency.h"
#include "io/files/extension.h"
#include "io/files/little_endian.h"
#include "io/write/result_formats.h"
#include "io/write/vtk_file.h"
#include "meshing/core/error.h"
#include "meshing/patches/quality.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace halfshade {
namespace {

using namespace detail;

std::vector<int> flat(const std::vector<std::array<int, 3>>& rows) {
  std::vector<int> values;
  values.reserve(3 * rows.size());
  for (const auto& row : rows) values.insert(values.end(), row.begin(), row.end());
  return values;
}

void add_cell_data(const MeshResult& result, vtkFieldData* data) {
  const ElementTable& elements = result.elements;
  ChannelArray rho(elements.count(), 3), exitance(elements.count(), 3);
  for (int e = 0; e < elements.count(); ++e) {
    const Material& material = result.scene.materials.at(
        static_cast<std::size_t>(elements.material[static_cast<std::size_t>(e)]));
    rho.row(e) = material.rho.transpose();
    exitance.row(e) = material.exitance.transpose();
  }
  add_channels(data, "exitance", exitance);
  add_channels(data, "reflectance", rho);
  add_integers(data, "region", region_codes(result.region));
  if (!result.found.sources.empty())
    add_integers(data, "regions", region_codes(result.regions),
                 static_cast<int>(result.found.sources.size()));
  add_element_data(elements, data);
  if (!elements.edge_order.empty()) add_integers(data, "edge_order", flat(elements.edge_order), 3);
}

void add_field_data(const MeshResult& result, const Provenance& provenance, vtkFieldData* data) {
  add_run(data, {result.scene, result.cameras, result.unit, result.stages, result.interrupted},
          provenance);
  std::vector<int> surfaces;
  std::vector<double> exitances;
  for (const LightSource& source : result.found.sources) {
    surfaces.push_back(source.surface);
    exitances.push_back(source.exitance);
  }
  add_integers(data, "sources", surfaces);
  add_numbers(data, "source_exitance", exitances);
  add_numbers(data, "irradiance_tolerance", {result.irradiance_tolerance});
}

template <class Grid>
std::string vtk_file(Grid* grid, const MeshResult& result, const Provenance& provenance) {
  set_points(grid, result.elements.points);
  add_cell_data(result, grid->GetCellData());
  add_field_data(result, provenance, grid->GetFieldData());
  return vtk_bytes(grid, "write_mesh");
}

std::string vtu(const MeshResult& result, const Provenance& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetCells(VTK_TRIANGLE, triangles_of(result.elements));
  return vtk_file(grid.Get(), result, provenance);
}

std::string vtp(const MeshResult& result, const Provenance& provenance) {
  vtkNew<vtkPolyData> grid;
  grid->SetPolys(triangles_of(result.elements));
  return vtk_file(grid.Get(), result, provenance);
}

std::string ply(const MeshResult& result, const Provenance& provenance) {
  const ElementTable& elements = result.elements;
  std::string bytes = fmt::format(
      "ply\n"
      "format binary_little_endian 1.0\n"
      "comment halfshade {}\n"
      "comment command line: {}\n"
      "comment unit: {}\n"
      "{}"
      "element vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n"
      "element face {}\n"
      "property list uchar int vertex_indices\n"
      "property int surface\nproperty uchar region\n"
      "end_header\n",
      one_line(provenance.version), one_line(provenance.command_line), one_line(result.unit),
      result.interrupted ? "comment interrupted: the mesh is not complete\n" : "",
      elements.points.size(), elements.count());
  for (const Vec3& p : elements.points)
    for (const double x : p) put(bytes, x);
  for (std::size_t e = 0; e < elements.corners.size(); ++e) {
    put(bytes, std::uint8_t{3});
    for (const int p : elements.corners[e]) put(bytes, static_cast<std::int32_t>(p));
    put(bytes, static_cast<std::int32_t>(elements.surface[e]));
    put(bytes, static_cast<std::uint8_t>(result.region[e]));
  }
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
  const std::string extension = extension_of(path);
  const auto format = extension == ".vtu"   ? vtu
                      : extension == ".vtp" ? vtp
                      : extension == ".ply" ? ply
                                            : nullptr;
  if (format == nullptr)
    throw Error(ErrorCode::usage, path.string(),
                fmt::format("meshes are written as .vtu, .vtp or .ply, not as '{}'",
                            path.extension().string()));
  require_consistent(result.elements, "write_mesh");
  require_labels(result);
  write_atomically(path, format(result, provenance));
}

}  // namespace halfshade
