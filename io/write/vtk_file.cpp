#include "io/write/detail/vtk_file.h"

#include "io/files/camera_numbers.h"
#include "io/files/seal.h"
#include "io/files/vtk_messages.h"
#include "meshing/core/error.h"
#include "meshing/patches/quality.h"
#include "solver/elements/polynomial.h"

#include <vtkAbstractArray.h>
#include <vtkCellArray.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>

namespace halfshade::detail {
namespace {

template <class Array, class Value>
void add_array(vtkFieldData* data, const char* name, const std::vector<Value>& values,
               int components) {
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()) / components);
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  data->AddArray(array);
}

/// Cuts out the ranges that VTK notes as information keys: for empty arrays and values near the
/// ends of the range of doubles its own reader fails on them. In place, for files may be large.
void remove_keys(std::string& xml) {
  constexpr std::string_view begin = "<InformationKey", end = "</InformationKey>";
  std::size_t kept = 0, place = 0;
  const auto keep_up_to = [&](std::size_t last) {
    std::copy(xml.data() + place, xml.data() + last, xml.data() + kept);
    kept += last - place;
  };
  for (std::size_t key = xml.find(begin); key != std::string::npos; key = xml.find(begin, place)) {
    keep_up_to(xml.find_last_not_of(' ', key - 1) + 1);
    place = xml.find(end, key) + end.size();
    if (place < xml.size() && xml[place] == '\n') ++place;
  }
  keep_up_to(xml.size());
  xml.resize(kept);
}

/// Apart from what is done to it, so that the writer's own copy is gone by then.
template <class Writer, class Grid>
std::string written(Grid* grid, const char* caller) {
  VtkMessages messages;
  vtkNew<Writer> writer;
  messages.listen_to(writer);
  // Appended data, the default, comes out empty in ParaView builds with expat 2.5 and later.
  writer->SetDataModeToBinary();
  writer->SetCompressorTypeToZLib();
  writer->SetIdTypeToInt32();
  writer->WriteToOutputStringOn();
  writer->SetInputData(grid);
  if (writer->Write() == 0 || !messages.first.empty())
    throw Error(ErrorCode::unwritable, caller, "the data could not be encoded");
  return writer->GetOutputString();
}

template <class Writer, class Grid>
std::string encode(Grid* grid, const char* caller) {
  std::string xml = written<Writer>(grid, caller);
  remove_keys(xml);
  return seal(std::move(xml));
}

}  // namespace

void add_numbers(vtkFieldData* data, const char* name, const std::vector<double>& values,
                 int components) {
  add_array<vtkDoubleArray>(data, name, values, components);
}

void add_integers(vtkFieldData* data, const char* name, const std::vector<int>& values,
                  int components) {
  add_array<vtkIntArray>(data, name, values, components);
}

void add_colours(vtkFieldData* data, const char* name, const std::vector<double>& values) {
  add_numbers(data, name, values, 3);
  vtkAbstractArray* array = data->GetAbstractArray(name);
  array->SetComponentName(0, "R");
  array->SetComponentName(1, "G");
  array->SetComponentName(2, "B");
}

void add_channels(vtkFieldData* data, const char* name, const ChannelArray& values) {
  const Eigen::Array<double, Eigen::Dynamic, 3, Eigen::RowMajor> rows = values;
  add_colours(data, name, {rows.data(), rows.data() + rows.size()});
}

std::vector<int> region_codes(const std::vector<Region>& regions) {
  std::vector<int> codes;
  codes.reserve(regions.size());
  for (const Region region : regions) codes.push_back(static_cast<int>(region));
  return codes;
}

void add_element_data(const ElementTable& elements, vtkFieldData* data) {
  add_integers(data, "face", elements.face);
  add_integers(data, "group", elements.group);
  add_integers(data, "material", elements.material);
  add_integers(data, "surface", elements.surface);
  add_integers(data, "level", elements.level);
  add_numbers(data, "quality", min_angles(elements));
}

void add_edge_orders(const ElementTable& elements, vtkFieldData* data) {
  std::vector<int> orders;
  for (const auto& of_element : elements.edge_order)
    orders.insert(orders.end(), of_element.begin(), of_element.end());
  if (!orders.empty()) add_integers(data, "edge_order", orders, 3);
}

vtkSmartPointer<vtkPointSet> element_grid(const ElementTable& elements,
                                          std::string_view extension) {
  vtkNew<vtkCellArray> triangles;
  for (const auto& corners : elements.corners) {
    triangles->InsertNextCell(3);
    for (const int p : corners) triangles->InsertCellPoint(p);
  }
  vtkSmartPointer<vtkPointSet> grid;
  if (extension == ".vtu") {
    vtkNew<vtkUnstructuredGrid> cells;
    cells->SetCells(VTK_TRIANGLE, triangles);
    grid = cells;
  } else {
    vtkNew<vtkPolyData> polygons;
    polygons->SetPolys(triangles);
    grid = polygons;
  }
  set_points(grid, elements.points);
  return grid;
}

vtkSmartPointer<vtkPointSet> polynomial_grid(std::span<const Vec3> nodes,
                                             std::span<const int> order) {
  vtkNew<vtkCellArray> cells;
  std::vector<int> types;
  vtkIdType next = 0;
  for (const int p : order) {
    cells->InsertNextCell(basis_size(p));
    for (int k = 0; k < basis_size(p); ++k) cells->InsertCellPoint(next++);
    types.push_back(p == 1   ? VTK_TRIANGLE
                    : p == 2 ? VTK_QUADRATIC_TRIANGLE
                             : VTK_LAGRANGE_TRIANGLE);
  }
  vtkNew<vtkUnstructuredGrid> grid;
  set_points(grid, nodes);
  grid->SetCells(types.data(), cells);
  return grid;
}

void add_interrupted(vtkFieldData* data, bool interrupted) {
  add_integers(data, "interrupted", {interrupted ? 1 : 0});
}

void add_cameras(vtkFieldData* data, const std::vector<Camera>& cameras) {
  if (cameras.empty()) return;
  const CameraNumbers numbers = to_numbers(cameras);
  add_numbers(data, "cameras", numbers.values, camera_components);
  add_integers(data, "camera_names", numbers.names);
}

void add_sources(vtkFieldData* data, const std::vector<LightSource>& sources) {
  std::vector<int> surfaces;
  std::vector<double> exitances;
  for (const LightSource& source : sources) {
    surfaces.push_back(source.surface);
    exitances.push_back(source.exitance);
  }
  add_integers(data, "sources", surfaces);
  add_numbers(data, "source_exitance", exitances);
}

void set_points(vtkPointSet* grid, std::span<const Vec3> points) {
  vtkNew<vtkPoints> array;
  array->SetDataTypeToDouble();
  for (const Vec3& p : points) array->InsertNextPoint(p.data());
  grid->SetPoints(array);
}

std::string vtk_bytes(vtkPointSet* grid, const char* caller) {
  if (auto* cells = vtkUnstructuredGrid::SafeDownCast(grid))
    return encode<vtkXMLUnstructuredGridWriter>(cells, caller);
  if (auto* poly = vtkPolyData::SafeDownCast(grid))
    return encode<vtkXMLPolyDataWriter>(poly, caller);
  throw Error(ErrorCode::contract, caller, "the grid is neither unstructured nor poly data");
}

}  // namespace halfshade::detail
