#include "io/picture/picture.h"
#include "meshing/rays/visibility.h"

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>
#include <optional>

namespace halfshade {
namespace {

/// Directions looked into from a point inside.
constexpr int directions = 200;
/// A room is closed if this share of them meets a wall, and hidden if less than that share of where
/// they end shows from outside.
constexpr double closed_share = 0.98, hidden_share = 0.25;
/// Directions to look along, all round.
constexpr int azimuths = 16;
/// Where the camera stands on its line through the room, from the middle to the wall, how steeply
/// it looks down, and its field of view in degrees.
constexpr double near_wall = 0.9, downwards = 0.15, inside_fov = 75;
/// Of the scene's size: what is hit within it is the same place.
constexpr double same_place = 1e-4;

VisibilityIndex index_of(const ShadedMesh& mesh) {
  return VisibilityIndex({mesh.points, mesh.triangles, std::vector<int>(mesh.triangles.size(), 0),
                          std::vector<int>(mesh.triangles.size(), -1)});
}

/// Evenly over the sphere, on a spiral.
Vec3 direction(int k) {
  const double z = 1 - (2 * k + 1.) / directions, turn = std::numbers::pi * (3 - std::sqrt(5.)) * k;
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

std::optional<double> distance(const VisibilityIndex& index, const Vec3& from, const Vec3& along,
                               Sides sides) {
  const auto hit = index.first_hit(from, along, sides);
  return hit ? std::optional(hit->distance) : std::nullopt;
}

/// In front of the largest piece of a lamp, halfway to what it shines at; the middle of the scene
/// if there is no lamp.
Vec3 point_inside(const ShadedMesh& mesh, const VisibilityIndex& index) {
  Vec3 low = mesh.points.front(), high = low, lamp = Vec3::Zero(), normal = Vec3::Zero();
  for (const Vec3& p : mesh.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    if (mesh.emits[k] == 0) continue;
    const auto corner = [&](std::size_t c) {
      return mesh.points[static_cast<std::size_t>(mesh.triangles[k][c])];
    };
    const Vec3 area = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    if (area.norm() <= normal.norm()) continue;
    normal = area;
    lamp = (corner(0) + corner(1) + corner(2)) / 3;
  }
  if (normal.isZero(0)) return (low + high) / 2;
  normal.normalize();
  return lamp + distance(index, lamp, normal, Sides::both).value_or(0) / 2 * normal;
}

/// Whether the surroundings of `inside` close it in and cannot be seen from the camera.
bool is_hidden(const VisibilityIndex& index, const Vec3& inside, const Camera& camera) {
  int closed = 0, shown = 0;
  for (int k = 0; k < directions; ++k) {
    const auto wall = distance(index, inside, direction(k), Sides::both);
    if (!wall) continue;
    ++closed;
    const Vec3 ray = inside + *wall * direction(k) - camera.position;
    const double far = ray.norm();
    const auto seen = distance(index, camera.position, ray / far, Sides::front_only);
    if (seen && *seen > far * (1 - same_place)) ++shown;
  }
  return closed >= closed_share * directions && shown < hidden_share * closed;
}

/// Near a wall at the end of the longest line through the room, looking along it.
Camera camera_inside(const VisibilityIndex& index, const Vec3& inside, const Vec3& up) {
  const auto reach = [&](const Vec3& from, const Vec3& along) {
    return distance(index, from, along, Sides::both).value_or(0);
  };
  const Vec3 middle = inside + (reach(inside, up) - reach(inside, -up)) / 2 * up;
  const Vec3 side = up.unitOrthogonal(), front = up.cross(side);
  Camera camera;
  camera.name = "inside";
  camera.up = up;
  camera.vertical_fov = inside_fov;
  double longest = -1;
  for (int k = 0; k < azimuths; ++k) {
    const double turn = 2 * std::numbers::pi * (k + 0.5) / azimuths;
    const Vec3 along = std::cos(turn) * side + std::sin(turn) * front;
    const double back = reach(middle, -along), length = reach(middle, along) + back;
    if (!(length > longest * (1 + same_place))) continue;
    longest = length;
    camera.position = middle - near_wall * back * along;
    camera.direction = along - downwards * up;
  }
  return camera;
}

}  // namespace

Camera default_camera(const ShadedMesh& mesh) {
  if (!mesh.cameras.empty()) return mesh.cameras.front();
  const Camera outside = fitting_camera(mesh);
  if (mesh.triangles.empty()) return outside;
  const VisibilityIndex index = index_of(mesh);
  const Vec3 inside = point_inside(mesh, index);
  return is_hidden(index, inside, outside) ? camera_inside(index, inside, outside.up) : outside;
}

}  // namespace halfshade
