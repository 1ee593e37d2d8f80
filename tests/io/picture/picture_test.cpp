#include "io/picture/picture.h"

#include "io/files/atomic_file.h"
#include "io/write/write_result.h"
#include "meshing/repair/repair.h"
#include "tests/support/drawn_squares.h"
#include "tests/support/files.h"
#include "tests/support/sample_result.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace halfshade {
namespace {

namespace fs = std::filesystem;
using test::Pixel;

using test::add_square, test::facing;
constexpr Pixel background = test::picture_background;

PictureOptions options(int width, int height, int samples = 4) {
  return test::picture_options(width, height, samples);
}

Pixel at(const Picture& picture, int column, int row) {
  return test::pixel_of(picture, column, row);
}

TEST(Draw, AUniformSquareIsUniformAndCentred) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 0.5, Rgb(2, 1, 0));
  PictureOptions set = options(40, 40);
  set.exposure = 0.25;
  const Picture picture = draw(mesh, facing(), set);
  EXPECT_EQ(picture.width, 40);
  EXPECT_EQ(picture.height, 40);
  EXPECT_EQ(picture.exposure, 0.25);
  ASSERT_EQ(picture.pixels.size(), 4800U);
  // Linear 0.5, 0.25 and 0 in sRGB.
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 40; ++column) {
      const bool inside = row >= 10 && row < 30 && column >= 10 && column < 30;
      EXPECT_EQ(at(picture, column, row), (inside ? Pixel{188, 137, 0} : background))
          << column << ' ' << row;
    }
}

TEST(Draw, RightIsDirectionCrossUpAndTheTopRowComesFirst) {
  ShadedMesh mesh;
  add_square(mesh, {0.5, 0.5, 0}, 0.2, Rgb(1, 0, 0));   // right, up
  add_square(mesh, {-0.5, 0.5, 0}, 0.2, Rgb(0, 1, 0));  // left, up
  add_square(mesh, {0.5, -0.5, 0}, 0.2, Rgb(0, 0, 1));  // right, down
  const Picture picture = draw(mesh, facing(), options(20, 20));
  EXPECT_GT(at(picture, 15, 5)[0], 200);
  EXPECT_GT(at(picture, 5, 5)[1], 200);
  EXPECT_GT(at(picture, 15, 15)[2], 200);
  EXPECT_EQ(at(picture, 5, 15), background);
}

TEST(Draw, ATiltedCameraTurnsThePicture) {
  // Up along +x: what lies at +x is at the top, and −y... direction × up = −z × x = −y at the
  // right.
  ShadedMesh mesh;
  add_square(mesh, {0.5, -0.5, 0}, 0.2, Rgb(1, 1, 1));
  Camera camera = facing();
  camera.up = {5, 0, 3};  // the part along the direction does not matter
  camera.direction *= 1e-3;
  const Picture picture = draw(mesh, camera, options(20, 20));
  EXPECT_GT(at(picture, 15, 5)[0], 200);
  EXPECT_EQ(at(picture, 5, 5), background);
}

TEST(Draw, ASymmetricViewGivesASymmetricPicture) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 0.613, Rgb(1, 2, 3));
  add_square(mesh, {0, 0, 0.1}, 0.2, Rgb(30, 20, 10), true);
  for (const int size : {32, 33}) {
    const Picture picture = draw(mesh, facing(), options(size, size, 9));
    for (int row = 0; row < size; ++row)
      for (int column = 0; column < size; ++column) {
        EXPECT_EQ(at(picture, column, row), at(picture, size - 1 - column, row));
        EXPECT_EQ(at(picture, column, row), at(picture, row, column));
      }
  }
}

TEST(Draw, TheFieldOfViewIsTheVerticalOneAndPixelsAreSquare) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 0.5, Rgb(1, 1, 1));
  for (const int width : {20, 80}) {
    const Picture picture = draw(mesh, facing(), options(width, 40));
    for (int column = 0; column < width; ++column)
      EXPECT_EQ(at(picture, column, 20) != background, std::abs(column + 0.5 - width / 2.0) < 10);
  }
}

TEST(Draw, BackSidesLetTheViewPass) {
  ShadedMesh mesh;
  add_square(mesh, {0, 0, 0.5}, 0.9, Rgb(9, 9, 9), false, true);
  EXPECT_EQ(at(draw(mesh, facing(), options(9, 9)), 4, 4), background);
  add_square(mesh, Vec3::Zero(), 0.9, Rgb(1, 0, 0));
  const Pixel pixel = at(draw(mesh, facing(), options(9, 9)), 4, 4);
  EXPECT_GT(pixel[0], 200);
  EXPECT_EQ(pixel[1], 0);
}

TEST(Draw, EdgesAreSmoothEvenOfLampsFarAboveWhite) {
  // The edge at x = 0.05 cuts column 10 of 20 in the middle: half white, half background.
  ShadedMesh mesh;
  add_square(mesh, {-0.95, 0, 0}, 1, Rgb::Constant(1e5), true);
  PictureOptions set = options(20, 20, 16);
  set.exposure = 1;
  const Picture picture = draw(mesh, facing(), set);
  EXPECT_EQ(at(picture, 9, 10), (Pixel{255, 255, 255}));
  EXPECT_EQ(at(picture, 11, 10), background);
  EXPECT_NEAR(at(picture, 10, 10)[0], 189, 1);  // linear (1 + 0.015) / 2
}

TEST(Draw, ShadesSmoothlyFromPointsAndFlatlyFromTriangles) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 1, Rgb::Constant(0.1));
  for (std::size_t i = 0; i < 4; ++i)
    mesh.point_value[i] = Rgb::Constant(0.25 + 0.25 * mesh.points[i].x());
  PictureOptions set = options(16, 16, 1);
  set.exposure = 1;
  const auto srgb = [](double v) { return 255 * (1.055 * std::pow(v, 1 / 2.4) - 0.055); };
  const Picture smooth = draw(mesh, facing(), set);
  set.shading = Shading::flat;
  const Picture flat = draw(mesh, facing(), set);
  for (int column = 0; column < 16; ++column) {
    EXPECT_NEAR(at(smooth, column, 3)[1], srgb((column + 0.5) / 16 / 2), 0.51);
    EXPECT_NEAR(at(flat, column, 3)[1], srgb(0.1), 0.51);
  }
}

TEST(Draw, MeshLinesAreOnePixelWideBetweenNeighbours) {
  ShadedMesh mesh;
  add_square(mesh, {-0.5, 0, 0}, 0.5, Rgb::Constant(1));
  add_square(mesh, {0.5, 0, 0}, 0.5, Rgb::Constant(1));
  PictureOptions set = options(41, 41, 49);  // the common edge runs down the middle of column 20
  set.mesh_lines = true;
  const Picture picture = draw(mesh, facing(), set);
  const int plain = at(picture, 12, 20)[0];  // off the diagonals
  EXPECT_LT(at(picture, 20, 20)[0], 0.75 * plain);
  EXPECT_NEAR(at(picture, 18, 20)[0], plain, 1);
  EXPECT_NEAR(at(picture, 22, 20)[0], plain, 1);
}

TEST(Draw, TheExposureDoesNotLookAtLampsAndIsGivenBack) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 1, Rgb::Constant(4));
  EXPECT_NEAR(draw(mesh, facing(), options(8, 8)).exposure, 0.2, 1e-12);
  add_square(mesh, {0, 0, 0.1}, 0.5, Rgb::Constant(400), true);
  EXPECT_NEAR(draw(mesh, facing(), options(8, 8)).exposure, 0.2, 1e-12);
  EXPECT_EQ(draw({}, facing(), options(8, 8)).exposure, 1);
}

TEST(Draw, ThreadsDoNotChangeTheBytes) {
  const ShadedMesh mesh = shaded(test::sample_result(9));
  const Camera camera = fitting_camera(mesh);
  const auto with_threads = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return draw(mesh, camera, options(64, 48)).pixels; });
  };
  const auto one = with_threads(1);
  EXPECT_EQ(one, with_threads(2));
}

TEST(Draw, RowsNotReachedStayBlack) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 1, Rgb::Constant(1));
  std::stop_source stop;
  stop.request_stop();
  const Picture picture = draw(mesh, facing(), options(8, 8), {stop.get_token(), {}});
  EXPECT_EQ(std::count(picture.pixels.begin(), picture.pixels.end(), 0), 8 * 8 * 3);
}

TEST(Draw, RefusesWhatCannotBeDrawn) {
  const auto refuse = [](const Camera& camera, const PictureOptions& set) {
    test::expect_error([&] { draw({}, camera, set); }, ErrorCode::contract, {"draw"});
  };
  for (const auto& set : {options(0, 5), options(5, 16385), options(5, 5, 0), options(5, 5, 1025)})
    refuse(facing(), set);
  PictureOptions dim = options(5, 5);
  dim.exposure = -1;
  refuse(facing(), dim);
  Camera camera = facing();
  camera.up = camera.direction;
  refuse(camera, options(5, 5));
  camera = facing();
  camera.vertical_fov = 180;
  refuse(camera, options(5, 5));
  camera = facing();
  camera.position.x() = std::numeric_limits<double>::quiet_NaN();
  refuse(camera, options(5, 5));
}

TEST(FittingCamera, ShowsTheWholeSceneFromOutsideWithUpUpwards) {
  for (const Vec3& size : {Vec3(2, 2, 1), Vec3(1, 1, 1), Vec3(5, 0.1, 3), Vec3(1e-6, 1, 1)}) {
    ShadedMesh mesh;
    const Scene scene = test::room(size, {});
    for (const Face& face : scene.faces)
      for (std::size_t k = 0; k < 4; ++k)
        mesh.points.push_back(scene.vertices[static_cast<std::size_t>(face.vertices[k])]);
    const Camera camera = fitting_camera(mesh);
    const Vec3 forward = camera.direction.normalized();
    const Vec3 right = forward.cross(camera.up).normalized();
    const double slope = std::tan(camera.vertical_fov / 2 * std::acos(-1.0) / 180);
    double widest = 0;
    for (const Vec3& p : mesh.points) {
      const Vec3 d = p - camera.position;
      ASSERT_GT(d.dot(forward), 0);
      widest = std::max({widest, std::abs(d.dot(right)) / d.dot(forward) / slope,
                         std::abs(d.dot(right.cross(forward))) / d.dot(forward) / slope});
    }
    EXPECT_LE(widest, 1);
    EXPECT_GT(widest, 0.9) << "and no smaller than need be";
    EXPECT_LT(forward.dot(camera.up), -0.1) << "from above";
    EXPECT_GT(forward.dot(camera.up), -0.6) << "but only slightly";
    EXPECT_FALSE(((camera.position.array() > 0) && (camera.position.array() < size.array())).all());
  }
  EXPECT_EQ(fitting_camera(shaded(test::sample_result(1))).up, Vec3::UnitZ());
}

TEST(FittingCamera, LooksAtTheFrontOfAnOpenScene) {
  for (const bool away : {false, true}) {
    ShadedMesh mesh;
    add_square(mesh, {3, 4, 5}, 2, Rgb::Constant(1), false, away);
    const Picture picture = draw(mesh, fitting_camera(mesh), options(30, 30));
    EXPECT_NE(at(picture, 15, 15), background) << away;
  }
}

/// The box's six squares; their fronts look outwards or inwards.
void add_box(ShadedMesh& mesh, double half, bool outwards) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-half, half}) {
      const int first = static_cast<int>(mesh.points.size());
      for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = a * half;
        p[(axis + 2) % 3] = b * half;
        mesh.points.push_back(p);
        mesh.point_value.push_back(Rgb::Constant(1));
      }
      const bool turned = (side > 0) != outwards;
      for (const auto& t : {std::array{0, 1, 2}, {0, 2, 3}}) {
        std::array<int, 3> corners = {first + t[0], first + t[1], first + t[2]};
        if (turned) std::swap(corners[1], corners[2]);
        mesh.triangles.push_back(corners);
        mesh.triangle_value.push_back(Rgb::Constant(1));
        mesh.emits.push_back(0);
      }
    }
}

TEST(DefaultCamera, StandsInARoomThatOuterWallsHide) {
  const auto is_inside = [](const ShadedMesh& mesh) {
    return default_camera(mesh).position.cwiseAbs().maxCoeff() < 1;
  };
  ShadedMesh thin, thick, block;
  add_box(thin, 1, false);
  add_box(block, 1, true);
  add_box(thick, 1, false);
  add_box(thick, 1.2, true);
  EXPECT_FALSE(is_inside(thin)) << "it can be looked into from outside";
  EXPECT_TRUE(is_inside(thick));
  const Picture picture = draw(thick, default_camera(thick), options(30, 30));
  for (const int p : {2, 15, 27}) EXPECT_NE(at(picture, p, p), background);
  thick.cameras = {facing()};
  EXPECT_EQ(default_camera(thick).position, facing().position) << "the scene's own";
  add_square(block, {5, 5, 5}, 1, Rgb::Constant(1), true);  // a lamp that nothing closes in
  EXPECT_FALSE(is_inside(block));
}

TEST(Shaded, ASolutionCarriesItsLightAndItsLamps) {
  const SolveResult result = test::sample_result(2);
  const ShadedMesh mesh = shaded(result);
  EXPECT_EQ(mesh.points, result.elements.points);
  EXPECT_EQ(mesh.triangles, result.elements.corners);
  EXPECT_EQ(mesh.cameras.at(0).name, "above");
  EXPECT_EQ(mesh.emits, (std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0}));
  EXPECT_FALSE(mesh.headlight);
  for (Eigen::Index e = 0; e < 8; ++e)
    EXPECT_TRUE((mesh.triangle_value[static_cast<std::size_t>(e)] ==
                 result.solution.radiosity.row(e).transpose())
                    .all());
}

TEST(Shaded, ASceneIsCoveredByItsTrianglesAndShowsItsReflectances) {
  Scene scene = test::room({2, 3, 1}, {});
  scene.materials[0].rho = Rgb(0.7, 0.2, 0.1);    // at −x
  scene.materials[5].exitance = Rgb(100, 50, 0);  // at +z
  const ShadedMesh mesh = shaded(make_sound(scene), {});
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto corner = [&](std::size_t k) {
      return mesh.points[static_cast<std::size_t>(mesh.triangles[t][k])];
    };
    const Vec3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    area += normal.norm() / 2;
    EXPECT_GT(normal.dot(Vec3(1, 1.5, 0.5) - corner(0)), 0) << "looks inwards";
    if (normal.x() > 0) {
      EXPECT_TRUE((mesh.triangle_value[t] == scene.materials[0].rho).all());
    }
    EXPECT_EQ(mesh.emits[t], normal.z() < 0 ? 1 : 0);
  }
  EXPECT_NEAR(area, 2 * (2 * 3 + 2 * 1 + 3 * 1), 1e-12);
  const Picture picture = draw(mesh, fitting_camera(mesh), options(20, 20));
  EXPECT_NE(at(picture, 10, 10), background);
}

TEST(WritePng, IsAPngOfItsSizeAndAppearsWhole) {
  const test::TempDir folder;
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 1, Rgb::Constant(1));
  write_png(draw(mesh, facing(), options(300, 7, 1)), folder.path() / "a.png");
  const std::string bytes = test::contents(folder.path() / "a.png");
  EXPECT_EQ(bytes.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(bytes.substr(12, 4), "IHDR");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\x01\x2c\0\0\0\x07", 8));
  EXPECT_EQ(bytes.substr(24, 2), "\x08\x02") << "8 bits, RGB";
  EXPECT_EQ(bytes.substr(bytes.size() - 8, 4), "IEND");
}

TEST(WritePng, RefusesOtherExtensionsAndPlaces) {
  const Picture picture = draw({}, facing(), options(2, 2));
  test::expect_error([&] { write_png(picture, "a.jpg"); }, ErrorCode::usage, {"a.jpg", ".png"});
  test::expect_error([&] { write_png(picture, "/proc/none/a.png"); }, ErrorCode::unwritable,
                     {"/proc/none/a.png", "No such file"});
  test::expect_error([&] { write_png({}, "a.png"); }, ErrorCode::contract, {"write_png"});
}

}  // namespace
}  // namespace halfshade
