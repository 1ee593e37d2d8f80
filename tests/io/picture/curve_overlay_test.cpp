#include "io/picture/curve_picture.h"
#include "io/write/write_curves.h"
#include "tests/support/drawn_squares.h"
#include "tests/support/files.h"
#include "tests/support/hand_made_curves.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

using test::add_square, test::facing, test::picture_options, test::pixel_of;

/// A dark square with a smaller one before its right half.
ShadedMesh two_squares() {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 1, Rgb::Constant(0.01));
  add_square(mesh, {0.3, 0, 0.4}, 0.2, Rgb::Constant(0.01));
  return mesh;
}

Picture drawn_with(const std::vector<Vec3>& points) {
  PictureOptions options = picture_options(80, 80);
  options.exposure = 1;
  options.curve_width = 3;
  options.curves = {{points, {255, 0, 0}}};
  return draw(two_squares(), facing(), options);
}

bool is_red(const Picture& picture, int column, int row) {
  return pixel_of(picture, column, row)[0] > 200 && pixel_of(picture, column, row)[1] < 100;
}

TEST(CurveOverlay, IsSeenWhereItsSurfaceIs) {
  // The smaller square hides x = 0.3 ∓ 0.2 seen from z = 1: columns 40 + 40·(0.1…0.5)/0.6.
  const Picture picture = drawn_with({{-0.9, 0, 0}, {0.9, 0, 0}});
  for (int column = 0; column < 80; ++column) {
    const bool is_free = column >= 6 && column < 44;
    const bool is_hidden = column >= 49 && column < 71;
    EXPECT_TRUE(is_hidden || !is_free || is_red(picture, column, 40)) << column;
    EXPECT_FALSE(is_hidden && is_red(picture, column, 40)) << column;
    EXPECT_FALSE(is_red(picture, column, 20)) << column;
  }
}

TEST(CurveOverlay, OnTheBorderOfASurfaceIsSeen) {
  const Picture picture = drawn_with({{0.1, 0.2, 0.4}, {0.5, 0.2, 0.4}});
  // y = 0.2 at depth 0.6: row 40 − 40·0.2/0.6.
  int red = 0;
  for (int column = 48; column < 72; ++column) red += is_red(picture, column, 26);
  EXPECT_GT(red, 20);
}

TEST(CurveOverlay, OffEverySurfaceIsNotSeen) {
  const Picture picture = drawn_with({{-0.9, -0.3, 0.2}, {0.9, -0.3, 0.2}});
  for (int column = 0; column < 80; ++column)
    for (int row = 0; row < 80; ++row) EXPECT_FALSE(is_red(picture, column, row));
}

TEST(CurveOverlay, PiecesThatPassTheCameraAreCutThere) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 4, Rgb::Constant(0.01));
  Camera camera;
  camera.position = {0, 0, 0.5};
  camera.direction = {1, 0, -0.2};
  camera.up = {0, 0, 1};
  PictureOptions options = picture_options(60, 60);
  options.curve_width = 3;
  options.curves = {{{{-3, 0, 0}, {3, 0, 0}}, {255, 0, 0}}};
  const Picture picture = draw(mesh, camera, options);
  int red = 0;
  for (int row = 0; row < 60; ++row) red += is_red(picture, 30, row) || is_red(picture, 29, row);
  EXPECT_GT(red, 10);
}

TEST(ReadCurves, GivesBackWhatWasWrittenLowestOrderLast) {
  const test::TempDir folder;
  const Discontinuities found = test::hand_made_curves();
  const SoundScene scene = test::s1();
  write_curves(scene, found, folder.path() / "c.vtp");
  const std::vector<OverlaidCurve> curves = read_curves(folder.path() / "c.vtp");
  ASSERT_EQ(curves.size(), found.curves.size());
  std::vector<const DiscontinuityCurve*> sorted;
  for (const auto& curve : found.curves) sorted.push_back(&curve);
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto* a, const auto* b) {
    return std::pair(a->order, a->kind) > std::pair(b->order, b->kind);
  });
  for (std::size_t k = 0; k < curves.size(); ++k) {
    EXPECT_EQ(curves[k].colour, curve_colour(*sorted[k], CurveColour::order));
    const Surface& receiver = scene.surfaces[static_cast<std::size_t>(sorted[k]->receiver)];
    EXPECT_LT(
        (curves[k].points.front() - receiver.frame.to_space(point_at(sorted[k]->arc, 0))).norm(),
        1e-12);
    EXPECT_LT(
        (curves[k].points.back() - receiver.frame.to_space(point_at(sorted[k]->arc, 1))).norm(),
        1e-12);
  }
}

TEST(ReadCurves, WhatIsNoFileOfCurvesIsRefused) {
  const test::TempDir folder;
  const auto refused = [&](const std::string& name, const std::string& part) {
    test::expect_error([&] { read_curves(folder.path() / name); }, ErrorCode::invalid_input,
                       {name, part});
  };
  refused("none.vtp", "cannot be opened");
  folder.write("a.vtp", "hello");
  refused("a.vtp", "no result of halfshade");
  folder.write("a.csv", "1,2");
  refused("a.csv", ".vtp");
}

}  // namespace
}  // namespace halfshade
