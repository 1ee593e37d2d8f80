// Whatever the bytes, a reader gives what it reads or an Error: no crash, no hang, no memory beyond
// what small files need, nothing else thrown. Every mutation is reproducible. The long run, with
// sanitizers, for the given time a format and from another seed:
//   cmake --preset asan && cmake --build --preset asan --target io_tests
//   export ASAN_OPTIONS=detect_leaks=0 HALFSHADE_FUZZ_SECONDS=60 HALFSHADE_FUZZ_SEED=8
//   build/asan/tests/io_tests --gtest_filter='*ReadMutated*'

#include "io/files/little_endian.h"
#include "io/read/read_factors.h"
#include "io/read/read_points.h"
#include "io/read/read_scene.h"
#include "meshing/core/error.h"
#include "tests/support/assimp_samples.h"
#include "tests/support/files.h"
#include "tests/support/fuzz_settings.h"
#include "tests/support/gltf_samples.h"
#include "tests/support/msh_bytes.h"
#include "tests/support/mutator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

constexpr int seconds_for_one = 10;
/// What a format adds to the most that the program ever had: no more with sanitizers, which keep
/// what is freed for a while.
constexpr long most_growth_kb = 500'000;

const std::string fuzzed_obj =
    "# room\nmtllib scene.mtl\no a\nv 0 0 0\nv 1 0.5e0 0\nv 1 1 0 1\nv -0 1 \\\n0\nvt 0 0\n"
    "usemtl m\nf 1 2//1 3/1/1 4/2\ng b\nf -1 -2 -3\n";
const std::string fuzzed_mtl = "newmtl m\nKd 0.5 0.25 1\nKe 1 2 3e0\nd 1\nmap_Kd a.png\n";
const std::string sidecar =
    R"({"unit": "m", "materials": {"m": {"reflectance": 0.5}, "a": {"exitance": [1, 2, 3]}},
 "cameras": [{"name": "c", "position": [0, 0, 1], "target": [0, 0, 0], "vertical_fov": 40}]})";
const std::string cameras =
    R"({"cameras": [{"name": "c", "position": [0, 0, 1], "target": [0, 0, 0]},
 {"name": "d", "position": [0, -2e1, 1], "direction": [0, 1, 0], "up": [0, 0, 1],
  "vertical_fov": 40.5}]})";
const std::string materials =
    R"({"m": {"reflectance": [0.5, 0.25, 1], "two_sided": true},
 "a": {"exitance": 3.5e2, "reflectance": 0}})";
const std::string off =
    "COFF\n4 2 0\n0 0 0 255\n1 0 0\n1 1 0\n0 1 0 # last\n4 0 1 2 3\n3 2 1 0 9\n";
const std::string ply_header_end =
    "element vertex 3\nproperty double x\nproperty float y\nproperty double z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";
const std::string ply_ascii =
    "ply\nformat ascii 1.0\ncomment c\n" + ply_header_end + "0 0 0\n1 0 0\n1 1 0\n3 0 1 2\n";
const std::string stl =
    "solid a b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0.5\n"
    "endloop\nendfacet\nendsolid\n";
const std::string vs3 =
    "T t\nF 3\n! # x y z\nV 1 0 0 0\nV 2 1 0 0\nV 3 1 1 0.\nV 4 0 1 0\n"
    "S 1 1 2 3 4 0 0 0.9 a\nS 2 3 2 1 0 0 1 .5 b ! c\nO 3 4 3 1 0\nE\n";
const std::string msh =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n1\n2 1 \"a b\"\n$EndPhysicalNames\n"
    "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 1 0\n$EndEntities\n"
    "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n2 3 1 3\n2 1 3 1\n1 1 2 3 4\n2 1 2 2\n2 1 2 3\n3 4 3 1\n$EndElements\n";
const std::string msh_2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
    "$EndNodes\n$Elements\n3\n1 1 2 0 1 1 2\n2 3 2 1 1 1 2 3 4\n3 2 2 2 1 3 2 1\n$EndElements\n";
const std::string heat =
    R"({"bands": [{"name": "a", "wavelengths_um": [0, 3e0]}, {"name": "b", "wavelengths_um": [3, null]}],
 "m": {"emissivity": [0.5, 0.25], "temperature": 300.5}, "a": {"exitance": [1, 2]}})";
const std::string heat_mtl = "newmtl m\nemissivity 0.25\ntemperature 3e2\nnewmtl n\nnet_flux 0\n";
const std::string grey_mtl = "newmtl m\nKd 0.5\n";
const std::string factors =
    "%%MatrixMarket matrix coordinate real general\n% c\n2 2 2\n1 2 0.25\n2 1 5e-1\n";
const std::string factor_names =
    "# c\nsurface,area,space,row_sum,error\nface 1,2,0.75,1,1e-9\n\"face 2\",1,0.5,1,0\n";
const std::string points = "id;x;y;z;nx;ny;nz\n# two\na;1;2;3e0;0;0;1\nb;-0.5;2;3;1;-1;0\n";

std::string ply_binary() {
  std::string text = "ply\nformat binary_big_endian 1.0\n" + ply_header_end;
  const std::string zero(8, '\0'), one("\x3F\xF0\0\0\0\0\0\0", 8);
  const std::string zero_float(4, '\0'), one_float("\x3F\x80\0\0", 4);
  text += zero + zero_float + zero + one + zero_float + zero + one + one_float + zero;
  return text + std::string("\3\0\0\0\0\0\0\0\1\0\0\0\2", 13);
}

std::string stl_binary() {
  std::string bytes(80, ' ');
  detail::put(bytes, std::uint32_t{1});
  for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.5F})
    detail::put(bytes, x);
  return bytes + std::string(2, '\0');
}

struct Seed {
  const char* name;
  std::string scene;    ///< file that is read
  std::string file;     ///< file that is changed
  std::string content;  ///< of that file
  int runs;
};

void PrintTo(const Seed& seed, std::ostream* out) { *out << seed.name; }

class ReadMutated : public testing::TestWithParam<Seed> {
 protected:
  ReadMutated() {
    folder_.write("scene.mtl", GetParam().content == heat ? grey_mtl : fuzzed_mtl);
    folder_.write("f.mtx", factors);
    folder_.write("f.names.csv", factor_names);
    folder_.write("scene.obj", fuzzed_obj);
    folder_.write(GetParam().file, GetParam().content);
  }

  void read() const {
    const fs::path path = folder_.path() / GetParam().scene;
    if (path.extension() == ".csv") {
      read_points(path);
    } else if (path.extension() == ".mtx") {
      read_factors(path);
    } else {
      const bool has_materials = GetParam().file == "materials.json";
      validate(
          read_scene(path, has_materials ? folder_.path() / GetParam().file : fs::path()).scene);
    }
  }

  /// Counts what came of it.
  void read_mutated(const std::string& bytes) {
    folder_.write(GetParam().file, bytes);
    test::watch_run(sound_ + refused_, seconds_for_one);
    try {
      read();
      ++sound_;
    } catch (const Error& error) {
      ++refused_;
      EXPECT_FALSE(error.place().empty());
      EXPECT_LT(std::string(error.what()).size(), 1000U) << error.what();
    } catch (const std::exception& other) {
      ADD_FAILURE() << other.what() << "\n" << bytes;
    }
    test::watch_run(0, 0);
  }

  test::TempDir folder_;
  int sound_ = 0, refused_ = 0;
};

/// kB.
long most_memory_so_far() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

TEST_P(ReadMutated, GivesWhatItReadsOrAnError) {
  const long before = most_memory_so_far();  // other tests may have run in the same program
  ASSERT_NO_THROW(read()) << "the seed itself";
  const test::FuzzTime time;
  test::Mutator mutated(static_cast<unsigned>(test::fuzz_seed(7)));
  int runs = 0;
  for (; runs < GetParam().runs || time.goes_on(); ++runs)
    read_mutated(mutated(GetParam().content));
  // Both outcomes occur, or the mutations would try too little.
  EXPECT_GT(sound_, runs / 100);
  EXPECT_GT(refused_, runs / 100);
  EXPECT_LE(most_memory_so_far() - before, most_growth_kb);
}

INSTANTIATE_TEST_SUITE_P(
    Formats, ReadMutated,
    testing::Values(Seed{"Obj", "scene.obj", "scene.obj", fuzzed_obj, 1500},
                    Seed{"Mtl", "scene.obj", "scene.mtl", fuzzed_mtl, 1000},
                    Seed{"Sidecar", "scene.obj", "scene.json", sidecar, 1000},
                    Seed{"Cameras", "scene.obj", "scene.json", cameras, 1000},
                    Seed{"Materials", "scene.obj", "materials.json", materials, 1000},
                    Seed{"Heat", "scene.obj", "materials.json", heat, 1000},
                    Seed{"HeatMtl", "scene.obj", "scene.mtl", heat_mtl, 1000},
                    Seed{"Factors", "f.mtx", "f.mtx", factors, 1000},
                    Seed{"FactorNames", "f.mtx", "f.names.csv", factor_names, 1000},
                    Seed{"Off", "scene.off", "scene.off", off, 1500},
                    Seed{"PlyText", "scene.ply", "scene.ply", ply_ascii, 1500},
                    Seed{"PlyBinary", "scene.ply", "scene.ply", ply_binary(), 3000},
                    Seed{"StlText", "scene.stl", "scene.stl", stl, 1500},
                    Seed{"StlBinary", "scene.stl", "scene.stl", stl_binary(), 1500},
                    Seed{"Vs3", "scene.vs3", "scene.vs3", vs3, 1500},
                    Seed{"Msh", "scene.msh", "scene.msh", msh, 1500},
                    Seed{"Msh2", "scene.msh", "scene.msh", msh_2, 1500},
                    Seed{"MshBinary", "scene.msh", "scene.msh", test::msh_binary_4(false), 1500},
                    Seed{"MshBinary2", "scene.msh", "scene.msh", test::msh_binary_2(true), 1500},
                    Seed{"Gltf", "scene.gltf", "scene.gltf", test::gltf_triangle().dump(1), 1500},
                    Seed{"Glb", "scene.glb", "scene.glb", test::as_glb(test::gltf_triangle()),
                         1500},
                    Seed{"Collada", "scene.dae", "scene.dae", test::collada("Y_UP", "1"), 500},
                    Seed{"ThreeDs", "scene.3ds", "scene.3ds", test::three_ds(), 500},
                    Seed{"Points", "points.csv", "points.csv", points, 1500}),
    [](const auto& param) { return param.param.name; });

}  // namespace
}  // namespace halfshade
