#include "io/files/camera_numbers.h"
#include "io/files/extension.h"
#include "io/files/seal.h"
#include "io/files/vtk_messages.h"
#include "io/picture/picture.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointSet.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace halfshade {
namespace {

using std::filesystem::path;

[[noreturn]] void reject(const path& file, const std::string& sentence) {
  throw Error(ErrorCode::invalid_input, file.string(), sentence);
}

std::vector<Rgb> channels(vtkFieldData* data, const char* name, vtkIdType count, const path& file) {
  vtkDataArray* array = data->GetArray(name);
  if (array == nullptr)
    reject(file, fmt::format("there is no array '{}'; only files written by halfshade can be drawn",
                             name));
  if (array->GetNumberOfComponents() != 3 || array->GetNumberOfTuples() != count)
    reject(file, fmt::format("the array '{}' has {} rows of {} components instead of {} of 3", name,
                             array->GetNumberOfTuples(), array->GetNumberOfComponents(), count));
  std::vector<Rgb> values;
  for (vtkIdType i = 0; i < count; ++i) {
    Rgb value;
    array->GetTuple(i, value.data());
    if (!value.allFinite())
      reject(file, fmt::format("row {} of the array '{}' is not finite", i, name));
    values.push_back(value);
  }
  return values;
}

std::array<int, 3> triangle(vtkPointSet* grid, vtkIdType cell, const path& file) {
  vtkNew<vtkIdList> corners;
  if (grid->GetCellType(cell) != VTK_TRIANGLE)
    reject(file, fmt::format("cell {} is not a triangle", cell));
  grid->GetCellPoints(cell, corners);
  std::array<int, 3> result{};
  for (int k = 0; k < 3; ++k) {
    const vtkIdType p = k < corners->GetNumberOfIds() ? corners->GetId(k) : -1;
    if (p < 0 || p >= grid->GetNumberOfPoints())
      reject(file, fmt::format("cell {} names point {}, but there are {}", cell, p,
                               grid->GetNumberOfPoints()));
    result[static_cast<std::size_t>(k)] = static_cast<int>(p);
  }
  return result;
}

std::vector<double> field_numbers(vtkFieldData* data, const char* name, int components) {
  vtkDataArray* array = data->GetArray(name);
  if (array == nullptr || array->GetNumberOfComponents() != components) return {};
  std::vector<double> values;
  for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    for (int c = 0; c < components; ++c) values.push_back(array->GetComponent(i, c));
  return values;
}

std::vector<Camera> cameras(vtkFieldData* data, const path& file) {
  detail::CameraNumbers numbers;
  numbers.values = field_numbers(data, "cameras", detail::camera_components);
  for (const double value : numbers.values)
    if (!std::isfinite(value)) reject(file, "the cameras in the file are not finite");
  for (const double code : field_numbers(data, "camera_names", 1))
    numbers.names.push_back(static_cast<int>(std::clamp(code, 0., 255.)));
  return to_cameras(numbers);
}

ShadedMesh to_mesh(vtkPointSet* grid, const path& file) {
  ShadedMesh mesh;
  const vtkIdType points = grid->GetNumberOfPoints(), cells = grid->GetNumberOfCells();
  if (points == 0 || cells == 0) reject(file, "there are no triangles in the file");
  for (vtkIdType i = 0; i < points; ++i) {
    Vec3 p;
    grid->GetPoint(i, p.data());
    if (!p.allFinite()) reject(file, fmt::format("the coordinates of point {} are not finite", i));
    mesh.points.push_back(p);
  }
  for (vtkIdType i = 0; i < cells; ++i) mesh.triangles.push_back(triangle(grid, i, file));
  mesh.point_radiosity = channels(grid->GetPointData(), "radiosity", points, file);
  mesh.triangle_radiosity = channels(grid->GetCellData(), "radiosity", cells, file);
  for (const Rgb& exitance : channels(grid->GetCellData(), "exitance", cells, file))
    mesh.emits.push_back((exitance > 0).any());
  mesh.cameras = cameras(grid->GetFieldData(), file);
  return mesh;
}

/// Reader, parser and pipeline print what they meet unless someone listens.
template <class Reader>
ShadedMesh read(const std::string& bytes, const path& file) {
  detail::VtkMessages messages;
  vtkNew<vtkCallbackCommand> listener;
  listener->SetClientData(&messages);
  listener->SetCallback([](vtkObject* sender, unsigned long event, void* client, void* text) {
    static_cast<detail::VtkMessages*>(client)->record(sender, event, text);
  });
  vtkNew<Reader> reader;
  for (const unsigned long event : {vtkCommand::ErrorEvent, vtkCommand::WarningEvent}) {
    reader->AddObserver(event, listener);
    reader->GetExecutive()->AddObserver(event, listener);
  }
  reader->SetReaderErrorObserver(listener);
  reader->SetParserErrorObserver(listener);
  reader->ReadFromInputStringOn();
  reader->SetInputString(bytes);
  try {
    reader->Update();
  } catch (const std::exception&) {  // sizes that are not there, for example
    reject(file, "the data in the file cannot be decoded");
  }
  if (!messages.first.empty()) reject(file, "the data in the file cannot be decoded");
  return to_mesh(reader->GetOutput(), file);
}

}  // namespace

ShadedMesh read_shaded(const path& file) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) reject(file, "this is a folder, not a file");
  const bool is_grid = extension_of(file) == ".vtu";
  if (!has_format(file, shaded_formats))
    reject(file, "only results written as .vtu or .vtp can be read");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) reject(file, "the file cannot be opened");
  std::ostringstream contents;
  contents << stream.rdbuf();
  const std::string bytes = std::move(contents).str();
  if (!detail::is_sealed(bytes))
    reject(file,
           "this is no result of halfshade, or it is damaged or was changed by another program");
  return is_grid ? read<vtkXMLUnstructuredGridReader>(bytes, file)
                 : read<vtkXMLPolyDataReader>(bytes, file);
}

}  // namespace halfshade
