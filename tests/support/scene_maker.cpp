#include "tests/support/scene_maker.h"

#include "meshing/repair/repair.h"

#include <Eigen/Geometry>

#include <cstddef>

namespace halfshade::test {

SceneMaker::SceneMaker() {
  add_material(scene, 0.5, 0);
  add_material(scene, 0, 1);
  add_material(scene, 0, 3);
  add_material(scene, 0.5, 0);
  scene.materials[two_sided_grey].two_sided = true;
}

SceneMaker& SceneMaker::polygon(const std::vector<Vec3>& corners, int material) {
  add_polygon(scene, corners, material);
  return *this;
}

SceneMaker& SceneMaker::up(const Vec2& low, const Vec2& high, double z, int material) {
  return polygon({{low.x(), low.y(), z},
                  {high.x(), low.y(), z},
                  {high.x(), high.y(), z},
                  {low.x(), high.y(), z}},
                 material);
}

SceneMaker& SceneMaker::down(const Vec2& low, const Vec2& high, double z, int material) {
  return polygon({{low.x(), high.y(), z},
                  {high.x(), high.y(), z},
                  {high.x(), low.y(), z},
                  {low.x(), low.y(), z}},
                 material);
}

SceneMaker& SceneMaker::box(const Vec3& low, const Vec3& high) {
  for (const auto& face : box_faces(low, high, false)) polygon(face);
  return *this;
}

SceneMaker& SceneMaker::standing_box(const Vec3& low, const Vec3& high) {
  const auto faces = box_faces(low, high, false);
  for (const std::size_t f : {0, 1, 2, 3, 5}) polygon(faces[f]);
  return *this;
}

SceneMaker& SceneMaker::turned_box(const Vec3& low, const Vec3& high, double angle) {
  const Eigen::AngleAxisd turn(angle, Vec3::UnitZ());
  const Vec3 middle = 0.5 * (low + high);
  for (auto face : box_faces(low, high, false)) {
    for (Vec3& p : face) p = middle + turn * (p - middle);
    polygon(face);
  }
  return *this;
}

SceneMaker& SceneMaker::tetrahedron(const std::array<Vec3, 4>& p) {
  const bool right = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]) > 0;
  const Vec3 &a = p[0], &b = right ? p[1] : p[2], &c = right ? p[2] : p[1], &d = p[3];
  return polygon({a, c, b}).polygon({a, b, d}).polygon({b, c, d}).polygon({c, a, d});
}

SceneMaker& SceneMaker::square_light(double z, int material) {
  return down({-0.5, -0.5}, {0.5, 0.5}, z, material);
}

SceneMaker& SceneMaker::floor() { return up({-1.9371, -2.0371}, {1.9613, 1.8613}, 0); }

SceneMaker& SceneMaker::move(const Vec3& by) {
  for (Vec3& p : scene.vertices) p += by;
  return *this;
}

SoundScene SceneMaker::sound() const { return make_sound(scene); }

}  // namespace halfshade::test
