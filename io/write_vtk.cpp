#include "io/detail/result_formats.h"
#include "io/detail/vtk_messages.h"
#include "meshing/core/error.h"
#include "meshing/quality.h"
#include "solver/vertex_values.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

namespace halfshade::detail {
namespace {

void add_channels(vtkFieldData* data, const char* name, const ChannelArray& values) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(values.rows());
  for (Eigen::Index i = 0; i < values.rows(); ++i)
    array->SetTuple3(i, values(i, 0), values(i, 1), values(i, 2));
  data->AddArray(array);
}

void add_integers(vtkFieldData* data, const char* name, const std::vector<int>& values) {
  vtkNew<vtkIntArray> array;
  array->SetName(name);
  for (const int value : values) array->InsertNextValue(value);
  data->AddArray(array);
}

void add_numbers(vtkFieldData* data, const char* name, const std::vector<double>& values) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name);
  for (const double value : values) array->InsertNextValue(value);
  data->AddArray(array);
}

void add_strings(vtkFieldData* data, const char* name, const std::vector<std::string>& values) {
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  for (const std::string& value : values) array->InsertNextValue(value);
  data->AddArray(array);
}

/// 0 lit, 1 penumbra, 2 umbra, 3 where no emitter lies above the horizon.
std::vector<int> region_codes(const std::vector<Region>& regions) {
  std::vector<int> codes;
  codes.reserve(regions.size());
  for (const Region region : regions) codes.push_back(static_cast<int>(region));
  return codes;
}

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
  add_integers(data, "face", elements.face);
  add_integers(data, "group", elements.group);
  add_integers(data, "material", elements.material);
  add_integers(data, "receiver", elements.receiver);
  add_integers(data, "level", elements.level);
  add_numbers(data, "quality", min_angles(elements));
}

void add_field_data(const SolveResult& result, const Provenance& provenance, vtkFieldData* data) {
  std::vector<std::string> stages, materials;
  std::vector<double> seconds;
  for (const StageReport& stage : result.stages) {
    stages.push_back(stage.name);
    seconds.push_back(stage.seconds);
  }
  for (const Material& material : result.scene.materials) materials.push_back(material.name);
  add_strings(data, "version", {provenance.version});
  add_strings(data, "command_line", {provenance.command_line});
  add_strings(data, "unit", {result.unit});
  add_strings(data, "cameras", {cameras_to_json(result.cameras)});
  add_strings(data, "group_names", result.scene.groups);
  add_strings(data, "material_names", materials);
  add_strings(data, "stage_names", stages);
  add_numbers(data, "stage_seconds", seconds);
  add_numbers(data, "achieved_error", {result.relative_error});
  add_integers(data, "interrupted", {result.interrupted ? 1 : 0});
}

vtkNew<vtkPoints> make_points(const ElementTable& elements) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (const Vec3& p : elements.points) points->InsertNextPoint(p.data());
  return points;
}

vtkNew<vtkCellArray> make_triangles(const ElementTable& elements) {
  vtkNew<vtkCellArray> triangles;
  for (const auto& corners : elements.corners) {
    triangles->InsertNextCell(3);
    for (const int p : corners) triangles->InsertCellPoint(p);
  }
  return triangles;
}

/// Cuts out the ranges that VTK notes as information keys: for empty arrays and values near the
/// ends of the range of doubles its own reader fails on them.
std::string without_keys(std::string xml) {
  std::string result;
  result.reserve(xml.size());
  constexpr std::string_view begin = "<InformationKey", end = "</InformationKey>";
  std::size_t place = 0;
  for (std::size_t key = xml.find(begin); key != std::string::npos; key = xml.find(begin, place)) {
    const std::size_t line = xml.find_last_not_of(' ', key - 1) + 1;
    result.append(xml, place, line - place);
    place = xml.find(end, key) + end.size();
    if (place < xml.size() && xml[place] == '\n') ++place;
  }
  return result.append(xml, place);
}

template <class Writer, class Grid>
std::string file_of(Grid* grid, const SolveResult& result, const Provenance& provenance) {
  grid->SetPoints(make_points(result.elements));
  add_cell_data(result, grid->GetCellData());
  const Solution& solution = result.solution;
  add_channels(grid->GetPointData(), "radiosity",
               values_at_points(result.elements, solution.radiosity));
  add_channels(grid->GetPointData(), "irradiance",
               values_at_points(result.elements, solution.irradiance));
  add_field_data(result, provenance, grid->GetFieldData());

  VtkMessages messages;
  vtkNew<Writer> writer;
  writer->AddObserver(vtkCommand::ErrorEvent, &messages, &VtkMessages::record);
  writer->AddObserver(vtkCommand::WarningEvent, &messages, &VtkMessages::record);
  // Appended data, the default, comes out empty in ParaView builds with expat 2.5 and later.
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->SetIdTypeToInt32();
  writer->WriteToOutputStringOn();
  writer->SetInputData(grid);
  if (writer->Write() == 0 || !messages.first.empty())
    throw Error(ErrorCode::unwritable, "write_result",
                fmt::format("the result could not be encoded for VTK ({})", messages.first));
  return seal(without_keys(writer->GetOutputString()));
}

}  // namespace

std::string vtu_bytes(const SolveResult& result, const Provenance& provenance) {
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetCells(VTK_TRIANGLE, make_triangles(result.elements));
  return file_of<vtkXMLUnstructuredGridWriter>(grid.Get(), result, provenance);
}

std::string vtp_bytes(const SolveResult& result, const Provenance& provenance) {
  vtkNew<vtkPolyData> grid;
  grid->SetPolys(make_triangles(result.elements));
  return file_of<vtkXMLPolyDataWriter>(grid.Get(), result, provenance);
}

}  // namespace halfshade::detail
