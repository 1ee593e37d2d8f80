#include "io/write/write_points.h"

#include "io/files/atomic_file.h"
#include "io/files/same_file.h"
#include "io/write/detail/vtk_file.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <iterator>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

std::string csv_bytes(const PointTable& table, std::span<const DirectLight> light) {
  std::string bytes;
  if (light.size() < table.points.size())
    bytes = fmt::format("# interrupted: {} of {} points\n", light.size(), table.points.size());
  bytes += table.header;
  const char s = table.separator;
  fmt::format_to(std::back_inserter(bytes), "{}H_r{}H_g{}H_b{}visible\n", s, s, s, s);
  for (std::size_t k = 0; k < light.size(); ++k) {
    const Rgb& h = light[k].irradiance;
    fmt::format_to(std::back_inserter(bytes), "{}{}{}{}{}{}{}{}{}\n", table.rows[k], s, h[0], s,
                   h[1], s, h[2], s, light[k].visible);
  }
  return bytes;
}

std::string vtp_bytes(const PointTable& table, std::span<const DirectLight> light) {
  std::vector<Vec3> points;
  std::vector<double> irradiance, visible, normal;
  std::vector<int> region;
  vtkNew<vtkCellArray> vertices;
  for (std::size_t k = 0; k < light.size(); ++k) {
    points.push_back(table.points[k].position);
    const auto id = static_cast<vtkIdType>(k);
    vertices->InsertNextCell(1, &id);
    const Vec3& n = table.points[k].normal;
    normal.insert(normal.end(), n.begin(), n.end());
    const Rgb& h = light[k].irradiance;
    irradiance.insert(irradiance.end(), h.begin(), h.end());
    visible.push_back(light[k].visible);
    region.push_back(static_cast<int>(light[k].region));
  }
  vtkNew<vtkPolyData> grid;
  detail::set_points(grid, points);
  grid->SetVerts(vertices);
  vtkFieldData* data = grid->GetPointData();
  detail::add_colours(data, "irradiance", irradiance);
  detail::add_numbers(data, "visible", visible);
  detail::add_integers(data, "region", region);
  detail::add_numbers(data, "normal", normal, 3);
  detail::add_interrupted(grid->GetFieldData(), light.size() < table.points.size());
  return detail::vtk_bytes(grid, "write_points");
}

}  // namespace

void write_points(const PointTable& table, std::span<const DirectLight> light,
                  const fs::path& path) {
  if (light.size() > table.points.size())
    throw Error(
        ErrorCode::contract, "write_points",
        fmt::format("there are {} points but {} results", table.points.size(), light.size()));
  if (is_standard_stream(path)) return write_atomically(path, csv_bytes(table, light));
  require_format(path, point_formats);
  write_atomically(
      path, extension_of(path) == ".csv" ? csv_bytes(table, light) : vtp_bytes(table, light));
}

}  // namespace halfshade
