#include "io/write/result_formats.h"
#include "io/write/vtk_file.h"
#include "solver/elements/vertex_values.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace halfshade::detail {
namespace {

void add_cell_data(const SolveResult& result, vtkFieldData* data) {
  const ElementTable& elements = result.elements;
  const Solution& solution = result.solution;
  add_channels(data, "radiosity", solution.radiosity);
  add_channels(data, "irradiance", solution.irradiance);
  add_channels(data, "direct_irradiance", solution.direct_irradiance);
  add_channels(data, "exitance", solution.exitance);
  add_channels(data, "reflectance", solution.rho);
  const Eigen::ArrayXd& error = solution.error_estimate;
  add_numbers(data, "error_estimate", {error.data(), error.data() + error.size()});
  if (!solution.region.empty()) add_integers(data, "region", region_codes(solution.region));
  add_integers(data, "order", std::vector<int>(elements.corners.size(), 0));
  add_element_data(elements, data);
}

void add_field_data(const SolveResult& result, const Provenance& provenance, vtkFieldData* data) {
  add_run(data, {result.scene, result.cameras, result.unit, result.stages, result.interrupted},
          provenance);
  add_numbers(data, "achieved_error", {result.relative_error});
}

void fill(vtkPointSet* grid, const SolveResult& result, const Provenance& provenance) {
  set_points(grid, result.elements.points);
  add_cell_data(result, grid->GetCellData());
  const Solution& solution = result.solution;
  add_channels(grid->GetPointData(), "radiosity",
               values_at_points(result.elements, solution.radiosity));
  add_channels(grid->GetPointData(), "irradiance",
               values_at_points(result.elements, solution.irradiance));
  add_field_data(result, provenance, grid->GetFieldData());
}

}  // namespace

std::string vtu_bytes(const SolveResult& result, const Provenance& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetCells(VTK_TRIANGLE, triangles_of(result.elements));
  fill(grid, result, provenance);
  return vtk_bytes(grid, "write_result");
}

std::string vtp_bytes(const SolveResult& result, const Provenance& provenance) {
  vtkNew<vtkPolyData> grid;
  grid->SetPolys(triangles_of(result.elements));
  fill(grid, result, provenance);
  return vtk_bytes(grid, "write_result");
}

}  // namespace halfshade::detail
