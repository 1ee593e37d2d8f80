#include "io/picture/picture.h"
#include "io/read/read_scene.h"
#include "meshing/core/planar.h"
#include "meshing/repair/repair.h"
#include "solver/direct/painted_light.h"
#include "tests/support/files.h"
#include "tests/support/painted.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <gmock/gmock.h>
#include <string>

namespace halfshade {
namespace {

using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Bytes of red, green and blue of a texel, columns from the left, rows from below.
using Painter = std::function<std::array<int, 3>(int, int)>;

struct Painting {
  int width, height;
  Painter painter;

  std::array<int, 3> texel(double x, double y) const {
    return painter(static_cast<int>(std::clamp(x, 0., width - 1.)),
                   static_cast<int>(std::clamp(y, 0., height - 1.)));
  }
};

Rgb linear(const std::array<int, 3>& bytes) {
  return {test::linear(bytes[0]), test::linear(bytes[1]), test::linear(bytes[2])};
}

/// Linear between the centres of texels; repeats.
Rgb colour(const Painting& painting, double u, double v) {
  const double x = (u - std::floor(u)) * painting.width - 0.5;
  const double y = (v - std::floor(v)) * painting.height - 0.5;
  const double left = std::floor(x), low = std::floor(y), s = x - left, t = y - low;
  const auto at = [&](double dx, double dy) { return linear(painting.texel(left + dx, low + dy)); };
  return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}

void write_painting(const Painting& painting, const std::filesystem::path& path) {
  Picture picture{painting.width, painting.height, 1, {}, {}};
  for (int row = painting.height - 1; row >= 0; --row)
    for (int column = 0; column < painting.width; ++column)
      for (const int byte : painting.painter(column, row))
        picture.pixels.push_back(static_cast<std::uint8_t>(byte));
  write_png(picture, path);
}

SceneFile read_painted(const Painting& painting, const std::string& obj, const std::string& mtl,
                       const std::string& json = "") {
  const TempDir folder;
  write_painting(painting, folder.path() / "lamp.png");
  folder.write("scene.mtl", "newmtl m\n" + mtl);
  const auto scene = folder.write("scene.obj", "mtllib scene.mtl\nusemtl m\n" + obj);
  if (json.empty()) return read_scene(scene);
  return read_scene(scene, folder.write("materials.json", json));
}

const std::string painted_square =
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string whole_picture = painted_square + "f 1/1 2/2 3/3 4/4\n";

const Painting two = {64, 64, [](int x, int) {
                        return x < 16 ? std::array{255, 0, 0} : std::array{0, 188, 255};
                      }};

const Painting noise = {64, 64, [](int x, int y) {
                          const int k = (x * 7919 + y * 104729 + x * y * 31) % 256;
                          return std::array{k, (k * 7) % 256, (k * 13) % 256};
                        }};

/// Smooth in both directions.
const Painting hills = {200, 150, [](int x, int y) {
                          const double z = std::sin(0.03 * x) * std::cos(0.04 * y);
                          const int byte = static_cast<int>(120 + 100 * z);
                          return std::array{byte, 255 - byte, 100};
                        }};

/// More texels than a grid has cells, in one direction.
const Painting many = {9000, 12, [](int x, int y) {
                         const int byte = 128 + static_cast<int>(100 * std::sin(x * x * 1e-6)) - y;
                         return std::array{byte, 40 + x % 200, 20 * y};
                       }};

/// From bright to a fifth of it, even in light.
const Painting ramp = {120, 2, [](int x, int) {
                         const double light = 1 - 0.8 * (x + 0.5) / 120;
                         const double byte = 1.055 * std::pow(light, 1 / 2.4) - 0.055;
                         const int k = static_cast<int>(std::lround(255 * byte));
                         return std::array{k, k, 90};
                       }};

double extent(const std::vector<Vec3>& corners, int axis, bool high) {
  double most = -HUGE_VAL;
  for (const Vec3& p : corners) most = std::max(most, high ? p[axis] : -p[axis]);
  return high ? most : -most;
}

Rgb power(const Scene& scene) {
  Rgb sum = Rgb::Zero();
  for (std::size_t f = 0; f < scene.faces.size(); ++f)
    sum += area_vector(face_corners(scene, static_cast<int>(f))).norm() *
           scene.materials[at(scene.faces[f].material)].exitance;
  return sum;
}

TEST(PaintedLights, TwoColoursAreTwoPieces) {
  const SceneFile file =
      read_painted(two, whole_picture + "f 1 2 4\n", "Kd .3 .3 .3\nKe 10 20 30\nmap_Ke lamp.png\n");
  EXPECT_THAT(file.warnings, ElementsAre(HasSubstr("have its colours alone")));
  const Scene& scene = file.scene;
  ASSERT_EQ(scene.faces.size(), 3U);
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.vertices.size(), 6U);
  EXPECT_EQ(scene.faces[1].vertices, (std::vector{0, 1, 3})) << "ids of others stay";
  const Material& left = scene.materials[at(scene.faces[0].material)];
  const Material& right = scene.materials[at(scene.faces[2].material)];
  EXPECT_EQ(left.name, "m, part 1");
  EXPECT_EQ(right.name, "m, part 2");
  EXPECT_LT((left.exitance - Rgb(10, 0, 0)).abs().maxCoeff(), 1e-6);
  EXPECT_LT((right.exitance - Rgb(0, 20 * test::linear(188), 30)).abs().maxCoeff(), 1e-6);
  EXPECT_EQ(right.rho[0], 0.3);
  EXPECT_NEAR(extent(face_corners(scene, 0), 0, true), 0.5, 1e-12);
  EXPECT_NEAR(extent(face_corners(scene, 2), 0, false), 0.5, 1e-12);
  EXPECT_EQ(scene.materials[at(scene.faces[1].material)].name, "m");
  EXPECT_EQ(scene.materials[at(scene.faces[1].material)].exitance[1], 20);
}

TEST(PaintedLights, OneColourLeavesAFaceAsItIs) {
  const Painting one = {300, 7, [](int, int) { return std::array{188, 100, 255}; }};
  const SceneFile file = read_painted(one, whole_picture, "Kd 0 0 0\nmap_Ke lamp.png\n");
  EXPECT_THAT(file.warnings, IsEmpty());
  ASSERT_EQ(file.scene.materials.size(), 1U);
  EXPECT_EQ(file.scene.materials[0].name, "m");
  EXPECT_LT((file.scene.materials[0].exitance - linear({188, 100, 255})).abs().maxCoeff(), 1e-6);
  ASSERT_EQ(file.scene.faces.size(), 1U);
  EXPECT_EQ(file.scene.faces[0].vertices, (std::vector{0, 1, 2, 3}));
  EXPECT_EQ(file.scene.vertices.size(), 4U);
}

/// A polygon in a tilted plane and the affine map of its picture.
struct Outline {
  const char* name;
  std::vector<Vec2> corners;
};

const std::vector<Outline> outlines = {
    {"triangle", {{0, 0}, {1.3, 0.2}, {0.4, 0.9}}},
    {"hexagon", {{1, 0}, {0.5, 0.8}, {-0.5, 0.8}, {-1, 0}, {-0.5, -0.8}, {0.5, -0.8}}},
    {"L", {{0, 0}, {1, 0}, {1, 0.4}, {0.4, 0.4}, {0.4, 1}, {0, 1}}},
    {"comb",
     {{0, 0},
      {1, 0},
      {1, 1},
      {0.8, 1},
      {0.8, 0.2},
      {0.6, 0.2},
      {0.5, 0.9},
      {0.4, 0.2},
      {0.2, 0.2},
      {0.2, 1},
      {0, 1}}}};

Vec3 in_space(const Vec2& q) {
  return Vec3(3, -2, 5) + q.x() * Vec3(0.6, 0.8, 0) + q.y() * Vec3(-0.64, 0.48, 0.6);
}

Vec2 in_picture(const Vec2& q) {
  return Vec2(0.13 + 0.7 * q.x() - 0.5 * q.y(), 0.27 + 0.4 * q.x() + 0.9 * q.y());
}

std::string as_obj(const Outline& outline) {
  std::string vertices, places, face = "f";
  for (std::size_t k = 0; k < outline.corners.size(); ++k) {
    const Vec3 p = in_space(outline.corners[k]);
    const Vec2 place = in_picture(outline.corners[k]);
    vertices += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
    places += fmt::format("vt {} {}\n", place.x(), place.y());
    face += fmt::format(" {0}/{0}", k + 1);
  }
  return vertices + places + face + "\n";
}

TEST(PaintedLights, HaveThePowerOfThePicture) {
  for (const Painting& painting : {two, hills, noise, many})
    for (const Outline& outline : outlines) {
      constexpr int count = 600;
      Rgb truth = Rgb::Zero();
      for (int i = 0; i < count; ++i)
        for (int k = 0; k < count; ++k) {
          const Vec2 q(-1 + 2.4 * (i + 0.5) / count, -1 + 2.4 * (k + 0.5) / count);
          if (!is_inside({&outline.corners, 1}, q)) continue;
          const Vec2 place = in_picture(q);
          truth += std::pow(2.4 / count, 2) * colour(painting, place.x(), place.y());
        }
      const SceneFile file =
          read_painted(painting, as_obj(outline), "Kd 0 0 0\nKe 5 6 7\nmap_Ke lamp.png\n");
      truth *= Rgb(5, 6, 7);
      EXPECT_LT(((power(file.scene) - truth) / truth).abs().maxCoeff(), 5e-3) << outline.name;
      // What is made sound covers what was there, once.
      double whole_area = 0;
      for (const Surface& surface : make_sound(file.scene).surfaces) whole_area += area(surface);
      std::vector<Vec3> corners;
      for (const Vec2& q : outline.corners) corners.push_back(in_space(q));
      EXPECT_NEAR(whole_area, area_vector(corners).norm(), 1e-9) << outline.name;
    }
}

/// Under a plate that hides a part of it, near and far.
TEST(PaintedLights, LightAsThePictureDoes) {
  const std::string plate = "usemtl n\nv .5 .2 .2\nv 1 .2 .2\nv 1 .6 .2\nv .5 .6 .2\nf 5 8 7 6\n";
  for (const auto& [painting, off] : {std::pair{ramp, 0.01}, {two, 0.01}, {hills, 0.02}}) {
    const std::string mtl = "Kd 0 0 0\nKe 10 10 10\nmap_Ke lamp.png\nnewmtl n\nKd 0 0 0\n";
    const SceneFile file = read_painted(painting, whole_picture + plate, mtl);
    const SoundScene pieces = make_sound(file.scene);
    const SoundScene face = make_sound(
        read_painted(painting, whole_picture + plate, mtl, R"({"m": {"exitance": 1}})").scene);
    const DirectLightIndex of_pieces(pieces), of_face(face);
    ASSERT_EQ(of_face.emitters().size(), 1U);
    EXPECT_GT(of_pieces.emitters().size(), 1U);
    for (const double x : {-0.3, 0.2, 0.7, 1.1, 2.5})
      for (const double z : {0.3, 1., 4.}) {
        const SurfacePoint point{{x, 0.4, z}, -Vec3::UnitZ()};
        const PaintedLight truth = painted_irradiance(
            of_face, face, point, of_face.emitters()[0],
            [&of = painting](const Vec3& p) -> Rgb { return 10 * colour(of, p.x() / 2, p.y()); },
            {1e-3});
        const Rgb found = of_pieces.irradiance(point).irradiance;
        EXPECT_LT((found - truth.irradiance).abs().maxCoeff(), off * truth.irradiance.maxCoeff())
            << x << ' ' << z << ": " << found.transpose() << " for "
            << truth.irradiance.transpose();
      }
  }
}

TEST(PaintedLights, KeepWhatElseTheFaceHas) {
  const SceneFile file = read_painted(two, "g a\n" + whole_picture + "g b\nf 1/1 3/3 4/4\n",
                                      "map_Kd -s 2 1 lamp.png\nKe 1 1 1\nmap_Ke lamp.png\n",
                                      R"({"a": {"two_sided": true}})");
  EXPECT_THAT(file.warnings, IsEmpty());
  const Scene& scene = file.scene;
  ASSERT_EQ(scene.faces.size(), 4U);
  for (std::size_t f = 0; f < 4; ++f) {
    const Face& face = scene.faces[f];
    const bool is_a = f == 0 || f == 2;
    EXPECT_EQ(scene.groups[at(face.group)], is_a ? "a" : "b");
    EXPECT_EQ(scene.materials[at(face.material)].two_sided, is_a);
    EXPECT_EQ(face.line, is_a ? 12 : 14);
    ASSERT_GE(face.paint, 0);
    for (const double x : {0.2, 0.7, 1.3, 1.8})
      EXPECT_LT((colour_at(scene.paints[at(face.paint)], {x, 0.5, 0}) - colour(two, x, 0.5))
                    .abs()
                    .maxCoeff(),
                1e-6);
  }
}

/// Chequers, of which no cut makes parts with different means.
TEST(PaintedLights, DarkPiecesAreNoEmitters) {
  const Painting chequers = {64, 64, [](int x, int y) {
                               const int byte = (x / 8 + y / 8) % 2 * 255;
                               return std::array{byte, byte, byte};
                             }};
  const SceneFile file =
      read_painted(chequers, whole_picture, "Kd .2 .2 .2\nKe 3 3 3\nmap_Ke lamp.png\n");
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_EQ(file.scene.faces.size(), 64U);
  ASSERT_EQ(file.scene.materials.size(), 2U);
  EXPECT_NEAR(file.scene.materials[0].exitance.sum() + file.scene.materials[1].exitance.sum(), 9,
              1e-6);
  EXPECT_EQ(DirectLightIndex(make_sound(file.scene)).emitters().size(), 32U);
}

TEST(PaintedLights, SayWhatTooFewPiecesLeaveOut) {
  const SceneFile file =
      read_painted(noise, whole_picture, "Kd 0 0 0\nKe 1 1 1\nmap_Ke lamp.png\n");
  EXPECT_EQ(file.scene.faces.size(), 64U);
  ASSERT_THAT(file.warnings,
              ElementsAre(HasSubstr("its 1 faces were cut into 64 pieces, at most 64 each")));
  EXPECT_THAT(file.warnings[0], HasSubstr("material 'm'"));
  // The same from the pieces.
  double squares = 0;
  Rgb mean = Rgb::Zero();
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const Vec2 place((x + 0.5) / 32, (y + 0.5) / 64);
      mean += linear(noise.painter(x, y)) / 4096;
      for (std::size_t f = 0; f < 64; ++f) {
        std::vector<Vec2> ring;
        for (const Vec3& p : face_corners(file.scene, static_cast<int>(f)))
          ring.emplace_back(p.x(), p.y());
        const Rgb& even = file.scene.materials[at(file.scene.faces[f].material)].exitance;
        if (is_inside({&ring, 1}, place))
          squares += (linear(noise.painter(x, y)) - even).square().sum() / 4096;
      }
    }
  const double uneven = std::sqrt(squares / mean.square().sum());
  EXPECT_GT(uneven, 0.1);
  EXPECT_THAT(file.warnings[0],
              HasSubstr(fmt::format("by up to {:.2g} % of its mean", 100 * uneven)));
}

TEST(PaintedLights, MayShowALineOrAPointOfThePicture) {
  const SceneFile point = read_painted(two, painted_square + "vt .1 .1\nf 1/5 2/5 3/5 4/5\n",
                                       "Kd 0 0 0\nmap_Ke lamp.png\n");
  ASSERT_EQ(point.scene.faces.size(), 1U);
  EXPECT_LT((point.scene.materials[0].exitance - Rgb(1, 0, 0)).abs().maxCoeff(), 1e-6);
  // Along the diagonal of the picture, which the face's x follows.
  const SceneFile line =
      read_painted(two, painted_square + "f 1/1 2/3 3/3 4/1\n", "Kd 0 0 0\nmap_Ke lamp.png\n");
  EXPECT_THAT(line.warnings, IsEmpty());
  EXPECT_EQ(line.scene.faces.size(), 2U);
  EXPECT_NEAR(extent(face_corners(line.scene, 0), 0, true), 0.5, 1e-9);
  // Far away, and again and again.
  const SceneFile many =
      read_painted(two, whole_picture, "Kd 0 0 0\nmap_Ke -s 1000 1000 -o 77.3 1e7 lamp.png\n");
  EXPECT_LT((power(many.scene) / 2 - Rgb(0.25, 0.75 * test::linear(188), 0.75)).abs().maxCoeff(),
            1e-3);
  const SceneFile far =
      read_painted(two, whole_picture, "Kd 0 0 0\nmap_Ke -s 1e300 -o 1e300 lamp.png\n");
  EXPECT_LT((power(far.scene) / 2 - Rgb(0.25, 0.75 * test::linear(188), 0.75)).abs().maxCoeff(),
            1e-3);
}

TEST(PaintedLights, AMaterialsFileOverridesThem) {
  const std::string mtl = "Kd 0 0 0\nKe 1 1 1\nmap_Ke lamp.png\n";
  const SceneFile even = read_painted(two, whole_picture, mtl, R"({"m": {"exitance": 3}})");
  EXPECT_EQ(even.scene.faces.size(), 1U);
  EXPECT_EQ(even.scene.materials[0].exitance[1], 3);
  EXPECT_THAT(even.warnings, IsEmpty());
  const SceneFile warm = read_painted(two, whole_picture, mtl, R"({"m": {"temperature": 300}})");
  EXPECT_EQ(warm.scene.faces.size(), 1U);
  EXPECT_THAT(warm.warnings, IsEmpty());
  EXPECT_EQ(
      read_painted(two, whole_picture, mtl, R"({"m": {"reflectance": 0.5}})").scene.faces.size(),
      2U);
}

TEST(PaintedLights, SayWhatIsNotDoneAsTheFileSays) {
  EXPECT_THAT(read_painted(two, whole_picture, "Kd 0 0 0\nKe 2 2 2\nmap_Ke none.png\n").warnings,
              ElementsAre(HasSubstr("the material 'm' has its Ke alone")));
  EXPECT_THAT(read_painted(two, whole_picture, "Kd 0 0 0\nKe 0 0 0\nmap_Ke lamp.png\n").warnings,
              ElementsAre(HasSubstr("it does not shine")));
  EXPECT_THAT(read_painted(two, painted_square + "vt .2 .9\nf 1/1 2/2 3/3 4/5\n",
                           "map_Kd lamp.png\nmap_Ke lamp.png\n")
                  .warnings,
              ElementsAre(HasSubstr("on 1 faces the picture is bent or warped")));
  const SceneFile heat =
      read_painted(two, whole_picture, "Ke 2 2 2\nmap_Ke lamp.png\nemissivity 1\n");
  EXPECT_THAT(heat.warnings, ElementsAre(HasSubstr("pictures are not used where bands")));
  EXPECT_EQ(heat.scene.materials[0].exitance[0], 2);
  test::expect_error([] { read_painted(two, whole_picture, "map_Ke lamp.png\ntemperature 300\n"); },
                     ErrorCode::invalid_input, {"contradict"});
  for (const char* wrong : {"map_Ke\n", "map_Ke -s lamp.png\n", "map_Ke scene.obj\n"})
    test::expect_error([&] { read_painted(two, whole_picture, wrong); }, ErrorCode::invalid_input,
                       {});
}

}  // namespace
}  // namespace halfshade
