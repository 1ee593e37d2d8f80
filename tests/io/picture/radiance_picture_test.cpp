#include "io/picture/radiance_picture.h"

#include "tests/support/drawn_squares.h"
#include "tests/support/files.h"
#include "tests/support/random.h"

#include <gtest/gtest.h>
#include <vtkFloatArray.h>
#include <vtkHDRReader.h>
#include <vtkImageData.h>
#include <vtkNew.h>

#include <cmath>
#include <numbers>

namespace halfshade {
namespace {

using test::add_square, test::facing, test::picture_options;

TEST(DrawRadiance, IsRadiosityOverPi) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 0.5, Rgb(30, 1, 0.001));
  const RadiancePicture picture = draw_radiance(mesh, facing(), picture_options(40, 40));
  ASSERT_EQ(picture.radiance.size(), 1600U);
  const Rgb middle = picture.radiance[20 * 40 + 20], corner = picture.radiance[0];
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(middle[c], Rgb(30, 1, 0.001)[c] / std::numbers::pi, 1e-12 * middle[c]);
    EXPECT_EQ(corner[c], 0);
  }
}

TEST(DrawRadiance, ASceneWithoutLightIsRefused) {
  ShadedMesh mesh;
  add_square(mesh, Vec3::Zero(), 0.5, Rgb::Ones());
  mesh.headlight = true;
  test::expect_error([&] { draw_radiance(mesh, facing()); }, ErrorCode::contract, {"radiance"});
}

/// What VTK's reader makes of it; bottom row first.
std::vector<Rgb> read_hdr(const std::filesystem::path& path, int& width, int& height) {
  vtkNew<vtkHDRReader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  vtkImageData* image = reader->GetOutput();
  width = image->GetDimensions()[0];
  height = image->GetDimensions()[1];
  std::vector<Rgb> values;
  for (int y = height - 1; y >= 0; --y)
    for (int x = 0; x < width; ++x)
      values.emplace_back(image->GetScalarComponentAsDouble(x, y, 0, 0),
                          image->GetScalarComponentAsDouble(x, y, 0, 1),
                          image->GetScalarComponentAsDouble(x, y, 0, 2));
  return values;
}

TEST(WriteHdr, VtkReadsItBackToWithinItsBits) {
  const test::TempDir folder;
  test::Random random(5);
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {8, 2}, {300, 20}, {1000, 2}}) {
    RadiancePicture picture{width, height, {}};
    for (int k = 0; k < width * height; ++k) {
      // Runs of all lengths, among noise over many decades, and darkness.
      const bool repeats = k > 0 && random(0, 1) < 0.9 && (k / 150) % 2 == 0;
      const double size = std::pow(10., random(-12, 12));
      picture.radiance.push_back(repeats ? picture.radiance.back()
                                 : k % 11 == 0
                                     ? Rgb::Zero()
                                     : Rgb(size, size * random(0, 1), size * random(0, 1)));
    }
    write_hdr(picture, folder.path() / "a.hdr");
    int read_width = 0, read_height = 0;
    const std::vector<Rgb> values = read_hdr(folder.path() / "a.hdr", read_width, read_height);
    ASSERT_EQ(read_width, width);
    ASSERT_EQ(read_height, height);
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double brightest = picture.radiance[k].maxCoeff();
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(values[k][c], picture.radiance[k][c], brightest / 128) << k << ' ' << c;
    }
  }
}

TEST(WriteHdr, NumbersThatDoNotFitAreTheNearestThatDo) {
  const test::TempDir folder;
  RadiancePicture picture{8, 1, std::vector<Rgb>(8, Rgb(1e300, 0, 0))};
  picture.radiance[1] = Rgb(-5, 0, -1);
  picture.radiance[2] = Rgb::Constant(1e-300);
  picture.radiance[3] = Rgb::Constant(NAN);
  write_hdr(picture, folder.path() / "a.hdr");
  int width = 0, height = 0;
  const std::vector<Rgb> values = read_hdr(folder.path() / "a.hdr", width, height);
  EXPECT_GT(values[0][0], 1.5e38);
  for (std::size_t k : {1, 2, 3}) EXPECT_TRUE((values[k] == 0).all()) << k;
}

TEST(WriteHdr, RunsMakeItSmall) {
  const test::TempDir folder;
  write_hdr({1000, 100, std::vector<Rgb>(100000, Rgb(1, 2, 3))}, folder.path() / "a.hdr");
  EXPECT_LT(std::filesystem::file_size(folder.path() / "a.hdr"), 10000U);
}

TEST(WriteHdr, AnotherExtensionAndMissingPixelsAreRefused) {
  const test::TempDir folder;
  test::expect_error(
      [&] {
        write_hdr({1, 1, {Rgb::Ones()}}, folder.path() / "a.exr");
      },
      ErrorCode::usage, {".hdr"});
  test::expect_error(
      [&] {
        write_hdr({2, 2, {Rgb::Ones()}}, folder.path() / "a.hdr");
      },
      ErrorCode::contract, {"2 x 2"});
}

}  // namespace
}  // namespace halfshade
