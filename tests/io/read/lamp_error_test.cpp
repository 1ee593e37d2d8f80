#include "io/picture/picture.h"
#include "io/read/read_scene.h"
#include "meshing/repair/repair.h"
#include "solver/direct/direct_light.h"
#include "tests/support/files.h"
#include "tests/support/painted.h"

#include <fmt/format.h>

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>
#include <random>

namespace halfshade {
namespace {

using testing::HasSubstr;

/// Linear between the middles of columns, even beyond the outermost.
double exitance(const std::vector<int>& columns, double u) {
  const auto count = static_cast<double>(columns.size());
  const double along = std::clamp(u * count - 0.5, 0., count - 1), below = std::floor(along);
  const auto k = static_cast<std::size_t>(below);
  const double high = test::linear(columns[std::min(k + 1, columns.size() - 1)]);
  return test::linear(columns[k]) + (along - below) * (high - test::linear(columns[k]));
}

/// Of a rectangle from 0 to x, y straight over a parallel element below its corner, at height 1.
double corner_factor(double x, double y) {
  const double a = std::hypot(1, x), b = std::hypot(1, y);
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * std::numbers::pi);
}

/// Of a lamp over a floor of 4 · 4 below it, whose picture has these columns.
SceneFile lamp(int width, int height, std::vector<std::uint8_t> pixels, double above,
               double tolerance) {
  const test::TempDir folder;
  write_png({width, height, 1, std::move(pixels), {}}, folder.path() / "lamp.png");
  folder.write("scene.mtl",
               "newmtl floor\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\nmap_Ke lamp.png\n");
  const auto scene = folder.write(
      "scene.obj",
      fmt::format("mtllib scene.mtl\nv -2 -2 0\nv 2 -2 0\nv 2 2 0\nv -2 2 0\nv -.5 -.5 {0}\n"
                  "v -.5 .5 {0}\nv .5 .5 {0}\nv .5 -.5 {0}\nvt 0 0\nvt 0 1\nvt 1 1\nvt 1 0\n"
                  "usemtl floor\nf 1 2 3 4\nusemtl lamp\nf 5/1 6/2 7/3 8/4\n",
                  above));
  LampOptions options;
  options.tolerance = tolerance;
  return read_scene(scene, {}, options);
}

SceneFile striped_lamp(const std::vector<int>& columns, double above, double tolerance) {
  std::vector<std::uint8_t> pixels;
  for (int row = 0; row < 4; ++row)
    for (const int byte : columns) pixels.insert(pixels.end(), 3, static_cast<std::uint8_t>(byte));
  return lamp(static_cast<int>(columns.size()), 4, std::move(pixels), above, tolerance);
}

/// Root of ∫ over the floor of squares: of what light of the pieces is off, and of the light, by
/// thin strips in closed form.
std::pair<double, double> compare(const Scene& scene, const std::vector<int>& columns,
                                  double above) {
  constexpr int count = 80, strips = 1024;
  std::vector<SurfacePoint> points;
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < count / 2; ++k)  // the same on the other half
      points.push_back({{-2 + 4 * (i + 0.5) / count, 4 * (k + 0.5) / count, 0}, Vec3::UnitZ()});
  const auto light = DirectLightIndex(make_sound(scene)).irradiance(points);
  double off = 0, all = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Vec3& p = points[n].position;
    const auto up_to = [&](double x) {
      return corner_factor((x - p.x()) / above, (0.5 - p.y()) / above) -
             corner_factor((x - p.x()) / above, (-0.5 - p.y()) / above);
    };
    double truth = 0;
    for (int s = 0; s < strips; ++s)
      truth += exitance(columns, (s + 0.5) / strips) *
               (up_to(-0.5 + (s + 1.) / strips) - up_to(-0.5 + double{1} * s / strips));
    off += std::pow(light[n].irradiance[0] - truth, 2);
    all += truth * truth;
  }
  const double area = 3. * 16 / static_cast<double>(points.size());  // three equal channels
  return {std::sqrt(area * off), std::sqrt(area * all)};
}

TEST(LampError, IsLittleBesideTheTolerance) {
  std::vector<int> ramp(256);
  for (int k = 0; k < 256; ++k) ramp[at(k)] = k;
  const std::vector<int> stripes = {217, 162, 130, 69, 78, 10, 19, 4};
  for (const auto& [columns, tolerance] : {std::pair{stripes, 1e-3}, {ramp, 1e-3}, {ramp, 3e-4}}) {
    const SceneFile file = striped_lamp(columns, 0.1, tolerance);
    EXPECT_TRUE(file.warnings.empty());
    EXPECT_FALSE(file.lamps.is_limited);
    EXPECT_EQ(file.lamps.tolerance, tolerance);
    const auto [off, all] = compare(file.scene, columns, 0.1);
    EXPECT_LT(off, 0.3 * tolerance * all);
    EXPECT_GT(file.lamps.error, off);
    EXPECT_LT(file.lamps.relative_error, 0.3 * tolerance);
    // That of even light; it is more where the picture is bright.
    const double norm = file.lamps.error / file.lamps.relative_error;
    EXPECT_LT(norm, 1.05 * all);
    EXPECT_GT(norm, 0.6 * all);
  }
}

TEST(LampError, TakesMorePiecesForLess) {
  const std::vector<int> stripes = {217, 162, 130, 69, 78, 10, 19, 4};
  std::size_t before = 0;
  for (const double tolerance : {1e-2, 1e-3, 3e-4}) {
    const std::size_t faces = striped_lamp(stripes, 0.1, tolerance).scene.faces.size();
    EXPECT_GT(faces, before);
    before = faces;
  }
}

TEST(LampError, IsToldWhereThereAreNotEnoughPieces) {
  std::mt19937 random(1);
  std::vector<std::uint8_t> pixels(std::size_t{3} * 64 * 64);
  for (std::uint8_t& byte : pixels) byte = static_cast<std::uint8_t>(random() % 256);
  const SceneFile file = lamp(64, 64, pixels, 0.1, 1e-3);
  EXPECT_TRUE(file.lamps.is_limited);
  EXPECT_GT(file.lamps.relative_error, 4e-4);
  ASSERT_EQ(file.warnings.size(), 1U);
  EXPECT_EQ(file.warnings[0], file.lamps.limit);
  EXPECT_THAT(file.warnings[0], HasSubstr("where 0.001 is asked for"));
  EXPECT_GT(file.scene.faces.size(), 200U);
}

}  // namespace
}  // namespace halfshade
