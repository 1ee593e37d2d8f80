#include "io/files/seal.h"
#include "io/picture/picture.h"
#include "io/write/write_result.h"
#include "tests/support/files.h"
#include "tests/support/sample_result.h"

#include <gtest/gtest.h>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

/// Changes a file and seals it anew.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  EXPECT_NE(place, std::string::npos) << from;
  text.resize(text.rfind("<!--"));
  return detail::seal(text.replace(place, from.size(), to));
}

class ReadShaded : public testing::TestWithParam<const char*> {
 protected:
  std::string name() const { return std::string("a") + GetParam(); }
  /// The bytes of a file that can be read.
  std::string good() const {
    write_result(test::sample_result(3), {}, folder_.path() / name());
    return test::contents(folder_.path() / name());
  }
  void expect_rejected(const std::string& bytes, const std::string& part = "") const {
    const fs::path path = folder_.write(name(), bytes);
    test::expect_error([&] { read_shaded(path); }, ErrorCode::invalid_input, {path.string(), part});
  }

  test::TempDir folder_;
};

TEST_P(ReadShaded, GivesBackWhatWasWritten) {
  const ShadedMesh expected = shaded(test::sample_result(3));
  write_result(test::sample_result(3), {}, folder_.path() / name());
  const ShadedMesh actual = read_shaded(folder_.path() / name());
  EXPECT_EQ(actual.points, expected.points);
  EXPECT_EQ(actual.triangles, expected.triangles);
  EXPECT_EQ(actual.emits, expected.emits);
  ASSERT_EQ(actual.point_value.size(), expected.point_value.size());
  for (std::size_t i = 0; i < expected.point_value.size(); ++i)
    EXPECT_TRUE((actual.point_value[i] == expected.point_value[i]).all());
  ASSERT_EQ(actual.triangle_value.size(), expected.triangle_value.size());
  for (std::size_t i = 0; i < expected.triangle_value.size(); ++i)
    EXPECT_TRUE((actual.triangle_value[i] == expected.triangle_value[i]).all());
  ASSERT_EQ(actual.cameras.size(), 1U);
  EXPECT_EQ(actual.cameras[0].name, "above");
  EXPECT_EQ(actual.cameras[0].position, Vec3(0.5, 0.5, 3));
  EXPECT_EQ(actual.cameras[0].direction, Vec3(0, 0, -1));
  EXPECT_EQ(actual.cameras[0].up, Vec3(0, 1, 0));
}

TEST_P(ReadShaded, AFileCutOffAnywhereIsRejectedInSilence) {
  const std::string bytes = good();
  testing::internal::CaptureStderr();
  const std::size_t step = bytes.size() / 150;
  for (std::size_t size = 0; size < bytes.size() - 12; size += step)
    expect_rejected(bytes.substr(0, size));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(ReadShaded, AnyChangedByteIsNoticed) {
  const std::string bytes = good();
  testing::internal::CaptureStderr();
  for (std::size_t i = 0; i < 150; ++i) {
    std::string damaged = bytes;
    damaged[(i * 7919 + 31) % bytes.size()] ^= static_cast<char>(1 << (i % 7));
    expect_rejected(damaged, "damaged");
  }
  expect_rejected(bytes + "\n", "damaged");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(ReadShaded, WhatVtkCannotReadIsRejectedInSilence) {
  const std::string whole = good();
  const std::string xml = whole.substr(0, whole.rfind("<!--"));
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for (std::size_t size = 0; size < xml.size() - 12; size += xml.size() / 50)
    expect_rejected(detail::seal(xml.substr(0, size)));
  expect_rejected(detail::seal("<VTKFile type=\"ImageData\"></VTKFile>"));
  expect_rejected(detail::seal("hello"));
  expect_rejected(detail::seal(std::string(1000, '\0')));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(ReadShaded, AMissingArrayIsNamed) {
  expect_rejected(replaced(good(), "Name=\"exitance\"", "Name=\"other\""), "'exitance'");
  // The first "radiosity" of the file is the points'.
  expect_rejected(replaced(good(), "Name=\"radiosity\"", "Name=\"other\""), "'radiosity'");
}

TEST_P(ReadShaded, AMeshWithoutTrianglesIsRejected) {
  write_result(test::sample_result(0), {}, folder_.path() / name());
  test::expect_error([&] { read_shaded(folder_.path() / name()); }, ErrorCode::invalid_input,
                     {"no triangles"});
}

TEST_P(ReadShaded, AMissingFileAndAFolderAreNamed) {
  test::expect_error([&] { read_shaded(folder_.path() / "none.vtu"); }, ErrorCode::invalid_input,
                     {"none.vtu", "cannot be opened"});
  fs::create_directory(folder_.path() / "folder.vtu");
  test::expect_error([&] { read_shaded(folder_.path() / "folder.vtu"); }, ErrorCode::invalid_input,
                     {"folder.vtu", "folder"});
  test::expect_error([&] { read_shaded(folder_.write("a.ply", "ply")); }, ErrorCode::invalid_input,
                     {"a.ply", ".vtu"});
}

INSTANTIATE_TEST_SUITE_P(Formats, ReadShaded, testing::Values(".vtu", ".vtp"),
                         [](const auto& test) { return std::string(test.param + 1); });

}  // namespace
}  // namespace halfshade
