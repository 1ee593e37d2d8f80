#include "io/write/detail/vtk_file.h"
#include "io/write/result_bytes.h"
#include "solver/elements/vertex_values.h"

#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

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
  if (!result.regions.empty())
    add_integers(data, "regions", region_codes(result.regions),
                 static_cast<int>(result.emitters.size()));
  add_integers(data, "order", std::vector<int>(elements.corners.size(), 0));
  add_element_data(elements, data);
}

void add_field_data(const SolveResult& result, vtkFieldData* data) {
  add_interrupted(data, result.interrupted);
  add_cameras(data, result.cameras);
  if (!result.regions.empty()) add_sources(data, result.emitters);
  add_numbers(data, "tolerance", {result.discontinuity_tolerance});
  add_numbers(data, "achieved_error", {result.relative_error});
}

}  // namespace

std::string vtk_bytes(const SolveResult& result, std::string_view extension) {
  const auto grid = element_grid(result.elements, extension);
  add_cell_data(result, grid->GetCellData());
  const Solution& solution = result.solution;
  vtkFieldData* points = grid->GetPointData();
  add_channels(points, "radiosity", values_at_points(result.elements, solution.radiosity));
  add_channels(points, "irradiance", values_at_points(result.elements, solution.irradiance));
  add_field_data(result, grid->GetFieldData());
  return vtk_bytes(grid, "write_result");
}

}  // namespace halfshade::detail
