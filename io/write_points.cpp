#include "io/write_points.h"

#include "io/atomic_file.h"
#include "io/detail/vtk_messages.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCommand.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataWriter.h>

#include <iterator>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

std::string csv_bytes(const PointTable& table, std::span<const DirectLight> light) {
  std::string bytes = table.header;
  const char s = table.separator;
  fmt::format_to(std::back_inserter(bytes), "{}H_r{}H_g{}H_b{}visible\n", s, s, s, s);
  for (std::size_t k = 0; k < light.size(); ++k) {
    const Rgb& h = light[k].irradiance;
    fmt::format_to(std::back_inserter(bytes), "{}{}{}{}{}{}{}{}{}\n", table.rows[k], s, h[0], s,
                   h[1], s, h[2], s, light[k].visible);
  }
  return bytes;
}

void add_string(vtkFieldData* data, const char* name, const std::string& value) {
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(value);
  data->AddArray(array);
}

template <class Array, class Value>
void add_array(vtkFieldData* data, const char* name, int components, std::size_t count,
               Value value) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t k = 0; k < count; ++k)
    for (int c = 0; c < components; ++c)
      array->SetTypedComponent(static_cast<vtkIdType>(k), c, value(k, c));
  data->AddArray(array);
}

std::string vtp_bytes(const PointTable& table, std::span<const DirectLight> light,
                      const Provenance& provenance) {
  vtkNew<vtkPolyData> grid;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkCellArray> vertices;
  for (std::size_t k = 0; k < light.size(); ++k) {
    const vtkIdType id = points->InsertNextPoint(table.points[k].position.data());
    vertices->InsertNextCell(1, &id);
  }
  grid->SetPoints(points);
  grid->SetVerts(vertices);
  vtkFieldData* data = grid->GetPointData();
  const std::size_t count = light.size();
  add_array<vtkDoubleArray>(data, "irradiance", 3, count,
                            [&](std::size_t k, int c) { return light[k].irradiance[c]; });
  add_array<vtkDoubleArray>(data, "visible", 1, count,
                            [&](std::size_t k, int) { return light[k].visible; });
  add_array<vtkIntArray>(data, "region", 1, count,
                         [&](std::size_t k, int) { return static_cast<int>(light[k].region); });
  add_array<vtkDoubleArray>(data, "normal", 3, count,
                            [&](std::size_t k, int c) { return table.points[k].normal[c]; });
  add_string(grid->GetFieldData(), "version", provenance.version);
  add_string(grid->GetFieldData(), "command_line", provenance.command_line);

  detail::VtkMessages messages;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->AddObserver(vtkCommand::ErrorEvent, &messages, &detail::VtkMessages::record);
  writer->AddObserver(vtkCommand::WarningEvent, &messages, &detail::VtkMessages::record);
  // Appended data, the default, comes out empty in ParaView builds with expat 2.5 and later.
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->SetIdTypeToInt32();
  writer->WriteToOutputStringOn();
  writer->SetInputData(grid);
  if (writer->Write() == 0 || !messages.first.empty())
    throw Error(ErrorCode::unwritable, "write_points",
                fmt::format("the points could not be encoded for VTK ({})", messages.first));
  return writer->GetOutputString();
}

}  // namespace

bool is_points_path(const fs::path& path) {
  return path.extension() == ".csv" || path.extension() == ".vtp";
}

void write_points(const PointTable& table, std::span<const DirectLight> light,
                  const Provenance& provenance, const fs::path& path) {
  if (light.size() > table.points.size())
    throw Error(
        ErrorCode::contract, "write_points",
        fmt::format("there are {} points but {} results", table.points.size(), light.size()));
  if (!is_points_path(path))
    throw Error(
        ErrorCode::usage, path.string(),
        fmt::format("the extension '{}' is none of .csv and .vtp", path.extension().string()));
  write_atomically(path, path.extension() == ".csv" ? csv_bytes(table, light)
                                                    : vtp_bytes(table, light, provenance));
}

}  // namespace halfshade
