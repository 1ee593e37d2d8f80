#include "io/files/consistency.h"
#include "io/picture/painted_points.h"
#include "io/picture/picture.h"
#include "meshing/triangulation/planar_mesh.h"
#include "solver/pipeline/linear_result.h"

namespace halfshade {
namespace {

// Radiosity of a lamp among reflectances of at most 1: far enough above white to look like one.
constexpr double lamp_brightness = 4;

Rgb scene_colour(const Material& material) {
  const double exitance = material.exitance.maxCoeff();
  return exitance > 0 ? Rgb(lamp_brightness * (material.exitance / exitance)) : material.rho;
}

std::vector<Rgb> rows(const ChannelArray& values) {
  std::vector<Rgb> result;
  for (Eigen::Index i = 0; i < values.rows(); ++i) result.emplace_back(values.row(i));
  return result;
}

/// Where something is painted and does not shine. Values hold mean reflectances.
void add_paints(const SoundScene& scene, const ElementTable& elements, const Solution& solution,
                ShadedMesh& mesh) {
  if (scene.paints.empty()) return;
  mesh.paints = scene.paints;
  for (int e = 0; e < elements.count(); ++e) {
    const Surface& surface = scene.surfaces[at(elements.surface[at(e)])];
    ShadedPaint painted;
    if (mesh.emits[at(e)] == 0) painted.paint = surface.paint;
    const Rgb mean = solution.rho.row(e).transpose();
    painted.gain = (mean > 0).select(scene.materials[at(surface.material)].rho / mean, 0.);
    mesh.painted.push_back(painted);
  }
}

}  // namespace

ShadedMesh shaded(const SolveResult& result) {
  detail::require_consistent(result, "shaded");
  ShadedMesh mesh;
  const LinearResult linear = joined_linear_result(result);
  mesh.points = linear.elements.points;
  mesh.triangles = linear.elements.corners;
  mesh.is_border = linear.is_border;
  mesh.cameras = result.cameras;
  mesh.point_value = rows(linear.radiosity);
  mesh.triangle_value = rows(linear.solution.radiosity);
  for (Eigen::Index e = 0; e < linear.elements.count(); ++e)
    mesh.emits.push_back((linear.solution.exitance.row(e) > 0).any());
  add_paints(result.scene, linear.elements, linear.solution, mesh);
  if (!mesh.painted.empty())
    detail::separate_painted(rows(linear.irradiance), rows(linear.solution.rho), mesh);
  return mesh;
}

ShadedMesh shaded(const SoundScene& scene, const std::vector<Camera>& cameras) {
  ShadedMesh mesh;
  mesh.cameras = cameras;
  mesh.headlight = true;
  mesh.paints = scene.paints;
  for (const Surface& surface : scene.surfaces) {
    const Material& material = scene.materials.at(static_cast<std::size_t>(surface.material));
    const Rgb colour = scene_colour(material);
    const PlanarMesh triangles = triangulate(surface.rings, {});
    const int first = static_cast<int>(mesh.points.size());
    for (const Vec2& q : triangles.points) {
      mesh.points.push_back(surface.frame.to_space(q));
      mesh.point_value.push_back(colour);
    }
    for (const auto& t : triangles.triangles) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      mesh.triangle_value.push_back(colour);
      mesh.emits.push_back((material.exitance > 0).any());
      if (!mesh.paints.empty())
        mesh.painted.push_back({mesh.emits.back() == 0 ? surface.paint : -1, Rgb::Ones()});
    }
  }
  return mesh;
}

}  // namespace halfshade
