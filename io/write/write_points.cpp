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
#include <vtkSmartPointer.h>

#include <initializer_list>
#include <iterator>
#include <string_view>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

/// What comes before the rows of a table.
std::string table_head(const PointTable& table, std::size_t done,
                       std::initializer_list<std::string_view> columns) {
  std::string bytes;
  if (done < table.points.size())
    bytes = fmt::format("# interrupted: {} of {} points\n", done, table.points.size());
  bytes += table.header;
  for (const std::string_view column : columns) (bytes += table.separator) += column;
  return bytes += '\n';
}

void add_cells(std::string& row, char separator, const Rgb& values) {
  for (const double v : values) fmt::format_to(std::back_inserter(row), "{}{}", separator, v);
}

std::string csv_bytes(const PointTable& table, std::span<const DirectLight> light) {
  std::string bytes = table_head(table, light.size(), {"H_r", "H_g", "H_b", "visible"});
  for (std::size_t k = 0; k < light.size(); ++k) {
    bytes += table.rows[k];
    add_cells(bytes, table.separator, light[k].irradiance);
    fmt::format_to(std::back_inserter(bytes), "{}{}\n", table.separator, light[k].visible);
  }
  return bytes;
}

std::string csv_bytes(const PointTable& table, std::span<const PointLight> light) {
  std::string bytes = table_head(table, light.size(), {"H_r", "H_g", "H_b", "D_r", "D_g", "D_b"});
  for (std::size_t k = 0; k < light.size(); ++k) {
    bytes += table.rows[k];
    add_cells(bytes, table.separator, light[k].irradiance);
    add_cells(bytes, table.separator, light[k].direct_irradiance);
    bytes += '\n';
  }
  return bytes;
}

std::string csv_bytes(const PointTable& table, const ReferenceLight& light) {
  std::string bytes = table_head(table, light.values.size(),
                                 {"H_r", "H_g", "H_b", "H_r_error", "H_g_error", "H_b_error", "D_r",
                                  "D_g", "D_b", "D_r_error", "D_g_error", "D_b_error"});
  for (std::size_t k = 0; k < light.values.size(); ++k) {
    const ArrivingLight &value = light.values[k], &error = light.standard_errors[k];
    bytes += table.rows[k];
    for (const Rgb* cells : {&value.total, &error.total, &value.direct, &error.direct})
      add_cells(bytes, table.separator, *cells);
    bytes += '\n';
  }
  return bytes;
}

/// The first points of a table as vertices.
vtkSmartPointer<vtkPolyData> point_grid(const PointTable& table, std::size_t done) {
  std::vector<Vec3> points;
  vtkNew<vtkCellArray> vertices;
  for (std::size_t k = 0; k < done; ++k) {
    points.push_back(table.points[k].position);
    const auto id = static_cast<vtkIdType>(k);
    vertices->InsertNextCell(1, &id);
  }
  auto grid = vtkSmartPointer<vtkPolyData>::New();
  detail::set_points(grid, points);
  grid->SetVerts(vertices);
  detail::add_interrupted(grid->GetFieldData(), done < table.points.size());
  return grid;
}

std::string with_normals(vtkPolyData* grid, const PointTable& table) {
  std::vector<double> normal;
  for (vtkIdType k = 0; k < grid->GetNumberOfPoints(); ++k) {
    const Vec3& n = table.points[static_cast<std::size_t>(k)].normal;
    normal.insert(normal.end(), n.begin(), n.end());
  }
  detail::add_numbers(grid->GetPointData(), "normal", normal, 3);
  return detail::vtk_bytes(grid, "write_points");
}

std::string vtp_bytes(const PointTable& table, std::span<const DirectLight> light) {
  std::vector<double> irradiance, visible;
  std::vector<int> region;
  for (const DirectLight& at_point : light) {
    const Rgb& h = at_point.irradiance;
    irradiance.insert(irradiance.end(), h.begin(), h.end());
    visible.push_back(at_point.visible);
    region.push_back(static_cast<int>(at_point.region));
  }
  const auto grid = point_grid(table, light.size());
  vtkFieldData* data = grid->GetPointData();
  detail::add_colours(data, "irradiance", irradiance);
  detail::add_numbers(data, "visible", visible);
  detail::add_integers(data, "region", region);
  return with_normals(grid, table);
}

std::string vtp_bytes(const PointTable& table, const ReferenceLight& light) {
  const auto grid = point_grid(table, light.values.size());
  const auto add = [&](const char* name, const std::vector<ArrivingLight>& all, auto part) {
    std::vector<double> numbers;
    for (const ArrivingLight& one : all)
      numbers.insert(numbers.end(), (one.*part).begin(), (one.*part).end());
    detail::add_colours(grid->GetPointData(), name, numbers);
  };
  add("irradiance", light.values, &ArrivingLight::total);
  add("irradiance_error", light.standard_errors, &ArrivingLight::total);
  add("direct_irradiance", light.values, &ArrivingLight::direct);
  add("direct_irradiance_error", light.standard_errors, &ArrivingLight::direct);
  return with_normals(grid, table);
}

void require_room(const PointTable& table, std::size_t results) {
  if (results > table.points.size())
    throw Error(ErrorCode::contract, "write_points",
                fmt::format("there are {} points but {} results", table.points.size(), results));
}

template <class Light>
void write(const PointTable& table, const Light& light, const fs::path& path) {
  if (is_standard_stream(path)) return write_atomically(path, csv_bytes(table, light));
  require_format(path, point_formats);
  write_atomically(
      path, extension_of(path) == ".csv" ? csv_bytes(table, light) : vtp_bytes(table, light));
}

}  // namespace

void write_points(const PointTable& table, std::span<const DirectLight> light,
                  const fs::path& path) {
  require_room(table, light.size());
  write(table, light, path);
}

void write_points(const PointTable& table, std::span<const PointLight> light,
                  const fs::path& path) {
  require_room(table, light.size());
  if (!is_standard_stream(path)) require_format(path, value_formats);
  write_atomically(path, csv_bytes(table, light));
}

void write_points(const PointTable& table, const ReferenceLight& light, const fs::path& path) {
  require_room(table, light.values.size());
  write(table, light, path);
}

}  // namespace halfshade
