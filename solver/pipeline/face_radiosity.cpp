#include "solver/pipeline/face_radiosity.h"

#include "meshing/core/planar.h"
#include "solver/elements/material_arrays.h"
#include "solver/elements/painted_triangle.h"
#include "solver/elements/solution_parts.h"
#include "solver/factors/saved_factors.h"
#include "solver/pipeline/limits.h"
#include "solver/pipeline/require_limits.h"
#include "solver/pipeline/result_error.h"
#include "solver/pipeline/solve_mesh.h"

#include <algorithm>
#include <array>
#include <utility>

namespace halfshade {
namespace {

/// The surfaces that have rows, without what make_factor_scene puts round them.
struct FaceSurfaces {
  SoundScene sound;
  std::vector<int> row;  ///< of each surface
};

FaceSurfaces surfaces_with_rows(FactorScene faces, const Scene& scene) {
  FaceSurfaces result;
  std::vector<Surface> all = std::exchange(faces.sound.surfaces, {});
  result.sound = std::move(faces.sound);
  result.sound.materials.resize(scene.materials.size());
  result.sound.groups = scene.groups;
  result.sound.face_lines.resize(scene.faces.size());
  result.sound.diagonal = diagonal(scene);
  for (std::size_t s = 0; s < all.size(); ++s) {
    if (faces.row[s] < 0) continue;
    all[s].group = scene.faces[at(all[s].faces.front())].group;
    result.sound.surfaces.push_back(std::move(all[s]));
    result.row.push_back(faces.row[s]);
  }
  return result;
}

/// Rows that the matrix connects exchange light; those that lose none to space are closed.
Enclosures connected_rows(const ExchangeMatrix& matrix, const Eigen::ArrayXd& lost) {
  Enclosures result;
  result.of_element.assign(static_cast<std::size_t>(matrix.rows()), -1);
  std::vector<int> open;
  for (int first = 0; first < matrix.rows(); ++first) {
    if (result.of_element[at(first)] >= 0) continue;
    const int id = result.count();
    bool closed = true;
    open.assign(1, first);
    result.of_element[at(first)] = id;
    while (!open.empty()) {
      const int row = open.back();
      open.pop_back();
      closed = closed && lost[row] == 0;
      for (ExchangeMatrix::InnerIterator entry(matrix, row); entry; ++entry) {
        int& other = result.of_element[static_cast<std::size_t>(entry.col())];
        if (other < 0) open.push_back(static_cast<int>(entry.col()));
        if (other < 0) other = id;
      }
    }
    result.closed.push_back(closed);
    result.lit.push_back(true);
  }
  return result;
}

Exchange exchange_of(const FactorMatrix& factors) {
  Exchange exchange;
  exchange.matrix = mutual_areas(factors).sparseView();
  exchange.area = factors.area;
  exchange.lost = factors.area * factors.space.max(0);
  exchange.enclosures = connected_rows(exchange.matrix, exchange.lost);
  ExchangeReport& report = exchange.report;
  report.factors = static_cast<std::size_t>(exchange.matrix.nonZeros());
  report.closed = (exchange.lost == 0).all();
  report.closure_error_max = factors.report.row_sum_error_max;
  report.escaping_fraction = exchange.lost.sum() / exchange.area.sum();
  return exchange;
}

/// Mean of a face's picture, by triangles from its first corner, of which those outside cancel.
Rgb mean_of_picture(const Scene& scene, int face) {
  const std::vector<Vec3> corners = face_corners(scene, face);
  const Vec3 whole = area_vector(corners);
  Rgb sum = Rgb::Zero();
  for (std::size_t k = 2; k < corners.size(); ++k) {
    const std::array<Vec3, 3> triangle = {corners[0], corners[k - 1], corners[k]};
    const double share = area_vector(triangle).dot(whole) / whole.squaredNorm();
    sum += share * mean_colour(scene.paints[at(scene.faces[at(face)].paint)], triangle);
  }
  return sum.max(0).min(1);
}

MaterialArrays materials_of_rows(const FactorScene& faces, const Scene& scene) {
  MaterialArrays arrays{ChannelArray(faces.rows(), 3), ChannelArray(faces.rows(), 3)};
  for (int i = 0; i < faces.rows(); ++i) {
    const int face = faces.keys[at(i)].id;
    const Material& material = scene.materials[at(scene.faces[at(face)].material)];
    arrays.rho.row(i) = material.rho.transpose();
    if (scene.faces[at(face)].paint >= 0)
      arrays.rho.row(i) *= mean_of_picture(scene, face).transpose();
    arrays.exitance.row(i) = material.exitance.transpose();
  }
  return arrays;
}

}  // namespace

SolveResult solve_by_faces(const Scene& scene, const FactorMatrix& factors,
                           const SolveOptions& options, const Progress& progress) {
  SolveResult result;
  result.cameras = scene.cameras;
  result.unit = scene.unit;
  Stages stages(result.stages);
  FactorScene faces;
  stages.run("repair", [&] {
    faces = make_factor_scene(scene, FactorUnit::face);
    require_faces_of(faces, factors);
    return faces.names.size();
  });
  const MaterialArrays materials = materials_of_rows(faces, scene);
  std::vector<int> group_of_row;
  for (const FactorRow& key : faces.keys) group_of_row.push_back(scene.faces[at(key.id)].group);
  FaceSurfaces surfaces = surfaces_with_rows(std::move(faces), scene);
  result.scene = std::move(surfaces.sound);
  result.warnings = repair_warnings(scene, result.scene);
  stages.run("mesh", [&] {
    SolveOptions size = with_limits(options, result.scene.surfaces.size());
    if (!(size.max_length > 0)) size.max_length = result.scene.diagonal;
    result.elements = make_solve_mesh(result.scene, size, progress).elements;
    return result.elements.corners.size();
  });
  stages.run("radiosity", [&] {
    const Exchange exchange = exchange_of(factors);
    require_limits(scene.groups, group_of_row, exchange, materials, options.radiosity);
    Solution rows = solve_radiosity(exchange, materials.rho, materials.exitance, {},
                                    options.radiosity, result.radiosity, progress);
    rows.error_estimate = factors.error * rows.radiosity.abs().rowwise().maxCoeff().sum();
    std::vector<int> row_of_element;
    for (const int surface : result.elements.surface)
      row_of_element.push_back(surfaces.row[at(surface)]);
    result.solution = solution_of_parts(rows, row_of_element);
    result.exchange = exchange.report;
    return static_cast<std::size_t>(result.radiosity.unknowns);
  });
  result.relative_error = error_of_elements_and_solver(result);
  result.interrupted = progress.stopped();
  if (!result.interrupted)
    add(light_warnings({result.scene, result.elements, result.solution, result.exchange,
                        result.radiosity, options.radiosity.bounces}),
        result.warnings);
  return result;
}

}  // namespace halfshade
