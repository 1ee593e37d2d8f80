#include "io/picture/picture.h"
#include "io/read/read_scene.h"
#include "tests/support/files.h"

#include <vtkImageData.h>
#include <vtkImageWriter.h>
#include <vtkJPEGWriter.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <gmock/gmock.h>
#include <string>

namespace halfshade {
namespace {

using test::expect_error;
using test::TempDir;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string plain_square =
    "mtllib scene.mtl\nusemtl m\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const std::string whole_square = plain_square + "f 1/1 2/2 3/3 4/4\n";

/// Red and green above, blue and white below; sRGB.
void write_four(const std::filesystem::path& path) {
  Picture picture{2, 2, 1, {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}, {}};
  write_png(picture, path);
}

SceneFile read_pictured(const std::string& obj, const std::string& mtl,
                        const std::string& json = "") {
  const TempDir folder;
  write_four(folder.path() / "four.png");
  folder.write("scene.mtl", "newmtl m\n" + mtl);
  if (json.empty()) return read_scene(folder.write("scene.obj", obj));
  return read_scene(folder.write("scene.obj", obj), folder.write("materials.json", json));
}

Rgb colour(const Scene& scene, std::size_t face, const Vec3& p) {
  return colour_at(scene.paints.at(at(scene.faces.at(face).paint)), p);
}

TEST(ReadPictures, LieAsPlacesSay) {
  const SceneFile file = read_pictured(whole_square, "Kd .5 .6 .7\nmap_Kd four.png\n");
  EXPECT_THAT(file.warnings, IsEmpty());
  ASSERT_EQ(file.files.size(), 2U);
  EXPECT_EQ(file.files[1].filename(), "four.png");
  EXPECT_EQ(file.scene.materials[0].rho[1], 0.6);
  EXPECT_TRUE((colour(file.scene, 0, {0.5, 0.75, 0}) == Rgb(1, 0, 0)).all());
  EXPECT_TRUE((colour(file.scene, 0, {1.5, 0.75, 0}) == Rgb(0, 1, 0)).all());
  EXPECT_TRUE((colour(file.scene, 0, {0.5, 0.25, 0}) == Rgb(0, 0, 1)).all());
  EXPECT_TRUE((colour(file.scene, 0, {1.5, 0.25, 0}) == Rgb(1, 1, 1)).all());
}

TEST(ReadPictures, AreLinearInLight) {
  const TempDir folder;
  write_png({1, 1, 1, {188, 188, 188}, {}}, folder.path() / "four.png");
  folder.write("scene.mtl", "newmtl m\nmap_Kd four.png\n");
  const Scene scene = read_scene(folder.write("scene.obj", whole_square)).scene;
  EXPECT_NEAR(colour(scene, 0, {1, 0.5, 0})[0], 0.5029, 1e-4);
  EXPECT_EQ(scene.materials[0].rho[0], 1) << "no Kd: the picture alone";
}

/// Of one colour, in values of type `type` up to `most`.
void write_even(vtkImageWriter& writer, const std::array<double, 3>& colour, int type, double most,
                const std::filesystem::path& file) {
  vtkNew<vtkImageData> image;
  image->SetDimensions(16, 8, 1);
  image->AllocateScalars(type, 3);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 3; ++c)
        image->SetScalarComponentFromDouble(x, y, 0, c, most * colour[at(c)]);
  writer.SetFileName(file.c_str());
  writer.SetInputData(image);
  writer.Write();
}

void write_green(const std::filesystem::path& file) {
  vtkNew<vtkJPEGWriter> writer;
  write_even(*writer, {0, 1, 0}, VTK_UNSIGNED_CHAR, 255, file);
}

// Where the file does not say how they are coded; VTK's writer does not.
TEST(ReadPictures, TakeSixteenBitsAsEight) {
  const TempDir folder;
  const std::array<double, 3> shown = {0.2, 0.4, 0.8};
  folder.write("scene.mtl", "newmtl m\nmap_Kd even.png\n");
  const auto read = [&](int type, double most) {
    vtkNew<vtkPNGWriter> writer;
    write_even(*writer, shown, type, most, folder.path() / "even.png");
    return colour(read_scene(folder.write("scene.obj", whole_square)).scene, 0, {1, 0.5, 0});
  };
  const Rgb eight = read(VTK_UNSIGNED_CHAR, 255), sixteen = read(VTK_UNSIGNED_SHORT, 65535);
  EXPECT_NEAR(eight[1], 0.1329, 1e-4) << ".4 by the standard's curve";
  EXPECT_LT((eight - sixteen).abs().maxCoeff(), 1e-6);
}

TEST(ReadPictures, TakeJpegs) {
  const TempDir folder;
  write_green(folder.path() / "green.jpg");
  folder.write("scene.mtl", "newmtl m\nmap_Kd green.jpg\n");
  const Scene scene = read_scene(folder.write("scene.obj", whole_square)).scene;
  EXPECT_LT((colour(scene, 0, {1, 0.5, 0}) - Rgb(0, 1, 0)).abs().maxCoeff(), 0.01);
}

TEST(ReadPictures, TakeScaleAndOffset) {
  const SceneFile file =
      read_pictured(whole_square, "map_Kd -s 2 1 1 -o 0.5 -blendu on -mm 0 1 four.png\n");
  EXPECT_THAT(file.warnings, IsEmpty());
  // u from .5 to 2.5 and v from .5 to 1.5, again and again.
  EXPECT_TRUE((colour(file.scene, 0, {0.25, 0.25, 0}) == Rgb(0, 1, 0)).all());
  EXPECT_TRUE((colour(file.scene, 0, {0.75, 0.75, 0}) == Rgb(0, 0, 1)).all());
}

TEST(ReadPictures, NeighboursThatShareAMapShareAPaint) {
  const Scene scene =
      read_pictured(plain_square + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 4/1 3/2 2/3 1/4\n",
                    "map_Kd four.png\n")
          .scene;
  EXPECT_EQ(scene.faces[0].paint, scene.faces[1].paint);
  EXPECT_NE(scene.faces[0].paint, scene.faces[2].paint);
  EXPECT_EQ(scene.paints.size(), 2U);
  EXPECT_EQ(scene.paints[0].texture, scene.paints[1].texture);
}

TEST(ReadPictures, SayWhatIsNotDoneAsTheFileSays) {
  EXPECT_THAT(read_pictured(plain_square + "f 1 2 3 4\n", "map_Kd four.png\n").warnings,
              ElementsAre(HasSubstr("1 faces have a material with a picture, but no places")));
  EXPECT_THAT(
      read_pictured(plain_square + "vt .2 .9\nf 1/1 2/2 3/3 4/5\n", "map_Kd four.png\n").warnings,
      ElementsAre(HasSubstr("on 1 faces the picture is bent or warped")));
  EXPECT_THAT(read_pictured(whole_square, "Kd 1 1 1\nmap_Kd none.png\n").warnings,
              ElementsAre(HasSubstr("there is no picture 'none.png'")));
  EXPECT_THAT(read_pictured(whole_square, "map_Kd -clamp on four.png\n").warnings,
              ElementsAre(HasSubstr("-clamp is not used")));
  EXPECT_THAT(read_pictured(whole_square, "Kd .5 .5 .5\nmap_Kd four.png\n",
                            R"({"m": {"temperature": 300}})")
                  .warnings,
              ElementsAre(HasSubstr("pictures are not used where bands")));
}

TEST(ReadPictures, AMaterialsFileOverridesThem) {
  const SceneFile file =
      read_pictured(whole_square, "map_Kd four.png\n", R"({"m": {"reflectance": 0.25}})");
  EXPECT_EQ(file.scene.faces[0].paint, -1);
  EXPECT_EQ(file.scene.materials[0].rho[2], 0.25);
}

TEST(ReadPictures, PathsOfOtherMachinesAndSpacesDo) {
  const TempDir folder;
  write_four(folder.path() / "a wall.png");
  folder.write("scene.mtl", "newmtl m\nmap_Kd C:\\work\\pictures\\a wall.png\n");
  const SceneFile file = read_scene(folder.write("scene.obj", whole_square));
  EXPECT_THAT(file.warnings, IsEmpty());
  EXPECT_EQ(file.scene.faces[0].paint, 0);
}

/// Reads a scene whose picture has these bytes.
void read_picture(const std::string& name, const std::string& bytes) {
  const TempDir folder;
  folder.write(name, bytes);
  folder.write("scene.mtl", "newmtl m\nmap_Kd " + name + "\n");
  read_scene(folder.write("scene.obj", whole_square));
}

TEST(ReadPictures, DamagedOnesAreRefused) {
  const TempDir folder;
  write_four(folder.path() / "whole.png");
  write_green(folder.path() / "whole.jpg");
  for (const std::string name : {"whole.png", "whole.jpg"}) {
    const std::string bytes = test::contents(folder.path() / name);
    EXPECT_NO_THROW(read_picture(name, bytes));
    for (const std::string& damaged : {bytes.substr(0, bytes.size() / 2), bytes.substr(0, 20),
                                       std::string("no picture"), std::string(), "x" + bytes})
      expect_error([&] { read_picture(name, damaged); }, ErrorCode::invalid_input, {name});
  }
  for (const char* wrong : {"map_Kd\n", "map_Kd -s four.png\n", "map_Kd scene.obj\n"})
    expect_error([&] { read_pictured(whole_square, wrong); }, ErrorCode::invalid_input, {});
}

/// What is damaged inside may be seen or not, and nothing else happens.
TEST(ReadPictures, AnyByteMayBeAnother) {
  const TempDir folder;
  write_four(folder.path() / "whole.png");
  write_green(folder.path() / "whole.jpg");
  for (const std::string name : {"whole.png", "whole.jpg"}) {
    const std::string bytes = test::contents(folder.path() / name);
    for (std::size_t k = 0; k < bytes.size(); ++k)
      for (const char change : {'\1', '\x80', '\xff'}) {
        std::string damaged = bytes;
        damaged[k] = static_cast<char>(damaged[k] ^ change);
        try {
          read_picture(name, damaged);
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::invalid_input) << error.what();
        }
      }
  }
}

TEST(ReadPictures, OthersMayHavePlacesThatCannotBeRead) {
  const SceneFile file =
      read_pictured(plain_square + "vt x y\nvt\nf 1/5 2/6 3/99 4/-7\n", "Kd 1 1 1\n");
  EXPECT_THAT(file.warnings, IsEmpty());
}

}  // namespace
}  // namespace halfshade
