#include "io/picture/curve_picture.h"
#include "io/picture/detail/vtk_input.h"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDataArray.h>

#include <algorithm>

namespace halfshade {
namespace {

vtkDataArray* codes(vtkPointSet* grid, const char* name, const std::filesystem::path& file) {
  vtkDataArray* array = grid->GetCellData()->GetArray(name);
  if (array == nullptr || array->GetNumberOfComponents() != 1 ||
      array->GetNumberOfTuples() != grid->GetNumberOfCells())
    detail::reject(
        file, fmt::format("there is no array '{}' of curves; mesh --curves writes them", name));
  return array;
}

}  // namespace

std::vector<OverlaidCurve> read_curves(const std::filesystem::path& file) {
  if (!has_format(file, overlay_formats))
    detail::reject(file, "only curves written as .vtp can be read");
  const vtkSmartPointer<vtkPointSet> grid = detail::read_sealed(file);
  vtkDataArray* kinds = codes(grid, "kind", file);
  vtkDataArray* orders = codes(grid, "order", file);
  const std::vector<Vec3> points = detail::points_of(grid, file);
  struct OrderedCurve {
    int order, kind;
    OverlaidCurve curve;
  };
  std::vector<OrderedCurve> curves;
  for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) {
    DiscontinuityCurve curve;
    curve.order = static_cast<int>(std::clamp(orders->GetComponent(i, 0), 0., 3.));
    curve.kind =
        static_cast<CurveKind>(std::clamp(kinds->GetComponent(i, 0), 0., curve_kinds - 1.));
    OverlaidCurve line;
    line.colour = curve_colour(curve, CurveColour::order);
    for (const int p : detail::nodes_of(grid, i, file)) line.points.push_back(points[at(p)]);
    curves.push_back({curve.order, static_cast<int>(curve.kind), std::move(line)});
  }
  std::stable_sort(curves.begin(), curves.end(), [](const OrderedCurve& a, const OrderedCurve& b) {
    return std::pair(a.order, a.kind) > std::pair(b.order, b.kind);
  });
  std::vector<OverlaidCurve> result;
  for (OrderedCurve& one : curves) result.push_back(std::move(one.curve));
  return result;
}

}  // namespace halfshade
