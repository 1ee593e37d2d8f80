#include "io/picture/painted_points.h"
#include "io/picture/result_file.h"
#include "meshing/core/error.h"
#include "solver/elements/joined_field.h"
#include "solver/elements/linear_pieces.h"

#include <Eigen/LU>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

namespace halfshade {
namespace {

const ResultArray* find_array(const std::vector<ResultArray>& arrays, const std::string& name) {
  const auto found = std::find_if(arrays.begin(), arrays.end(),
                                  [&](const ResultArray& array) { return array.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

/// Component `c`, or the mean of all if that is negative, of row i.
double component(const ResultArray& array, std::size_t i, int c) {
  const auto n = at(array.components);
  if (c >= 0) return array.values[i * n + at(c)];
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) sum += array.values[i * n + k];
  return sum / static_cast<double>(n);
}

[[noreturn]] void refuse_row(const ResultFile& file, const ResultArray& array, std::size_t i) {
  throw Error(ErrorCode::invalid_input, file.path.string(),
              fmt::format("row {} of the array '{}' is not finite", i, array.name));
}

std::vector<Rgb> component_values(const ResultFile& file, const ResultArray& array, int c) {
  std::vector<Rgb> values;
  for (std::size_t i = 0; i < array.values.size() / at(array.components); ++i) {
    values.push_back(Rgb::Constant(component(array, i, c)));
    if (!values.back().allFinite()) refuse_row(file, array, i);
  }
  return values;
}

/// The rows of an array of light. Throws if there is no such array, or it is none.
std::vector<Rgb> light_values(const ResultFile& file, const std::vector<ResultArray>& arrays,
                              const std::string& name) {
  const ResultArray* array = find_array(arrays, name);
  if (array == nullptr || array->components != 3)
    throw Error(ErrorCode::invalid_input, file.path.string(),
                fmt::format("there is no array '{}' of 3 components; only what solve writes has "
                            "light that can be drawn",
                            name));
  std::vector<Rgb> values;
  for (std::size_t i = 0; i < array->values.size() / 3; ++i) {
    values.emplace_back(array->values[3 * i], array->values[3 * i + 1], array->values[3 * i + 2]);
    if (!values.back().allFinite()) refuse_row(file, *array, i);
  }
  return values;
}

std::vector<std::uint8_t> emitting(const std::vector<Rgb>& exitance) {
  std::vector<std::uint8_t> result;
  for (const Rgb& value : exitance) result.push_back((value > 0).any());
  return result;
}

/// Light continuous where nothing says that it jumps, if the file tells.
void join_cells(const ResultFile& file, std::span<const std::array<Vec3, 3>> triangles,
                ElementField& field) {
  const std::size_t count = triangles.size();
  const ResultArray* orders = find_array(file.cell_arrays, "edge_order");
  const ResultArray* surfaces = find_array(file.cell_arrays, "surface");
  const ResultArray* errors = find_array(file.cell_arrays, "error_estimate");
  if (orders == nullptr || orders->components != 3 || surfaces == nullptr ||
      surfaces->components != 1 || errors == nullptr || errors->components != 1)
    return;
  std::vector<std::array<int, 3>> edge_order(count);
  std::vector<int> surface(count);
  Eigen::ArrayXd error(static_cast<Eigen::Index>(count));
  for (std::size_t e = 0; e < count; ++e) {
    for (std::size_t k = 0; k < 3; ++k) edge_order[e][k] = orders->values[3 * e + k] == 0 ? 0 : -1;
    surface[e] = static_cast<int>(std::clamp(surfaces->values[e], -1., 1e9));
    const double known = errors->values[e];
    error[static_cast<Eigen::Index>(e)] = known >= 0 ? known : HUGE_VAL;
  }
  join(connected(triangles, surface, std::move(edge_order)), error, field);
}

Eigen::MatrixXd at_nodes(const std::vector<int>& nodes, const std::vector<Rgb>& point_value) {
  Eigen::MatrixXd values(nodes.size(), 3);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    values.row(static_cast<Eigen::Index>(k)) = point_value[at(nodes[k])].matrix();
  return values;
}

/// The polynomial with these values at a cell's nodes.
ChannelArray coefficients(int order, const Eigen::MatrixXd& values) {
  return element_node_basis(order).partialPivLu().solve(values).array();
}

/// Cells become as many triangles as it takes to look like them.
void cut_cells(const ResultFile& file, bool joined, ShadedMesh& mesh) {
  ElementField field = zero_field(file.order);
  std::vector<std::array<Vec3, 3>> triangles;
  double largest = 0;
  for (std::size_t e = 0; e < file.cells.size(); ++e) {
    const std::vector<int>& nodes = file.cells[e];
    Eigen::MatrixXd values = at_nodes(nodes, mesh.point_value);
    if (!mesh.painted.empty() && mesh.painted[e].paint >= 0) {
      // Without the mean of the picture, which steps from cell to cell.
      values *= mesh.painted[e].gain.matrix().asDiagonal();
      mesh.painted[e].gain.setOnes();
    }
    field.of(static_cast<int>(e)) = coefficients(file.order[e], values);
    if (mesh.emits[e] == 0) largest = std::max(largest, values.cwiseAbs().maxCoeff());
    triangles.push_back(
        {file.points[at(nodes[0])], file.points[at(nodes[1])], file.points[at(nodes[2])]});
  }
  if (joined) join_cells(file, triangles, field);
  LinearPieces pieces = linear_pieces(triangles, field, invisible_share * largest);
  const std::vector<Rgb> value = std::move(mesh.triangle_value);
  const std::vector<std::uint8_t> emits = std::move(mesh.emits);
  const std::vector<ShadedPaint> painted = std::move(mesh.painted);
  mesh.triangle_value.clear();
  mesh.emits.clear();
  mesh.painted.clear();
  for (const int e : pieces.element) {
    if (!painted.empty()) mesh.painted.push_back(painted[at(e)]);
    mesh.triangle_value.push_back(value[at(e)]);
    mesh.emits.push_back(emits[at(e)]);
  }
  mesh.points = std::move(pieces.points);
  mesh.point_value = std::move(pieces.value);
  mesh.triangles = std::move(pieces.corners);
  mesh.is_border = std::move(pieces.is_border);
}

/// Of each cell, for its radiosity.
std::vector<ShadedPaint> paints_of(const ResultFile& file, const std::vector<std::uint8_t>& emits) {
  const ResultArray* codes = find_array(file.cell_arrays, "paint");
  if (codes == nullptr || codes->components != 1 || file.paints.empty()) return {};
  const std::vector<Rgb> mean = light_values(file, file.cell_arrays, "reflectance");
  std::vector<ShadedPaint> painted;
  for (std::size_t e = 0; e < file.cells.size(); ++e) {
    ShadedPaint& cell = painted.emplace_back();
    const double code = codes->values[e];
    if (!(code >= 0 && code < static_cast<double>(file.paints.size())) || emits[e] != 0) continue;
    cell.paint = static_cast<int>(code);
    cell.gain = (mean[e] > 0).select(file.paint_most[at(cell.paint)] / mean[e], 0.);
  }
  return painted;
}

/// Light to look at, or numbers as they are. `at_points` and `painted` may be empty.
ShadedMesh mesh_with(const ResultFile& file, bool joined, std::vector<Rgb> at_points,
                     std::vector<Rgb> in_cells, std::vector<std::uint8_t> emits,
                     std::vector<ShadedPaint> painted = {}) {
  ShadedMesh mesh;
  mesh.points = file.points;
  for (const std::vector<int>& nodes : file.cells)
    mesh.triangles.push_back({nodes[0], nodes[1], nodes[2]});
  mesh.point_value = std::move(at_points);
  mesh.triangle_value = std::move(in_cells);
  mesh.emits = std::move(emits);
  mesh.painted = std::move(painted);
  mesh.paints = file.paints;
  mesh.cameras = file.cameras;
  if (mesh.point_value.empty()) return mesh;
  const bool is_curved =
      std::any_of(file.order.begin(), file.order.end(), [](int p) { return p > 1; });
  if (is_curved || (joined && find_array(file.cell_arrays, "edge_order") != nullptr))
    cut_cells(file, joined, mesh);  // they share no points
  else if (!mesh.painted.empty())
    detail::separate_painted(light_values(file, file.point_arrays, "irradiance"),
                             light_values(file, file.cell_arrays, "reflectance"), mesh);
  return mesh;
}

std::vector<std::string> array_names(const ResultFile& file) {
  std::vector<std::string> names;
  for (const auto* arrays : {&file.point_arrays, &file.cell_arrays})
    for (const ResultArray& array : *arrays)
      if (std::find(names.begin(), names.end(), array.name) == names.end())
        names.push_back(array.name);
  return names;
}

[[noreturn]] void refuse_channel(const ResultArray& array, const std::string& channel) {
  const std::string numbers =
      array.components == 1 ? "0 only" : fmt::format("0 to {}", array.components - 1);
  throw Error(ErrorCode::usage, "render",
              fmt::format("'{}' is no channel of '{}'; it has {}{}", channel, array.name, numbers,
                          array.components == 3 && !array.is_whole ? ", R, G, B and mean" : ""));
}

/// The component that a word names; −1: the mean.
int channel_of(const ResultArray& array, const std::string& channel) {
  if (channel == "mean" && array.components == 1) return 0;
  if (channel == "mean" && !array.is_whole) return -1;
  static const std::map<std::string, int> letters = {{"R", 0}, {"G", 1}, {"B", 2}};
  if (const auto found = letters.find(channel); found != letters.end() && array.components == 3)
    return found->second;
  int number = -1;
  const auto [end, error] =
      std::from_chars(channel.data(), channel.data() + channel.size(), number);
  if (error != std::errc() || end != channel.data() + channel.size() || number < 0 ||
      number >= array.components)
    refuse_channel(array, channel);
  return number;
}

std::string channel_name(const ResultArray& array, int channel) {
  if (array.components == 1) return "";
  if (array.is_whole || array.components != 3)
    return channel < 0 ? "mean" : fmt::format("component {}", channel);
  return channel < 0 ? "mean of R, G, B" : std::string(1, "RGB"[channel]);
}

std::string unit_of(const std::string& name) {
  static const std::map<std::string, std::string> units = {
      {"radiosity", "W/m²"}, {"irradiance", "W/m²"},     {"direct_irradiance", "W/m²"},
      {"exitance", "W/m²"},  {"error_estimate", "W/m²"}, {"quality", "degrees"},
      {"net_flux", "W/m²"},  {"temperature", "K"}};
  const auto found = units.find(name);
  return found == units.end() ? "" : found->second;
}

/// What cells have: their own array, or the mean of what their corners have.
std::vector<Rgb> cell_values(const ResultFile& file, const ResultArray* cells,
                             const std::vector<Rgb>& at_points, int channel) {
  if (cells != nullptr) return component_values(file, *cells, channel);
  std::vector<Rgb> means;
  for (const std::vector<int>& nodes : file.cells)
    means.push_back((at_points[at(nodes[0])] + at_points[at(nodes[1])] + at_points[at(nodes[2])]) /
                    3);
  return means;
}

}  // namespace

ShadedMesh shaded(const ResultFile& file) {
  std::vector<std::uint8_t> emits = emitting(light_values(file, file.cell_arrays, "exitance"));
  std::vector<ShadedPaint> painted = paints_of(file, emits);
  return mesh_with(file, true, light_values(file, file.point_arrays, "radiosity"),
                   light_values(file, file.cell_arrays, "radiosity"), std::move(emits),
                   std::move(painted));
}

ShadedMesh read_shaded(const std::filesystem::path& path) { return shaded(read_result(path)); }

SavedLight saved_light(const ResultFile& file) {
  const std::vector<Rgb> irradiance = light_values(file, file.point_arrays, "irradiance");
  const ResultArray* surfaces = find_array(file.cell_arrays, "surface");
  if (surfaces == nullptr || surfaces->components != 1)
    throw Error(ErrorCode::invalid_input, file.path.string(),
                "the file does not say which surfaces its elements are of");
  SavedLight light;
  light.source = file.path.string();
  light.rho = light_values(file, file.cell_arrays, "reflectance");
  light.exitance = light_values(file, file.cell_arrays, "exitance");
  light.elements.points = file.points;
  light.irradiance = zero_field(file.order);
  for (std::size_t e = 0; e < file.cells.size(); ++e) {
    const std::vector<int>& nodes = file.cells[e];
    light.elements.corners.push_back({nodes[0], nodes[1], nodes[2]});
    light.elements.surface.push_back(static_cast<int>(std::clamp(surfaces->values[e], -1., 1e9)));
    light.irradiance.of(static_cast<int>(e)) =
        coefficients(file.order[e], at_nodes(nodes, irradiance));
  }
  return light;
}

ValueMesh quantity_of(const ResultFile& file, const std::string& name, const std::string& channel) {
  const ResultArray* points = find_array(file.point_arrays, name);
  const ResultArray* cells = find_array(file.cell_arrays, name);
  const ResultArray* any = points != nullptr ? points : cells;
  if (any == nullptr)
    throw Error(ErrorCode::usage, file.path.string(),
                fmt::format("there is no quantity '{}'; the file has {}", name,
                            fmt::join(array_names(file), ", ")));
  const int c = channel_of(*any, channel);
  std::vector<Rgb> at_points;
  if (points != nullptr) at_points = component_values(file, *points, c);
  std::vector<Rgb> in_cells = cell_values(file, cells, at_points, c);
  std::vector<std::uint8_t> emits(file.cells.size(), 0);
  if (find_array(file.cell_arrays, "exitance") != nullptr)
    emits = emitting(light_values(file, file.cell_arrays, "exitance"));
  return {mesh_with(file, false, std::move(at_points), std::move(in_cells), std::move(emits)),
          {name, channel_name(*any, c), unit_of(name), any->is_whole}};
}

}  // namespace halfshade
