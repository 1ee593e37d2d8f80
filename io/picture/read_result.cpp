#include "io/files/camera_numbers.h"
#include "io/files/extension.h"
#include "io/files/paint_numbers.h"
#include "io/picture/detail/vtk_input.h"
#include "io/picture/result_file.h"
#include "solver/elements/polynomial.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkPointData.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

using detail::nodes_of, detail::points_of, detail::reject;
using std::filesystem::path;

bool is_whole(vtkDataArray* array) {
  const int type = array->GetDataType();
  return type != VTK_FLOAT && type != VTK_DOUBLE;
}

/// All arrays of numbers that have as many rows as there are points or cells.
std::vector<ResultArray> arrays_of(vtkFieldData* data, vtkIdType count, const path& file) {
  std::vector<ResultArray> arrays;
  for (int k = 0; k < data->GetNumberOfArrays(); ++k) {
    vtkDataArray* array = data->GetArray(k);
    if (array == nullptr || array->GetName() == nullptr) continue;
    if (array->GetNumberOfTuples() != count)
      reject(file, fmt::format("the array '{}' has {} rows instead of {}", array->GetName(),
                               array->GetNumberOfTuples(), count));
    ResultArray result{array->GetName(), array->GetNumberOfComponents(), is_whole(array), {}};
    for (vtkIdType i = 0; i < count; ++i)
      for (int c = 0; c < result.components; ++c)
        result.values.push_back(array->GetComponent(i, c));
    arrays.push_back(std::move(result));
  }
  return arrays;
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

std::vector<detail::PaintOn> paints(vtkFieldData* data) {
  const auto whole = [&](const std::string& name, int components) {
    std::vector<int> result;
    for (const double x : field_numbers(data, name.c_str(), components))
      result.push_back(static_cast<int>(std::clamp(x, -1., 1e9)));
    return result;
  };
  detail::PaintNumbers numbers;
  numbers.paints = field_numbers(data, "paints", detail::paint_components);
  numbers.sizes = whole("texture_sizes", 2);
  for (std::size_t k = 0; 2 * k < numbers.sizes.size(); ++k)
    numbers.textures.push_back(whole(fmt::format("texture_{}", k), 3));
  return detail::to_paints(numbers);
}

ResultFile to_result(vtkPointSet* grid, const path& file) {
  ResultFile result;
  result.path = file;
  const vtkIdType points = grid->GetNumberOfPoints(), cells = grid->GetNumberOfCells();
  if (points == 0 || cells == 0) reject(file, "there are no triangles in the file");
  result.points = points_of(grid, file);
  for (vtkIdType i = 0; i < cells; ++i) {
    result.cells.push_back(nodes_of(grid, i, file));
    const auto nodes = static_cast<vtkIdType>(result.cells.back().size());
    result.order.push_back(order_of(grid, i, nodes, file));
  }
  result.point_arrays = arrays_of(grid->GetPointData(), points, file);
  result.cell_arrays = arrays_of(grid->GetCellData(), cells, file);
  result.cameras = cameras(grid->GetFieldData(), file);
  const auto number = [&](const char* name, double otherwise) {
    const std::vector<double> numbers = field_numbers(grid->GetFieldData(), name, 1);
    return numbers.empty() || !std::isfinite(numbers.front()) ? otherwise : numbers.front();
  };
  result.interrupted = number("interrupted", 0) != 0;
  result.bounces = static_cast<int>(std::clamp(number("bounces", -1), -1., 1e9));
  result.achieved_error = std::max(number("achieved_error", 0), 0.);
  result.lamp_tolerance = std::max(number("lamp_tolerance", 0), 0.);
  for (detail::PaintOn& paint : paints(grid->GetFieldData())) {
    result.paints.push_back(std::move(paint.paint));
    result.paint_most.push_back(paint.most);
  }
  return result;
}

}  // namespace

ResultFile read_result(const path& file) {
  if (!has_format(file, shaded_formats))
    reject(file, "only results written as .vtu or .vtp can be read");
  return to_result(detail::read_sealed(file), file);
}

}  // namespace halfshade
