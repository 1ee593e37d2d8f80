#include "io/write/write_curves.h"

#include "io/files/atomic_file.h"
#include "io/write/detail/vtk_file.h"
#include "meshing/core/error.h"

#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

constexpr std::array<const char*, curve_kinds> kind_names = {"contact", "face", "ev", "eee",
                                                             "horizon"};

const Surface& surface_of(const SoundScene& scene, int id, const char* what) {
  if (id < 0 || id >= static_cast<int>(scene.surfaces.size()))
    throw Error(ErrorCode::contract, "write_curves",
                fmt::format("a curve names {} {}, but there are {} surfaces", what, id,
                            scene.surfaces.size()));
  return scene.surfaces[static_cast<std::size_t>(id)];
}

double finite(double value) {
  constexpr double largest = std::numeric_limits<float>::max();
  return std::isnan(value) ? 0 : std::clamp(value, -largest, largest);
}

/// Everything that stands in the file, one entry a point or a curve.
struct Columns {
  std::vector<Vec3> points;
  std::vector<double> point_jump;
  std::vector<int> kind, order, emitter, emitter_group, receiver, group;
  std::vector<double> jump, length;
  std::vector<int> source_count, feature_kinds, feature_ids;
};

void add_features(const DiscontinuityCurve& curve, Columns& out) {
  out.source_count.push_back(static_cast<int>(curve.sources.size()));
  const CurveSource source = curve.sources.empty() ? CurveSource{} : curve.sources.front();
  for (std::size_t k = 0; k < source.features.size(); ++k) {
    const bool is_there = static_cast<int>(k) < source.feature_count;
    out.feature_kinds.push_back(is_there ? static_cast<int>(source.features[k].kind) : -1);
    out.feature_ids.push_back(is_there ? source.features[k].id : -1);
  }
}

/// Adds a curve; returns how many points it has.
std::size_t add_curve(const SoundScene& scene, const DiscontinuityCurve& curve, double deviation,
                      Columns& out) {
  const Surface& receiver = surface_of(scene, curve.receiver, "receiver");
  const std::vector<double> parameters = flatten(curve.arc, deviation * size_of(receiver));
  for (const double s : parameters) {
    out.points.push_back(receiver.frame.to_space(point_at(curve.arc, s)));
    out.point_jump.push_back(jump_at(curve, s));
  }
  out.kind.push_back(static_cast<int>(curve.kind));
  out.order.push_back(curve.order);
  out.emitter.push_back(curve.emitter);
  out.emitter_group.push_back(surface_of(scene, curve.emitter, "emitter").group);
  out.receiver.push_back(curve.receiver);
  out.group.push_back(receiver.group);
  out.jump.push_back(finite(curve.jump[1]));
  out.length.push_back(length(curve.arc));
  add_features(curve, out);
  return parameters.size();
}

void add_cell_data(const Columns& columns, vtkFieldData* data) {
  detail::add_integers(data, "kind", columns.kind);
  detail::add_integers(data, "order", columns.order);
  detail::add_integers(data, "emitter", columns.emitter);
  detail::add_integers(data, "emitter_group", columns.emitter_group);
  detail::add_integers(data, "receiver", columns.receiver);
  detail::add_integers(data, "group", columns.group);
  detail::add_numbers(data, "jump", columns.jump);
  detail::add_numbers(data, "length", columns.length);
  detail::add_integers(data, "source_count", columns.source_count);
  detail::add_integers(data, "feature_kinds", columns.feature_kinds, 3);
  detail::add_integers(data, "feature_ids", columns.feature_ids, 3);
}

std::string vtp_bytes(const SoundScene& scene, const Discontinuities& found, double deviation) {
  Columns columns;
  vtkNew<vtkCellArray> lines;
  for (const DiscontinuityCurve& curve : found.curves) {
    auto point = static_cast<vtkIdType>(columns.points.size());
    const std::size_t count = add_curve(scene, curve, deviation, columns);
    lines->InsertNextCell(static_cast<int>(count));
    for (std::size_t k = 0; k < count; ++k) lines->InsertCellPoint(point++);
  }
  vtkNew<vtkPolyData> grid;
  detail::set_points(grid, columns.points);
  grid->SetLines(lines);
  add_cell_data(columns, grid->GetCellData());
  detail::add_numbers(grid->GetPointData(), "jump", columns.point_jump);
  detail::add_interrupted(grid->GetFieldData(), found.report.interrupted);
  return detail::vtk_bytes(grid, "write_curves");
}

}  // namespace

const char* name_of(CurveKind kind) { return kind_names.at(static_cast<std::size_t>(kind)); }

double jump_at(const DiscontinuityCurve& curve, double s) {
  // Lagrange polynomials on s = 1/6, 1/2, 5/6, in u = −1, 0, 1.
  const double u = 3 * (s - 0.5);
  const auto [a, b, c] = curve.jump;
  const double value = 0.5 * u * (u - 1) * a + (1 - u) * (1 + u) * b + 0.5 * u * (u + 1) * c;
  if (!std::isfinite(value)) return finite(s < 1. / 3 ? a : s > 2. / 3 ? c : b);
  const auto [low, high] = std::minmax({a, b, c});
  return finite(low >= 0 ? std::max(value, 0.) : high <= 0 ? std::min(value, 0.) : value);
}

void write_curves(const SoundScene& scene, const Discontinuities& found,
                  const std::filesystem::path& path, const CurveFileOptions& options) {
  require_format(path, curve_formats);
  if (!(options.deviation > 0))
    throw Error(ErrorCode::contract, "write_curves",
                fmt::format("the deviation ({}) must be positive", options.deviation));
  write_atomically(path, vtp_bytes(scene, found, options.deviation));
}

}  // namespace halfshade
