#include "io/files/paint_numbers.h"
#include "io/write/detail/vtk_file.h"
#include "io/write/result_bytes.h"
#include "solver/pipeline/heat_sums.h"
#include "solver/pipeline/linear_result.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>

#include <map>
#include <utility>

namespace halfshade::detail {
namespace {

/// The paints of elements that do not shine, each with the reflectance of its material.
struct UsedPaints {
  std::vector<int> of_element;  ///< −1: none; empty: nothing is painted
  std::vector<PaintOn> paints;
};

UsedPaints used_paints(const SoundScene& scene, const ElementTable& elements) {
  UsedPaints used;
  if (scene.paints.empty()) return used;
  std::map<std::pair<int, int>, int> ids;  // of paint and material
  for (const int s : elements.surface) {
    const Surface& surface = scene.surfaces[at(s)];
    const Material& material = scene.materials[at(surface.material)];
    if (surface.paint < 0 || (material.exitance > 0).any()) {
      used.of_element.push_back(-1);
      continue;
    }
    const auto [entry, is_new] =
        ids.try_emplace({surface.paint, surface.material}, static_cast<int>(used.paints.size()));
    if (is_new) used.paints.push_back({scene.paints[at(surface.paint)], material.rho});
    used.of_element.push_back(entry->second);
  }
  return used;
}

/// The pictures themselves, in field data.
void add_paints(const std::vector<PaintOn>& paints, vtkFieldData* data) {
  if (paints.empty()) return;
  const PaintNumbers numbers = to_numbers(paints);
  add_numbers(data, "paints", numbers.paints, paint_components);
  add_integers(data, "texture_sizes", numbers.sizes, 2);
  for (std::size_t k = 0; k < numbers.textures.size(); ++k)
    add_integers(data, fmt::format("texture_{}", k).c_str(), numbers.textures[k], 3);
}

/// Where each node is in its element's picture; for programs that lay pictures themselves.
void add_picture_places(const UsedPaints& used, const NodeValues& nodes, vtkFieldData* data) {
  if (used.of_element.empty()) return;
  std::vector<double> places;
  std::size_t node = 0;
  for (std::size_t e = 0; e < nodes.order.size(); ++e)
    for (int k = 0; k < basis_size(nodes.order[e]); ++k, ++node) {
      const int paint = used.of_element[e];
      const Vec2 place =
          paint < 0 ? Vec2(0, 0) : used.paints[at(paint)].paint.place(nodes.points[node]);
      places.insert(places.end(), {place.x(), place.y()});
    }
  add_numbers(data, "picture_place", places, 2);
}

struct CellData {
  const ElementTable& elements;
  const Solution& solution;
  const std::vector<Region>& regions;
  const SolveResult& result;  ///< that the elements are of, or parts of its elements
  std::vector<int> order;
};

/// One component a band, in the report's order.
void add_bands(vtkFieldData* data, const char* name, const Eigen::ArrayXXd& values) {
  const Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = values;
  add_numbers(data, name, {rows.data(), rows.data() + rows.size()},
              static_cast<int>(values.cols()));
}

/// What surfaces give net, and how hot they are.
void add_heat(const CellData& cells, vtkFieldData* data) {
  if (!cells.result.heat.is_given) return;
  const Solution& solution = cells.solution;
  add_channels(data, "net_flux", solution.radiosity - solution.irradiance);
  const Eigen::ArrayXd kelvin = temperatures(cells.result, cells.elements, solution.irradiance);
  if (!kelvin.isNaN().all())
    add_numbers(data, "temperature", {kelvin.data(), kelvin.data() + kelvin.size()});
  if (solution.band_radiosity.rows() == 0) return;
  add_bands(data, "radiosity_by_band", solution.band_radiosity);
  add_bands(data, "irradiance_by_band", solution.band_irradiance);
  add_bands(data, "net_flux_by_band", solution.band_radiosity - solution.band_irradiance);
}

void add_cell_data(const CellData& cells, std::size_t emitters, vtkFieldData* data) {
  const Solution& solution = cells.solution;
  add_channels(data, "radiosity", solution.radiosity);
  add_channels(data, "irradiance", solution.irradiance);
  add_channels(data, "direct_irradiance", solution.direct_irradiance);
  add_channels(data, "exitance", solution.exitance);
  add_channels(data, "reflectance", solution.rho);
  const Eigen::ArrayXd& error = solution.error_estimate;
  add_numbers(data, "error_estimate", {error.data(), error.data() + error.size()});
  if (!solution.region.empty()) add_integers(data, "region", region_codes(solution.region));
  if (!cells.regions.empty())
    add_integers(data, "regions", region_codes(cells.regions), static_cast<int>(emitters));
  add_heat(cells, data);
  add_integers(data, "order", cells.order);
  const std::vector<int> paint = used_paints(cells.result.scene, cells.elements).of_element;
  if (!paint.empty()) add_integers(data, "paint", paint);
  add_element_data(cells.elements, data);
}

void add_field_data(const SolveResult& result, double error, vtkFieldData* data) {
  add_interrupted(data, result.interrupted);
  if (result.most_bounces >= 0) add_integers(data, "bounces", {result.most_bounces});
  add_cameras(data, result.cameras);
  if (!result.regions.empty()) add_sources(data, result.emitters);
  add_numbers(data, "tolerance", {result.discontinuity_tolerance});
  add_numbers(data, "curve_deviation", {result.mesh.deviation});
  add_numbers(data, "achieved_error", {error});
  if (result.lamp_tolerance > 0) add_numbers(data, "lamp_tolerance", {result.lamp_tolerance});
  add_paints(used_paints(result.scene, result.elements).paints, data);
}

void add_stage(const RadiosityStage* stage, vtkFieldData* data) {
  if (!stage) return;
  const auto add = [&](const char* name, double StagePower::*power) {
    add_colours(data, name,
                {stage->power[0].*power, stage->power[1].*power, stage->power[2].*power});
  };
  add_numbers(data, "shots", {static_cast<double>(stage->shots)});
  add("shot_power", &StagePower::shot);
  add("unshot_power", &StagePower::unshot);
  add("absorbed_power", &StagePower::absorbed);
  add("escaped_power", &StagePower::escaped);
}

/// Irradiance by the number of reflections before it.
void add_bounces(vtkFieldData* data, const std::vector<ChannelArray>& bounces) {
  for (std::size_t k = 0; k < bounces.size(); ++k)
    add_channels(data, fmt::format("irradiance_bounce_{}", k).c_str(), bounces[k]);
}

std::string linear_bytes(const SolveResult& result, std::string_view extension,
                         const RadiosityStage* stage = nullptr) {
  const LinearResult linear = linear_result(result);
  const auto grid = element_grid(linear.elements, extension);
  const bool is_constant = result.irradiance.count() == 0;
  add_cell_data({linear.elements, linear.solution, linear.regions, result,
                 std::vector<int>(linear.elements.corners.size(), is_constant ? 0 : 1)},
                result.emitters.size(), grid->GetCellData());
  add_channels(grid->GetPointData(), "radiosity", linear.radiosity);
  add_channels(grid->GetPointData(), "irradiance", linear.irradiance);
  add_bounces(grid->GetPointData(), linear.bounces);
  add_field_data(result, linear.relative_error, grid->GetFieldData());
  add_stage(stage, grid->GetFieldData());
  return vtk_bytes(grid, "write_result");
}

/// The polynomials themselves, by their values at the nodes of each element, which are gone when
/// the grid is encoded.
auto polynomial_result_grid(const SolveResult& result) {
  const NodeValues nodes = node_values(result);
  auto grid = polynomial_grid(nodes.points, nodes.order);
  add_cell_data({result.elements, result.solution, result.regions, result, result.irradiance.order},
                result.emitters.size(), grid->GetCellData());
  add_edge_orders(result.elements, grid->GetCellData());
  add_channels(grid->GetPointData(), "radiosity", nodes.radiosity);
  add_channels(grid->GetPointData(), "irradiance", nodes.irradiance);
  add_bounces(grid->GetPointData(), nodes.bounces);
  add_picture_places(used_paints(result.scene, result.elements), nodes, grid->GetPointData());
  add_field_data(result, result.relative_error, grid->GetFieldData());
  return grid;
}

std::string polynomial_bytes(const SolveResult& result) {
  return vtk_bytes(polynomial_result_grid(result), "write_result");
}

}  // namespace

std::string vtk_bytes(const SolveResult& result, std::string_view extension,
                      const ResultOptions& options) {
  const bool has_polynomials = result.irradiance.count() > 0 && !options.linear;
  return has_polynomials && extension == ".vtu" ? polynomial_bytes(result)
                                                : linear_bytes(result, extension);
}

std::string stage_bytes(const SolveResult& result, const RadiosityStage& stage) {
  return linear_bytes(result, ".vtu", &stage);
}

}  // namespace halfshade::detail
