// Whatever the bytes, a reader gives a sound scene or an Error: no crash, no hang, nothing else
// thrown. Every mutation is reproducible.

#include "io/read/read_scene.h"
#include "meshing/core/error.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace halfshade {
namespace {

const std::string obj =
    "# room\nmtllib scene.mtl\no a\nv 0 0 0\nv 1 0.5e0 0\nv 1 1 0 1\nv -0 1 \\\n0\nvt 0 0\n"
    "usemtl m\nf 1 2//1 3/1/1 4/2\ng b\nf -1 -2 -3\n";
const std::string mtl = "newmtl m\nKd 0.5 0.25 1\nKe 1 2 3e0\nd 1\nmap_Kd a.png\n";
const std::string json =
    R"({"unit": "m", "materials": {"m": {"reflectance": 0.5}, "a": {"exitance": [1, 2, 3]}},
 "cameras": [{"name": "c", "position": [0, 0, 1], "target": [0, 0, 0], "vertical_fov": 40}]})";
const std::string off =
    "COFF\n4 2 0\n0 0 0 255\n1 0 0\n1 1 0\n0 1 0 # last\n4 0 1 2 3\n3 2 1 0 9\n";
const std::string ply_header_end =
    "element vertex 3\nproperty double x\nproperty float y\nproperty double z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";
const std::string ply_ascii =
    "ply\nformat ascii 1.0\ncomment c\n" + ply_header_end + "0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n";

std::string ply_binary() {
  std::string text = "ply\nformat binary_big_endian 1.0\n" + ply_header_end;
  const std::string zero(8, '\0'), one("\x3F\xF0\0\0\0\0\0\0", 8);
  const std::string zero_float(4, '\0'), one_float("\x3F\x80\0\0", 4);
  text += zero + zero_float + zero + one + zero_float + zero + one + one_float + zero;
  return text + std::string("\3\0\0\0\0\0\0\0\1\0\0\0\2", 13);
}

/// A few random changes: bytes set, bits flipped, pieces cut, repeated or replaced by hard cases.
std::string mutated(std::string bytes, std::mt19937& random) {
  static const std::vector<std::string> hard_cases = {
      "-1", "0",    "1e999", "nan",    "99999999999999999999", "4294967295",
      "\n", "\\\n", "/",     "#",      std::string(1, '\0'),   "\xFF\xFE",
      "-",  "+",    ".",     "1e-999", "2147483648",           "{",
      "[",  "\"",   ","};
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t change = 0, count = 1 + below(3); change < count; ++change) {
    const std::size_t at = below(bytes.size() + 1);
    const std::size_t length = below(std::min<std::size_t>(8, bytes.size() - at) + 1);
    switch (random() % 6) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes.erase(at, length);
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(bytes.size() + 1), below(20)));
        break;
      case 3:
        bytes.replace(at, length, hard_cases[below(hard_cases.size())]);
        break;
      default:
        if (at < bytes.size())
          bytes[at] = static_cast<char>(random() % 2 == 0 ? random() % 256
                                                          : static_cast<unsigned char>(bytes[at]) ^
                                                                (1U << (random() % 8)));
    }
  }
  return bytes;
}

struct Seed {
  const char* name;
  std::string scene;    ///< file that is read
  std::string file;     ///< file that is changed
  std::string content;  ///< of that file
  int runs;
};

void PrintTo(const Seed& seed, std::ostream* out) { *out << seed.name; }

class ReadMutated : public testing::TestWithParam<Seed> {};

TEST_P(ReadMutated, GivesASoundSceneOrAnError) {
  const Seed& seed = GetParam();
  const test::TempDir folder;
  folder.write("scene.mtl", mtl);
  folder.write("scene.obj", obj);
  const auto scene = folder.path() / seed.scene;
  folder.write(seed.file, seed.content);
  ASSERT_NO_THROW(read_scene(scene)) << "the seed itself";
  std::mt19937 random(7);
  int sound = 0, refused = 0;
  for (int run = 0; run < seed.runs; ++run) {
    const std::string bytes = mutated(seed.content, random);
    folder.write(seed.file, bytes);
    try {
      validate(read_scene(scene).scene);
      ++sound;
    } catch (const Error& error) {
      ++refused;
      EXPECT_FALSE(error.place().empty());
      EXPECT_LT(std::string(error.what()).size(), 1000U);
    } catch (const std::exception& other) {
      ADD_FAILURE() << "run " << run << ": " << other.what() << "\n" << bytes;
    }
  }
  // Both outcomes occur, or the mutations would try too little.
  EXPECT_GT(sound, seed.runs / 100);
  EXPECT_GT(refused, seed.runs / 100);
}

INSTANTIATE_TEST_SUITE_P(Formats, ReadMutated,
                         testing::Values(Seed{"Obj", "scene.obj", "scene.obj", obj, 1500},
                                         Seed{"Mtl", "scene.obj", "scene.mtl", mtl, 1000},
                                         Seed{"Sidecar", "scene.obj", "scene.json", json, 1000},
                                         Seed{"Off", "scene.off", "scene.off", off, 1500},
                                         Seed{"PlyText", "scene.ply", "scene.ply", ply_ascii, 1500},
                                         Seed{"PlyBinary", "scene.ply", "scene.ply", ply_binary(),
                                              3000}),
                         [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace halfshade
