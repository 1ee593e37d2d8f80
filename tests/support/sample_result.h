#pragma once

#include "solver/pipeline/solve.h"

#include <cmath>

namespace halfshade::test {

/// The unit square in z = 0, seen from above, as n × n squares cut in two. No symmetry between the
/// channels, so that mixed-up ones show. The first element emits.
inline SolveResult sample_result(int n) {
  SolveResult result;
  result.unit = "cm";
  result.scene.groups = {"floor", "rug"};
  result.scene.materials = {{"grey", Rgb(0.5, 0.4, 0.3), Rgb::Zero(), false},
                            {"lamp", Rgb(0.1, 0.1, 0.1), Rgb(9, 8, 7), false}};
  result.scene.surfaces.resize(1);
  result.scene.surfaces[0].faces = {0, 1};
  result.scene.repairs = {{Repair::Kind::coplanar_merged, {0, 1}}};
  result.scene.face_lines = {0, 7};
  result.scene.diagonal = std::sqrt(2.0);
  Camera camera;
  camera.name = "above";
  camera.position = {0.5, 0.5, 3};
  result.cameras = {camera};
  result.stages = {{"mesh", 0.25, 2, ""}, {"exchange", 0, 0, "there is nothing to see"}};

  ElementTable& e = result.elements;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) e.points.emplace_back(i / double(n), j / double(n), 0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int p = j * (n + 1) + i;
      e.corners.push_back({p, p + 1, p + n + 2});
      e.corners.push_back({p, p + n + 2, p + n + 1});
    }
  const std::size_t count = e.corners.size();
  e.neighbours.assign(count, {-1, -1, -1});
  e.normal.assign(count, Vec3::UnitZ());
  e.area.assign(count, 0.5 / (n * n));
  e.surface.assign(count, 0);
  e.level.assign(count, 3);
  for (std::size_t i = 0; i < count; ++i) {
    e.face.push_back(static_cast<int>(i % 2));
    e.group.push_back(i < count / 2 ? 0 : 1);
    e.material.push_back(i == 0 ? 1 : 0);
  }

  Solution& s = result.solution;
  const auto rows = static_cast<Eigen::Index>(count);
  s.error_estimate.resize(result.elements.count());
  for (ChannelArray* array :
       {&s.rho, &s.exitance, &s.radiosity, &s.irradiance, &s.direct_irradiance})
    *array = ChannelArray::Zero(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const Material& material =
        result.scene.materials[static_cast<std::size_t>(e.material[static_cast<std::size_t>(i)])];
    const double x = static_cast<double>(i);
    s.rho.row(i) = material.rho;
    s.exitance.row(i) = material.exitance;
    s.error_estimate[i] = x / 13;
    s.region.push_back(static_cast<Region>(i % 4));
    s.direct_irradiance.row(i) = Rgb(1 + x / 3, 2 + x / 7, 3 + x / 11);
    s.irradiance.row(i) = s.direct_irradiance.row(i) + 0.1;
    s.radiosity.row(i) = s.exitance.row(i) + s.rho.row(i) * s.irradiance.row(i);
  }
  return result;
}

}  // namespace halfshade::test
