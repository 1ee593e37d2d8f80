#include "meshing/core/scene.h"

#include "meshing/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace halfshade {
namespace {

// Beyond this a product of three lengths, as in a volume, leaves the range where doubles stay
// normal.
constexpr double largest_coordinate = 1e60;
// Below this such a product does the same at the other end.
constexpr double smallest_extent = 1e-60;
// Closer together than this relative to their distance from the origin, points merge in double
// precision.
constexpr double smallest_relative_extent = 1e-9;

[[noreturn]] void reject(const Scene& scene, const std::string& sentence) {
  throw Error(ErrorCode::invalid_input, scene.source, sentence);
}

void check_material(const Scene& scene, const Material& material) {
  for (int c = 0; c < 3; ++c) {
    if (!(material.rho[c] >= 0 && material.rho[c] <= 1))
      reject(scene,
             fmt::format("material '{}' has reflectance {} in channel {}; it must lie in [0, 1]",
                         material.name, material.rho[c], c + 1));
    if (!(material.exitance[c] >= 0 && std::isfinite(material.exitance[c])))
      reject(scene,
             fmt::format("material '{}' has exitance {} in channel {}; it must be finite and not "
                         "negative",
                         material.name, material.exitance[c], c + 1));
  }
}

void check_face(const Scene& scene, int f) {
  const Face& face = scene.faces[static_cast<std::size_t>(f)];
  if (face.vertices.size() < 3)
    reject(scene, fmt::format("{} has {} vertices; a polygon needs at least 3",
                              face_label(scene, f), face.vertices.size()));
  for (const int v : face.vertices)
    if (v < 0 || v >= static_cast<int>(scene.vertices.size()))
      reject(scene, fmt::format("{} names vertex {}, but the file has {} vertices",
                                face_label(scene, f), v + 1, scene.vertices.size()));
  if (face.material < 0 || face.material >= static_cast<int>(scene.materials.size()))
    reject(scene, fmt::format("{} names material {}, but there are {}", face_label(scene, f),
                              face.material + 1, scene.materials.size()));
  if (face.group < 0 || face.group >= static_cast<int>(scene.groups.size()))
    reject(scene, fmt::format("{} names group {}, but there are {}", face_label(scene, f),
                              face.group + 1, scene.groups.size()));
  if (face.paint < -1 || face.paint >= static_cast<int>(scene.paints.size()))
    reject(scene, fmt::format("{} names paint {}, but there are {}", face_label(scene, f),
                              face.paint + 1, scene.paints.size()));
}

void check_paint(const Scene& scene, const Paint& paint) {
  if (!paint.texture || paint.texture->levels.empty()) reject(scene, "a paint has no picture");
  if (!paint.along.allFinite() || !paint.from.allFinite())
    reject(scene, fmt::format("the picture '{}' lies at coordinates that are not finite",
                              paint.texture->name));
}

void check_vertices(const Scene& scene) {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Face& face : scene.faces)
    for (const int v : face.vertices) {
      const Vec3& p = scene.vertices[static_cast<std::size_t>(v)];
      if (!p.allFinite())
        reject(scene, fmt::format("vertex {} has the coordinates ({}, {}, {}); they must be finite",
                                  v + 1, p.x(), p.y(), p.z()));
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
  const double farthest = std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff());
  if (farthest > largest_coordinate)
    reject(scene, fmt::format("a coordinate is as large as {}; at most {} can be computed with",
                              farthest, largest_coordinate));
  const double extent = (high - low).maxCoeff();
  if (extent <= smallest_extent)
    reject(scene, fmt::format("the scene extends over {}; at least {} can be computed with", extent,
                              smallest_extent));
  if (extent <= smallest_relative_extent * farthest)
    reject(scene,
           fmt::format(
               "the scene extends over {} at a distance of {} from the origin; double precision "
               "cannot tell its points apart",
               extent, farthest));
}

void check_camera(const Scene& scene, const Camera& camera) {
  const bool finite =
      camera.position.allFinite() && camera.direction.allFinite() && camera.up.allFinite();
  if (!finite || !(camera.vertical_fov > 0 && camera.vertical_fov < 180) ||
      !(camera.direction.normalized().cross(camera.up.normalized()).norm() > 1e-6))
    reject(scene,
           fmt::format("camera '{}' cannot be used: it needs finite vectors, an up vector that is "
                       "not parallel to its direction, and a field of view in (0, 180) degrees",
                       camera.name));
}

}  // namespace

std::string face_label(int face, int line) {
  return line > 0 ? fmt::format("face {} (line {})", face + 1, line)
                  : fmt::format("face {}", face + 1);
}

std::string face_label(const Scene& scene, int face) {
  return face_label(face, scene.faces.at(at(face)).line);
}

std::vector<Vec3> face_corners(const Scene& scene, int face) {
  const Face& f = scene.faces[static_cast<std::size_t>(face)];
  std::vector<Vec3> corners;
  corners.reserve(f.vertices.size());
  for (const int v : f.vertices) corners.push_back(scene.vertices[static_cast<std::size_t>(v)]);
  return corners;
}

double diagonal(const Scene& scene) {
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Face& face : scene.faces)
    for (const int v : face.vertices) {
      low = low.cwiseMin(scene.vertices[at(v)]);
      high = high.cwiseMax(scene.vertices[at(v)]);
    }
  return (high - low).stableNorm();
}

void validate(const Scene& scene) {
  if (scene.faces.empty()) reject(scene, "there are no faces");
  for (const Material& material : scene.materials) check_material(scene, material);
  for (int f = 0; f < static_cast<int>(scene.faces.size()); ++f) check_face(scene, f);
  check_vertices(scene);
  for (const Paint& paint : scene.paints) check_paint(scene, paint);
  for (const Camera& camera : scene.cameras) check_camera(scene, camera);
}

void require_emitter(const Scene& scene) {
  const bool any = std::any_of(scene.faces.begin(), scene.faces.end(), [&](const Face& face) {
    return (scene.materials.at(static_cast<std::size_t>(face.material)).exitance > 0).any();
  });
  if (!any)
    reject(scene,
           "no face emits light; give a material an exitance (Ke in an MTL file, or 'exitance' or "
           "'temperature' in a materials file)");
}

}  // namespace halfshade
