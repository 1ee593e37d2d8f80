#include "solver/pipeline/adiabatic_faces.h"

#include "meshing/core/error.h"
#include "solver/heat/adiabatic_balance.h"
#include "solver/pipeline/fixed_temperatures.h"

#include <fmt/format.h>

#include <cmath>

namespace halfshade {
namespace {

/// Each takes a solution of its own.
constexpr std::size_t most_faces = 2000;

/// Of what space sends: beside it, less is rounding.
constexpr double clearly_more = 1e-9;

/// Adds a copy of a material.
int add_copy(int material, AdiabaticFaces& faces) {
  const auto count = static_cast<int>(faces.scene.materials.size());
  faces.scene.materials.push_back(faces.scene.materials[at(material)]);
  faces.original.push_back(material);
  for (Eigen::ArrayXXd* values : {&faces.materials.rho, &faces.materials.exitance}) {
    values->conservativeResize(count + 1, Eigen::NoChange);
    values->row(count) = values->row(material).eval();
  }
  return count;
}

/// Mean irradiance of adiabatic faces (rows) in each band.
Eigen::ArrayXXd irradiance_of(const AdiabaticFaces& faces, const BandLight& light) {
  const ElementTable& elements = light.result.elements;
  std::vector<int> row(faces.scene.materials.size(), -1);
  for (std::size_t k = 0; k < faces.material.size(); ++k)
    if (faces.material[k] >= 0) row[at(faces.material[k])] = static_cast<int>(k);
  const auto count = static_cast<Eigen::Index>(faces.face.size());
  Eigen::ArrayXXd sum = Eigen::ArrayXXd::Zero(count, light.irradiance.cols());
  Eigen::ArrayXd area = Eigen::ArrayXd::Zero(count);
  for (int e = 0; e < elements.count(); ++e) {
    const int k = row[at(elements.material[at(e)])];
    if (k < 0) continue;
    sum.row(k) += elements.area[at(e)] * light.irradiance.row(e);
    area[k] += elements.area[at(e)];
  }
  return sum.colwise() / (area > 0).select(area, 1);
}

/// Irradiance of each for each W/m² that each sends out, band by band.
std::vector<Eigen::MatrixXd> find_responses(const AdiabaticFaces& faces, const SceneSolver& solve) {
  const Eigen::Index count = static_cast<Eigen::Index>(faces.face.size());
  const Eigen::Index bands = faces.materials.rho.cols();
  std::vector<Eigen::MatrixXd> responses(static_cast<std::size_t>(bands),
                                         Eigen::MatrixXd::Zero(count, count));
  for (Eigen::Index j = 0; j < count; ++j) {
    const int material = faces.material[static_cast<std::size_t>(j)];
    if (material < 0) continue;
    BandMaterials alone = faces.materials;
    alone.exitance.setZero();
    alone.exitance.row(material) = (alone.rho.row(material) < 1).cast<double>();
    const BandLight light = solve_bands(faces.scene, alone, Eigen::ArrayXd::Zero(bands), solve);
    const Eigen::ArrayXXd irradiance = irradiance_of(faces, light);
    for (Eigen::Index k = 0; k < bands; ++k)
      responses[static_cast<std::size_t>(k)].col(j) = irradiance.col(k).matrix();
  }
  return responses;
}

/// The first face whose temperature the bands do not tell: too little is sent out in them for
/// numbers to hold, or to be found beside what space sends. −1: there is none.
int first_untold(const AdiabaticBalance& balance, const Eigen::ArrayXd& kelvin, const Heat& heat) {
  const Eigen::ArrayXd unseen = unseen_bands(heat);
  for (Eigen::Index j = 0; j < kelvin.size(); ++j) {
    const Eigen::ArrayXd emissivity = balance.emissivity.row(j).transpose();
    if (!(emissivity > 0).any()) continue;
    if (!(kelvin[j] >= 0)) return static_cast<int>(j);
    const double sent = (emissivity * blackbody_exitance(kelvin[j], heat.bands)).sum();
    if ((sent == 0 && (emissivity * unseen > 0).any()) ||
        sent < clearly_more * (emissivity * balance.rest).sum())
      return static_cast<int>(j);
  }
  return -1;
}

}  // namespace

AdiabaticFaces adiabatic_faces(const Scene& scene, const Heat& heat) {
  AdiabaticFaces faces{scene, band_materials(scene, heat), {}, {}, {}};
  for (std::size_t m = 0; m < scene.materials.size(); ++m)
    faces.original.push_back(static_cast<int>(m));
  for (std::size_t f = 0; f < scene.faces.size(); ++f) {
    const int material = scene.faces[f].material;
    if (!is_balanced(heat, scene.materials, material)) continue;
    const bool is_mirror = (faces.materials.rho.row(material) == 1).all();
    faces.face.push_back(static_cast<int>(f));
    faces.material.push_back(is_mirror ? -1 : add_copy(material, faces));
    if (!is_mirror) faces.scene.faces[f].material = faces.material.back();
  }
  // No face has them any more; mirrors have no part in any light.
  for (int m = 0; m < static_cast<int>(heat.materials.size()); ++m)
    if (is_balanced(heat, scene.materials, m)) faces.materials.rho.row(m) = 1;
  if (faces.face.size() > most_faces)
    throw Error(ErrorCode::invalid_input, scene.source,
                fmt::format("{} faces have a net flux of 0 in {}, and each takes a solution of its "
                            "own to find its temperature; at most {} can be",
                            faces.face.size(),
                            bands_of(heat) > 1 ? fmt::format("{} bands", bands_of(heat))
                                               : "all on two sides",
                            most_faces));
  return faces;
}

std::vector<double> find_temperatures(AdiabaticFaces& faces, const Heat& heat,
                                      const Eigen::ArrayXd& space, const SceneSolver& solve) {
  const auto count = static_cast<Eigen::Index>(faces.face.size());
  AdiabaticBalance balance;
  balance.rest = space;
  balance.emissivity = Eigen::ArrayXXd::Zero(count, space.size());
  // In equilibrium with space they are not there: no part of the light is below nothing.
  for (Eigen::Index j = 0; j < count; ++j) {
    const int material = faces.material[static_cast<std::size_t>(j)];
    if (material < 0) continue;
    balance.emissivity.row(j) = 1 - faces.materials.rho.row(material);
    faces.materials.exitance.row(material) = balance.emissivity.row(j) * space.transpose();
  }
  const BandLight light = solve_bands(faces.scene, faces.materials, space, solve);
  if (!light.result.interrupted)
    require_fixed_temperatures(faces.scene, heat, faces.materials, faces.original,
                               light.result.scene);
  balance.arriving = irradiance_of(faces, light).rowwise() + space.transpose();
  balance.response = find_responses(faces, solve);
  const Eigen::ArrayXd kelvin = balanced_temperatures(balance, heat.bands);
  const int untold = first_untold(balance, kelvin, heat);
  if (untold >= 0) refuse_bands(faces.scene, faces.face[at(untold)]);

  std::vector<double> result(faces.scene.faces.size(), NAN);
  for (Eigen::Index j = 0; j < count; ++j) {
    const int material = faces.material[static_cast<std::size_t>(j)];
    result[at(faces.face[static_cast<std::size_t>(j)])] = kelvin[j];
    if (material >= 0)
      faces.materials.exitance.row(material) =
          balance.emissivity.row(j) * blackbody_exitance(kelvin[j], heat.bands).transpose();
  }
  return result;
}

}  // namespace halfshade
