// Solves a white furnace through an installed halfshade: a closed cube whose faces emit E = 1 − rho
// has the radiosity B = 1 everywhere, because 1 = (1 − rho) + rho · 1.

#include "meshing/core/error.h"
#include "meshing/core/scene.h"
#include "solver/pipeline/solve.h"

#include <cstdio>
#include <string>

namespace {

halfshade::Scene furnace() {
  halfshade::Scene scene;
  scene.groups = {"cube"};
  for (int i = 0; i < 8; ++i) scene.vertices.emplace_back(i & 1, (i >> 1) & 1, (i >> 2) & 1);
  // Counter-clockwise seen from inside.
  const int faces[6][4] = {{2, 6, 4, 0}, {5, 7, 3, 1}, {4, 5, 1, 0},
                           {3, 7, 6, 2}, {1, 3, 2, 0}, {6, 7, 5, 4}};
  const double rho[6] = {0.05, 0.2, 0.35, 0.5, 0.8, 0.95};
  for (int f = 0; f < 6; ++f) {
    halfshade::Material material;
    material.name = "face " + std::to_string(f);
    material.rho = halfshade::Rgb::Constant(rho[f]);
    material.exitance = 1 - material.rho;
    scene.materials.push_back(material);
    halfshade::Face face;
    face.vertices.assign(faces[f], faces[f] + 4);
    face.material = f;
    scene.faces.push_back(face);
  }
  return scene;
}

// Every face must look at the centre, or the furnace is inside out.
bool looks_inwards(const halfshade::Scene& scene, int face) {
  const auto corners = halfshade::face_corners(scene, face);
  const halfshade::Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[1]);
  return normal.dot(halfshade::Vec3::Constant(0.5) - corners[0]) > 0;
}

}  // namespace

int main() try {
  const halfshade::Scene scene = furnace();
  halfshade::validate(scene);
  for (int f = 0; f < 6; ++f)
    if (!looks_inwards(scene, f)) {
      std::printf("face %d looks outwards\n", f);
      return 1;
    }

  halfshade::SolveOptions options;
  options.elements = 150;
  options.exchange.closure = halfshade::Closure::enforce;
  options.radiosity.tolerance = 1e-12;
  const halfshade::SolveResult result = halfshade::solve(scene, options);

  const auto& radiosity = result.solution.radiosity;
  if (result.elements.count() < 6 || radiosity.rows() != result.elements.count()) {
    std::printf("%d elements carry %d radiosities\n", result.elements.count(),
                static_cast<int>(radiosity.rows()));
    return 1;
  }
  const double error = (radiosity - 1).abs().maxCoeff();
  std::printf("%d elements, max |B - 1| = %.3g\n", result.elements.count(), error);
  return error <= 1e-9 ? 0 : 1;  // false for NaN, too
} catch (const halfshade::Error& error) {
  std::printf("%s\n", error.what());
  return 1;
}
