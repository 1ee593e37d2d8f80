#include "meshing/core/scene.h"

#include "tests/support/expect_error.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace halfshade {
namespace {

using test::expect_error;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Scene square() {
  Scene scene;
  scene.source = "square.obj";
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                    test::add_material(scene, 0.5, 1));
  scene.faces[0].line = 31;
  return scene;
}

TEST(Validate, AcceptsSoundScenes) {
  EXPECT_NO_THROW(validate(square()));
  EXPECT_NO_THROW(validate(test::l_room(true)));
}

TEST(Validate, AcceptsTheLimitsOfEachRange) {
  Scene scene = square();
  scene.materials[0].rho = {0, 0.5, 1};
  scene.materials[0].exitance = {0, 1e-300, 1e300};
  EXPECT_NO_THROW(validate(scene));
}

TEST(Validate, IgnoresVerticesThatNoFaceUses) {
  Scene scene = square();
  scene.vertices.emplace_back(nan, 0, 0);
  EXPECT_NO_THROW(validate(scene));
}

TEST(Validate, AcceptsTheSameSceneAtAnyUsualSizeAndPlace) {
  for (const double size : {1e-50, 1e-6, 1.0, 1e6, 1e50})
    for (const double offset : {0.0, 1.0, 1e6}) {
      Scene scene = square();
      for (Vec3& p : scene.vertices) p = size * (p + Vec3::Constant(offset));
      EXPECT_NO_THROW(validate(scene)) << size << " " << offset;
    }
}

struct Violation {
  const char* name;
  std::function<void(Scene&)> make;
  std::vector<std::string> sentence;
};

void PrintTo(const Violation& v, std::ostream* out) { *out << v.name; }

class ValidateRejects : public testing::TestWithParam<Violation> {};

TEST_P(ValidateRejects, NamingTheValue) {
  Scene scene = square();
  GetParam().make(scene);
  std::vector<std::string> parts = GetParam().sentence;
  parts.emplace_back("square.obj: ");
  expect_error([&] { validate(scene); }, ErrorCode::invalid_input, parts);
}

const Violation violations[] = {
    {"NoFaces", [](Scene& s) { s.faces.clear(); }, {"no faces"}},
    {"TwoVertices",
     [](Scene& s) { s.faces[0].vertices.resize(2); },
     {"face 1 (line 31)", "2 vertices"}},
    {"IndexTooLarge",
     [](Scene& s) { s.faces[0].vertices[2] = 4; },
     {"face 1 (line 31)", "vertex 5", "4 vertices"}},
    {"IndexNegative", [](Scene& s) { s.faces[0].vertices[2] = -1; }, {"face 1 (line 31)"}},
    {"MaterialMissing", [](Scene& s) { s.faces[0].material = 1; }, {"material 2"}},
    {"GroupMissing", [](Scene& s) { s.faces[0].group = 1; }, {"group 2"}},
    {"NanCoordinate", [](Scene& s) { s.vertices[1].y() = nan; }, {"vertex 2", "nan"}},
    {"InfiniteCoordinate", [](Scene& s) { s.vertices[3].z() = -infinity; }, {"vertex 4", "-inf"}},
    {"HugeCoordinate", [](Scene& s) { s.vertices[0].x() = -1e61; }, {"1e+61"}},
    {"OnePoint",
     [](Scene& s) {
       for (Vec3& p : s.vertices) p = Vec3(3, 4, 5);
     },
     {"extends over 0"}},
    {"TinyScene",
     [](Scene& s) {
       for (Vec3& p : s.vertices) p *= 1e-100;
     },
     {"1e-100"}},
    {"FarFromTheOrigin",
     [](Scene& s) {
       for (Vec3& p : s.vertices) p += Vec3::Constant(1e10);
     },
     {"double precision"}},
    {"ReflectanceAboveOne",
     [](Scene& s) { s.materials[0].rho[1] = 1.2; },
     {"'m0'", "1.2", "channel 2"}},
    {"ReflectanceNegative", [](Scene& s) { s.materials[0].rho[0] = -0.1; }, {"-0.1"}},
    {"ReflectanceNan", [](Scene& s) { s.materials[0].rho[2] = nan; }, {"nan"}},
    {"ExitanceNegative",
     [](Scene& s) { s.materials[0].exitance[2] = -3; },
     {"exitance -3", "channel 3"}},
    {"ExitanceInfinite", [](Scene& s) { s.materials[0].exitance[0] = infinity; }, {"inf"}},
    {"CameraUpParallel",
     [](Scene& s) {
       s.cameras.emplace_back().up = {0, 0, 2};
       s.cameras[0].name = "door";
     },
     {"'door'"}},
    {"CameraWithoutDirection",
     [](Scene& s) { s.cameras.emplace_back().direction.setZero(); },
     {"camera"}},
    {"CameraFieldOfView",
     [](Scene& s) { s.cameras.emplace_back().vertical_fov = 180; },
     {"field of view"}},
    {"CameraPositionNan",
     [](Scene& s) { s.cameras.emplace_back().position.x() = nan; },
     {"camera"}},
};

INSTANTIATE_TEST_SUITE_P(Scenes, ValidateRejects, testing::ValuesIn(violations),
                         [](const auto& param) { return param.param.name; });

TEST(RequireEmitter, LooksAtTheMaterialsThatFacesUse) {
  Scene scene = square();
  EXPECT_NO_THROW(require_emitter(scene));
  scene.materials[0].exitance.setZero();
  expect_error([&] { require_emitter(scene); }, ErrorCode::invalid_input, {"emits light", "Ke"});
  test::add_material(scene, 0.5, 100);  // used by no face
  EXPECT_THROW(require_emitter(scene), Error);
  scene.materials[0].exitance[2] = 1;  // one channel is enough
  EXPECT_NO_THROW(require_emitter(scene));
}

TEST(FaceLabel, CountsFromOneAndNamesTheLineIfKnown) {
  Scene scene = square();
  EXPECT_EQ(face_label(scene, 0), "face 1 (line 31)");
  scene.faces[0].line = 0;
  EXPECT_EQ(face_label(scene, 0), "face 1");
}

TEST(FaceCorners, KeepTheOrderOfTheFace) {
  Scene scene = square();
  scene.faces[0].vertices = {2, 0, 3};
  const std::vector<Vec3> corners = face_corners(scene, 0);
  ASSERT_EQ(corners.size(), 3U);
  EXPECT_EQ(corners[0], Vec3(1, 1, 0));
  EXPECT_EQ(corners[1], Vec3(0, 0, 0));
  EXPECT_EQ(corners[2], Vec3(0, 1, 0));
}

TEST(Diagonal, IgnoresUnusedVertices) {
  Scene scene = square();
  EXPECT_DOUBLE_EQ(diagonal(scene), std::sqrt(2.0));
  scene.vertices.emplace_back(100, 100, 100);
  EXPECT_DOUBLE_EQ(diagonal(scene), std::sqrt(2.0));
}

}  // namespace
}  // namespace halfshade
