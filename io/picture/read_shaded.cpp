#include "io/files/camera_numbers.h"
#include "io/files/extension.h"
#include "io/files/seal.h"
#include "io/files/vtk_messages.h"
#include "io/picture/picture.h"
#include "meshing/core/error.h"
#include "solver/elements/linear_pieces.h"

#include <Eigen/LU>
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

/// The order of a cell that write_result has written.
int order_of(vtkPointSet* grid, vtkIdType cell, vtkIdType nodes, const path& file) {
  const int type = grid->GetCellType(cell);
  for (int order = 1; order <= max_order; ++order)
    if (nodes == basis_size(order) && type == (order == 1   ? VTK_TRIANGLE
                                               : order == 2 ? VTK_QUADRATIC_TRIANGLE
                                                            : VTK_LAGRANGE_TRIANGLE))
      return order;
  reject(file, fmt::format("cell {} is not a triangle", cell));
}

/// The points that a cell names.
std::vector<int> nodes_of(vtkPointSet* grid, vtkIdType cell, const path& file) {
  vtkNew<vtkIdList> ids;
  grid->GetCellPoints(cell, ids);
  std::vector<int> nodes;
  for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k) {
    const vtkIdType p = ids->GetId(k);
    if (p < 0 || p >= grid->GetNumberOfPoints())
      reject(file, fmt::format("cell {} names point {}, but there are {}", cell, p,
                               grid->GetNumberOfPoints()));
    nodes.push_back(static_cast<int>(p));
  }
  return nodes;
}

/// Cells of higher order become as many triangles as it takes to look like them.
void cut_curved(const std::vector<std::vector<int>>& cells, const std::vector<int>& order,
                ShadedMesh& mesh) {
  ElementField field = zero_field(order);
  std::vector<std::array<Vec3, 3>> triangles;
  double largest = 0;
  for (std::size_t e = 0; e < cells.size(); ++e) {
    const int element = static_cast<int>(e);
    Eigen::MatrixXd values(cells[e].size(), 3);
    for (std::size_t k = 0; k < cells[e].size(); ++k)
      values.row(static_cast<Eigen::Index>(k)) = mesh.point_radiosity[at(cells[e][k])].matrix();
    field.of(element) = element_node_basis(order[e]).partialPivLu().solve(values).array();
    if (mesh.emits[e] == 0) largest = std::max(largest, values.cwiseAbs().maxCoeff());
    triangles.push_back(
        {mesh.points[at(cells[e][0])], mesh.points[at(cells[e][1])], mesh.points[at(cells[e][2])]});
  }
  LinearPieces pieces = linear_pieces(triangles, field, invisible_share * largest);
  const std::vector<Rgb> radiosity = std::move(mesh.triangle_radiosity);
  const std::vector<std::uint8_t> emits = std::move(mesh.emits);
  mesh.triangle_radiosity.clear();
  mesh.emits.clear();
  for (const int e : pieces.element) {
    mesh.triangle_radiosity.push_back(radiosity[at(e)]);
    mesh.emits.push_back(emits[at(e)]);
  }
  mesh.points = std::move(pieces.points);
  mesh.point_radiosity = std::move(pieces.value);
  mesh.triangles = std::move(pieces.corners);
  mesh.is_border = std::move(pieces.is_border);
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
  std::vector<std::vector<int>> nodes;
  std::vector<int> order;
  for (vtkIdType i = 0; i < cells; ++i) {
    nodes.push_back(nodes_of(grid, i, file));
    order.push_back(order_of(grid, i, static_cast<vtkIdType>(nodes.back().size()), file));
    mesh.triangles.push_back({nodes.back()[0], nodes.back()[1], nodes.back()[2]});
  }
  mesh.point_radiosity = channels(grid->GetPointData(), "radiosity", points, file);
  mesh.triangle_radiosity = channels(grid->GetCellData(), "radiosity", cells, file);
  for (const Rgb& exitance : channels(grid->GetCellData(), "exitance", cells, file))
    mesh.emits.push_back((exitance > 0).any());
  if (std::any_of(order.begin(), order.end(), [](int p) { return p > 1; }))
    cut_curved(nodes, order, mesh);
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
