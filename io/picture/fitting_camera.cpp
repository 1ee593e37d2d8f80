#include "io/picture/picture.h"
#include "meshing/core/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

/// Sides that differ by less are not meant to differ.
constexpr double same_side = 0.99;
/// How much more a later direction must show to be taken: more than rounding does.
constexpr double clearly_more = 1.01;
/// The camera stands this much higher, and to the side, than straight in front.
constexpr double rise = 0.4, aside = 0.25;
/// Free space round the scene in the picture.
constexpr double room_around = 1.05;

struct Box {
  Vec3 low, high;
};

Box bounds(const ShadedMesh& mesh) {
  Box box{mesh.points.front(), mesh.points.front()};
  for (const Vec3& p : mesh.points) {
    box.low = box.low.cwiseMin(p);
    box.high = box.high.cwiseMax(p);
  }
  return box;
}

int up_axis(const Vec3& size) {
  int axis = 1;
  for (const int other : {2, 0})
    // Of equal sides y wins, the habit of OBJ files.
    if (size[other] < same_side * size[axis]) axis = other;
  return axis;
}

/// The area of the front sides seen from far away in direction `towards`, times its length.
double front_area(const ShadedMesh& mesh, const Vec3& towards) {
  double area = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3& a = mesh.points[static_cast<std::size_t>(t[0])];
    const Vec3 normal = (mesh.points[static_cast<std::size_t>(t[1])] - a)
                            .cross(mesh.points[static_cast<std::size_t>(t[2])] - a);
    area += std::max(0.0, normal.dot(towards));
  }
  return area;
}

/// From the scene to the camera: to one side and slightly up; from below where only that shows
/// more.
Vec3 choose_side(const ShadedMesh& mesh, const Vec3& up, double length) {
  const double scale = 1 / length;  // areas of extreme scenes stay in the range of doubles
  ShadedMesh unit;
  unit.triangles = mesh.triangles;
  for (const Vec3& p : mesh.points) unit.points.push_back((p - mesh.points.front()) * scale);
  const Vec3 front = up.y() != 0   ? Vec3::UnitZ()
                     : up.z() != 0 ? Vec3(-Vec3::UnitY())
                                   : Vec3::UnitZ();
  const Vec3 side = up.cross(front);
  Vec3 best = Vec3::Zero();
  double most = -1;
  for (const double height : {rise, -rise})
    for (const Vec3& along : {front, side, Vec3(-side), Vec3(-front)}) {
      const Vec3 across = up.cross(along);
      const Vec3 towards = (along + aside * across + height * up).normalized();
      const double area = front_area(unit, towards);
      if (area > clearly_more * most || most < 0) {
        most = area;
        best = towards;
      }
    }
  return best;
}

}  // namespace

Camera fitting_camera(const ShadedMesh& mesh) {
  if (mesh.points.empty())
    throw Error(ErrorCode::contract, "fitting_camera", "the mesh has no points");
  const Box box = bounds(mesh);
  const Vec3 size = box.high - box.low;
  const double length = size.maxCoeff() > 0 ? size.maxCoeff() : 1;
  Camera camera;
  camera.name = "fitting";
  camera.up = Vec3::Unit(up_axis(size));
  const Vec3 towards = choose_side(mesh, camera.up, length);
  const Vec3 right = camera.up.cross(towards).normalized();
  const Vec3 top = towards.cross(right);
  const double slope = std::tan(camera.vertical_fov / 2 * std::numbers::pi / 180) / room_around;
  const Vec3 centre = (box.low + box.high) / 2;
  double distance = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner((i & 1) ? box.high.x() : box.low.x(), (i & 2) ? box.high.y() : box.low.y(),
                      (i & 4) ? box.high.z() : box.low.z());
    const Vec3 d = corner - centre;
    const double reach = std::max(std::abs(d.dot(right)), std::abs(d.dot(top)));
    distance = std::max(distance, d.dot(towards) + reach / slope);
  }
  camera.position = centre + (distance > 0 ? distance : 1) * towards;
  camera.direction = -towards;
  return camera;
}

}  // namespace halfshade
