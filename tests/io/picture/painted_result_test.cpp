#include "io/files/paint_numbers.h"
#include "io/files/seal.h"
#include "io/picture/result_file.h"
#include "io/write/write_result.h"
#include "meshing/repair/repair.h"
#include "tests/support/files.h"
#include "tests/support/painted.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

const SolveResult& painted_result() {
  static const SolveResult result = [] {
    SolveOptions options;
    options.tolerance = 0.05;
    SolveResult solved = solve(test::two_coloured_room(true), options);
    Camera camera;
    camera.position = {1, 0.05, 0.5};
    camera.direction = Vec3::UnitY();
    camera.up = Vec3::UnitZ();
    camera.vertical_fov = 60;
    solved.cameras = {camera};
    return solved;
  }();
  return result;
}

/// sRGB of a pixel, column and row as shares.
Eigen::Array3i pixel(const Picture& picture, double x, double y) {
  const int column = static_cast<int>(x * picture.width),
            row = static_cast<int>(y * picture.height);
  const std::size_t k = 3 * (at(row) * at(picture.width) + at(column));
  return {picture.pixels[k], picture.pixels[k + 1], picture.pixels[k + 2]};
}

void expect_red_left_blue_right(const Picture& picture) {
  for (const double y : {0.3, 0.7})
    for (const double x : {0.1, 0.35, 0.48}) {
      const auto left = pixel(picture, x, y), right = pixel(picture, 1 - x, y);
      EXPECT_GT(left[0], 1.3 * left[2]) << x << ' ' << y;
      EXPECT_GT(right[2], 1.3 * right[0]) << x << ' ' << y;
    }
}

TEST(PaintedResult, IsDrawnWithItsPicture) {
  const SolveResult& result = painted_result();
  PictureOptions options;
  options.width = options.height = 60;
  expect_red_left_blue_right(draw(shaded(result), result.cameras[0], options));
}

/// Constant elements share points with neighbours that show other parts of the picture.
TEST(PaintedResult, OfConstantElementsIsTheSame) {
  SolveOptions options;
  options.method = SolveMethod::matrix;
  options.elements = 100;
  SolveResult result = solve(test::two_coloured_room(true), options);
  result.cameras = painted_result().cameras;
  const test::TempDir folder;
  write_result(result, {}, folder.path() / "room.vtu");
  PictureOptions picture;
  picture.width = picture.height = 60;
  const Picture fields = draw(shaded(painted_result()), result.cameras[0], picture);
  for (const ShadedMesh& mesh : {shaded(result), read_shaded(folder.path() / "room.vtu")}) {
    const Picture constants = draw(mesh, result.cameras[0], picture);
    expect_red_left_blue_right(constants);
    for (const double y : {0.3, 0.5, 0.7})
      for (const double x : {0.1, 0.35, 0.47, 0.53, 0.65, 0.9})
        EXPECT_LT((pixel(constants, x, y) - pixel(fields, x, y)).abs().maxCoeff(), 40)
            << x << ' ' << y;
  }
}

TEST(PaintedResult, FilesHoldThePicture) {
  const test::TempDir folder;
  PictureOptions options;
  options.width = options.height = 60;
  for (const char* name : {"room.vtu", "room.vtp"}) {
    write_result(painted_result(), {}, folder.path() / name);
    const ShadedMesh mesh = read_shaded(folder.path() / name);
    ASSERT_EQ(mesh.paints.size(), 1U);
    EXPECT_EQ(mesh.paints[0].along, painted_result().scene.paints[0].along);
    expect_red_left_blue_right(draw(mesh, mesh.cameras[0], options));
  }
}

TEST(PaintedResult, NumbersGiveBackWhatTheyWereMadeOf) {
  detail::PaintOn first{test::across_x(test::two_coloured({1, 0, 0}, {0, 1, 0}, 4), 3),
                        {1, 0.5, 0}};
  detail::PaintOn second = first;
  second.paint.from = {0.25, 7};
  const auto numbers = detail::to_numbers({first, second});
  EXPECT_EQ(numbers.textures.size(), 1U);
  const auto paints = detail::to_paints(numbers);
  ASSERT_EQ(paints.size(), 2U);
  EXPECT_EQ(paints[1].paint.from, second.paint.from);
  EXPECT_EQ(paints[0].paint.along, first.paint.along);
  EXPECT_TRUE((paints[0].most == first.most).all());
  for (const double x : {0.1, 1., 2.9})
    EXPECT_TRUE((colour_at(paints[0].paint, {x, 0, 0}) == colour_at(first.paint, {x, 0, 0})).all());
}

TEST(PaintedResult, NumbersThatDoNotFitAreNoPaints) {
  const detail::PaintOn paint{test::across_x(test::two_coloured({1, 0, 0}, {0, 1, 0}, 4), 3), {}};
  const auto good = detail::to_numbers({paint});
  auto wrong = good;
  wrong.sizes = {3, 1};
  EXPECT_TRUE(detail::to_paints(wrong).empty());
  wrong = good;
  wrong.sizes = {};
  EXPECT_TRUE(detail::to_paints(wrong).empty());
  wrong = good;
  wrong.paints[0] = 1;
  EXPECT_TRUE(detail::to_paints(wrong).empty());
  wrong = good;
  wrong.paints[3] = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(detail::to_paints(wrong).empty());
}

TEST(PaintedResult, ScenesAreDrawnWithTheirPictures) {
  const SoundScene scene = make_sound(test::two_coloured_room(true));
  PictureOptions options;
  options.width = options.height = 60;
  expect_red_left_blue_right(draw(shaded(scene, {}), painted_result().cameras[0], options));
}

}  // namespace
}  // namespace halfshade
