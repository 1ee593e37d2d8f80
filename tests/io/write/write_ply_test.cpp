#include "io/write/write_result.h"
#include "tests/support/files.h"
#include "tests/support/sample_result.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>
#include <sstream>

namespace halfshade {
namespace {

#pragma pack(push, 1)
struct Vertex {
  float x, y, z;
  unsigned char red, green, blue;
  float r, g, b;
};
struct Triangle {
  unsigned char count;
  std::int32_t corners[3];
};
#pragma pack(pop)

struct Ply {
  std::vector<std::string> header;
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::size_t bytes_left = 0;

  bool says(const std::string& line) const {
    return std::find(header.begin(), header.end(), line) != header.end();
  }
};

/// Reads just what the header is expected to announce.
Ply parse(const std::string& bytes) {
  Ply ply;
  const std::size_t end = bytes.find("end_header\n") + 11;
  std::istringstream header(bytes.substr(0, end));
  std::size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(header, line);) {
    ply.header.push_back(line);
    std::sscanf(line.c_str(), "element vertex %zu", &vertices);
    std::sscanf(line.c_str(), "element face %zu", &faces);
  }
  ply.vertices.resize(vertices);
  ply.triangles.resize(faces);
  const std::size_t expected = vertices * sizeof(Vertex) + faces * sizeof(Triangle);
  EXPECT_EQ(bytes.size() - end, expected);
  if (bytes.size() - end != expected) return ply;
  std::memcpy(ply.vertices.data(), bytes.data() + end, vertices * sizeof(Vertex));
  std::memcpy(ply.triangles.data(), bytes.data() + end + vertices * sizeof(Vertex),
              faces * sizeof(Triangle));
  return ply;
}

Ply ply_of(const SolveResult& result, const Provenance& provenance = {"1.2.3", "solve it"}) {
  const test::TempDir folder;
  write_result(result, provenance, folder.path() / "a.ply");
  return parse(test::contents(folder.path() / "a.ply"));
}

TEST(WritePly, TheHeaderNamesWhatParaViewAndMeshLabLookFor) {
  const Ply ply = ply_of(test::sample_result(2));
  EXPECT_EQ(ply.header.at(0), "ply");
  EXPECT_EQ(ply.header.at(1), "format binary_little_endian 1.0");
  for (const char* line :
       {"property float x", "property float y", "property float z", "property uchar red",
        "property uchar green", "property uchar blue", "property float radiosity_r",
        "property float radiosity_g", "property float radiosity_b",
        "property list uchar int vertex_indices", "comment halfshade 1.2.3",
        "comment command line: solve it", "comment unit: cm"})
    EXPECT_TRUE(ply.says(line)) << line;
}

TEST(WritePly, HoldsTheMeshAndItsLight) {
  const SolveResult result = test::sample_result(3);
  const Ply ply = ply_of(result);
  ASSERT_EQ(ply.vertices.size(), 16U);
  ASSERT_EQ(ply.triangles.size(), 18U);
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(+ply.vertices[i].x, static_cast<float>(result.elements.points[i].x()));
    EXPECT_EQ(+ply.vertices[i].y, static_cast<float>(result.elements.points[i].y()));
  }
  for (std::size_t i = 0; i < 18; ++i) {
    EXPECT_EQ(+ply.triangles[i].count, 3);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(+ply.triangles[i].corners[k], result.elements.corners[i][k]);
  }
  // The corner (1, 0) belongs to one element, number 4.
  EXPECT_EQ(+ply.vertices[3].r, static_cast<float>(result.solution.radiosity(4, 0)));
  EXPECT_EQ(+ply.vertices[3].g, static_cast<float>(result.solution.radiosity(4, 1)));
  EXPECT_EQ(+ply.vertices[3].b, static_cast<float>(result.solution.radiosity(4, 2)));
}

TEST(WritePly, ColoursFollowTheStatedExposure) {
  SolveResult result = test::sample_result(2);
  result.solution.exitance.setZero();
  result.solution.radiosity = ChannelArray::Constant(8, 3, 4.0);
  result.solution.radiosity.col(1) = 2;
  result.solution.radiosity.col(2) = 0;
  const Ply ply = ply_of(result);
  double exposure = 0;
  for (const std::string& line : ply.header)
    std::sscanf(line.c_str(), "comment exposure: %lf", &exposure);
  EXPECT_DOUBLE_EQ(exposure, 0.2) << "a uniform scene comes out at 0.8";
  for (const Vertex& v : ply.vertices) {
    EXPECT_EQ(v.blue, 0);
    const auto linear = [](int code) { return std::pow((code / 255.0 + 0.055) / 1.055, 2.4); };
    EXPECT_NEAR(linear(v.green) / linear(v.red), 0.5, 0.02);
    EXPECT_GT(v.red, 200);
  }
}

TEST(WritePly, CommentsStayOnTheirLines) {
  const Ply ply = ply_of(test::sample_result(1), {"1\r\nelement vertex 9", "a\nend_header\nb"});
  EXPECT_TRUE(ply.says("comment command line: a end_header b"));
  EXPECT_EQ(ply.vertices.size(), 4U);
}

TEST(WritePly, AnInterruptedResultIsMarked) {
  SolveResult result = test::sample_result(1);
  const std::string mark = "comment interrupted: the solution is not complete";
  EXPECT_FALSE(ply_of(result).says(mark));
  result.interrupted = true;
  EXPECT_TRUE(ply_of(result).says(mark));
}

TEST(WritePly, ValuesBeyondSinglePrecisionAreCappedButPlacesAreNot) {
  SolveResult result = test::sample_result(1);
  result.solution.radiosity.setConstant(1e200);
  for (const Vertex& v : ply_of(result).vertices) EXPECT_TRUE(std::isfinite(v.r));
  result.elements.points[2] = {0, 1e50, 0};
  const test::TempDir folder;
  test::expect_error([&] { write_result(result, {}, folder.path() / "a.ply"); },
                     ErrorCode::unwritable, {"point 2", "1e+50", ".vtu"});
}

}  // namespace
}  // namespace halfshade
