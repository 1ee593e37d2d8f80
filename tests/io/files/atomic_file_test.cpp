#include "io/files/atomic_file.h"

#include "meshing/core/error.h"
#include "tests/support/files.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <vector>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, ReplacesTheWholeFile) {
  const test::TempDir folder;
  const fs::path target = folder.write("a.txt", "something longer than what follows");
  const std::string bytes("new\0bytes\n", 10);
  write_atomically(target, bytes);
  EXPECT_EQ(test::contents(target), bytes);
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, WritesAFileLargerThanAnyBuffer) {
  const test::TempDir folder;
  std::string bytes(9000001, 'x');
  bytes.back() = 'y';
  write_atomically(folder.path() / "large", bytes);
  EXPECT_EQ(test::contents(folder.path() / "large"), bytes);
}

TEST(AtomicFile, TheTemporaryLiesBesideTheTargetWithItsExtension) {
  const test::TempDir folder;
  const fs::path target = folder.path() / "a.tar.vtu";
  fs::path seen;
  write_atomically(target, [&](const fs::path& path) {
    seen = path;
    EXPECT_TRUE(fs::is_empty(path));
    EXPECT_FALSE(fs::exists(target)) << "nothing must appear before it is whole";
  });
  EXPECT_EQ(seen.parent_path(), target.parent_path());
  EXPECT_EQ(seen.extension(), ".vtu");
  EXPECT_NE(seen, target);
  EXPECT_TRUE(fs::exists(target));
}

TEST(AtomicFile, TwoWritersOfOneFileDoNotShareATemporary) {
  const test::TempDir folder;
  const fs::path target = folder.path() / "a.txt";
  write_atomically(target, [&](const fs::path& outer) {
    write_atomically(target, [&](const fs::path& inner) { EXPECT_NE(inner, outer); });
  });
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, AFailingWriterLeavesTheOldFileAndNothingElse) {
  const test::TempDir folder;
  const fs::path target = folder.write("a.txt", "old");
  const auto fail = [](const fs::path& path) {
    std::ofstream(path) << "half of the n";
    throw std::runtime_error("in the middle");
  };
  EXPECT_THROW(write_atomically(target, fail), std::runtime_error);
  EXPECT_EQ(test::contents(target), "old");
  EXPECT_EQ(entries(folder.path()), 1U);
}

TEST(AtomicFile, FilesThatBelongTogetherAreAllReplacedOrNone) {
  const test::TempDir folder;
  const fs::path a = folder.write("a.mtx", "old a"), b = folder.write("b.csv", "old b");
  const fs::path taken = folder.path() / "taken";
  fs::create_directory(taken);
  const auto write = [](const fs::path& first, const fs::path& second) {
    const std::vector<FileBytes> both = {{first, "new a"}, {second, "new b"}};
    write_together(both);
  };
  EXPECT_THROW(write(a, taken), Error);
  EXPECT_THROW(write(taken, b), Error);
  EXPECT_EQ(test::contents(a), "old a");
  EXPECT_EQ(test::contents(b), "old b");
  EXPECT_EQ(entries(folder.path()), 3U);
  write(a, b);
  EXPECT_EQ(test::contents(a), "new a");
  EXPECT_EQ(test::contents(b), "new b");
}

TEST(AtomicFile, NewFilesGetTheUsualPermissions) {
  const test::TempDir folder;
  const fs::path usual = folder.write("usual", "");
  write_atomically(folder.path() / "ours", "");
  struct stat expected {};
  struct stat actual {};
  ASSERT_EQ(stat(usual.c_str(), &expected), 0);
  ASSERT_EQ(stat((folder.path() / "ours").c_str(), &actual), 0);
  EXPECT_EQ(actual.st_mode, expected.st_mode);
}

TEST(AtomicFile, ALinkStaysALink) {
  const test::TempDir folder;
  const fs::path file = folder.write("file", "old");
  fs::create_symlink("file", folder.path() / "link");
  write_atomically(folder.path() / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(test::contents(file), "new");
}

TEST(AtomicFile, ATargetThatCannotBeWrittenIsNamedWithTheReason) {
  const test::TempDir folder;
  const fs::path file = folder.write("file", "old");
  const struct {
    fs::path target;
    std::string reason;
  } cases[] = {{folder.path() / "none" / "a.vtu", "No such file or directory"},
               {file / "a.vtu", "Not a directory"},
               {folder.path(), "Is a directory"},
               {folder.path() / "", "Is a directory"},
               {"/proc/a.vtu", "No such file or directory"},
               {"/dev/full", "No space left on device"},
               {folder.path() / std::string(300, 'n'), "File name too long"},
               {"", "No such file or directory"}};
  for (const auto& c : cases)
    test::expect_error([&] { write_atomically(c.target, "bytes"); }, ErrorCode::unwritable,
                       {c.target.string(), "cannot be written", c.reason});
  EXPECT_EQ(entries(folder.path()), 1U);
  EXPECT_EQ(test::contents(file), "old");
}

TEST(AtomicFile, ADeviceIsWrittenAndStaysADevice) {
  write_atomically("/dev/null", "bytes");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace halfshade
