#include "prostm/core/file/file.hpp"

#include <sys/stat.h>

#include <fstream>

#include "prostm/core/file/file_kind.hpp"
#include "support/full_disk.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::HasSubstr;

TEST(WriteFile, ReplacesTheWholeContentAndLeavesNoOtherFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json"), bytes("one\0two", 7);
  write_file(path, "something longer that was there before");
  write_file(path, bytes);
  EXPECT_EQ(read_file(path), bytes);
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteFile, KeepsALinkAndWritesItsTarget) {
  const test::TemporaryFolder folder;
  write_file(folder.file("target"), "old");
  std::filesystem::create_symlink(folder.file("target"), folder.file("link"));
  write_file(folder.file("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(read_file(folder.file("target")), "new");
}

TEST(WriteFile, ReportsAMissingFolderAndAFolder) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("missing/a.json");
  EXPECT_THAT(input_error([&] { write_file(path, "x"); }),
              AllOf(HasSubstr(path), HasSubstr("No such file"), HasSubstr("a folder that exists")));
  EXPECT_THAT(input_error([&] { write_file(folder.file(""), "x"); }), HasSubstr("is a folder"));
}

TEST(CheckWritable, ReportsInAdvanceWhatWriteFileWouldReport) {
  const test::TemporaryFolder folder;
  check_writable("-");
  check_writable(folder.file("a.json"));
  EXPECT_EQ(folder.entries(), 0u);
  const std::string missing = folder.file("missing/a.json");
  EXPECT_EQ(input_error([&] { check_writable(missing); }),
            input_error([&] { write_file(missing, "x"); }));
  EXPECT_THAT(input_error([&] { check_writable(folder.file("")); }), HasSubstr("is a folder"));
}

TEST(WriteFile, ReportsAFullDiskAndKeepsTheOldContent) {
  EXPECT_THAT(input_error([] { write_file("/dev/full", "x"); }), HasSubstr("No space left"));

  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json");
  write_file(path, "old");
  std::string sentence;
  {
    const test::FullDisk disk(1000);
    sentence = input_error([&] { write_file(path, std::string(5000, 'x')); });
  }
  EXPECT_THAT(sentence, AllOf(HasSubstr(path), HasSubstr("File too large")));
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteFile, ReportsAFolderThatIsNotWritable) {
  if (::geteuid() == 0) {
    // root may write into any folder except the kernel's
    EXPECT_THAT(input_error([] { write_file("/proc/prostm", "x"); }),
                HasSubstr("cannot be written"));
    return;
  }
  const test::TemporaryFolder folder;
  ::chmod(folder.file("").c_str(), 0500);
  EXPECT_THAT(input_error([&] { write_file(folder.file("a"), "x"); }),
              HasSubstr("Permission denied"));
  ::chmod(folder.file("").c_str(), 0700);
}

TEST(ReadFile, ReportsFilesThatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(input_error([&] { read_file(folder.file("none")); }),
              HasSubstr("none cannot be read: there is no such file"));
  EXPECT_THAT(input_error([&] { read_file(folder.file("gone/none")); }),
              HasSubstr("none cannot be read: there is no folder " + folder.file("gone")));
  EXPECT_THAT(input_error([&] { read_file(folder.file("")); }), HasSubstr("is a folder"));
  std::ofstream(folder.file("empty")).flush();
  EXPECT_THAT(input_error([&] { read_file(folder.file("empty")); }), HasSubstr("is empty"));
  EXPECT_EQ(read_file(folder.file("empty"), 1, Empty::Allowed), "");
  write_file(folder.file("large"), std::string((3U << 20) + 1, 'x'));
  EXPECT_THAT(input_error([&] { read_file(folder.file("large"), 3U << 20); }),
              HasSubstr("larger than the 3 MB"));
  // a file of the kernel, which does not report its size
  EXPECT_THAT(input_error([&] { read_file("/proc/self/maps", 10); }), HasSubstr("larger than"));
}

TEST(KindByContent, RecognisesFilesThatAreOftenConfused) {
  EXPECT_THAT(kind_by_content(std::string("\x89HDF\r\n\x1a\n and more")), HasSubstr("HDF5 file"));
  EXPECT_EQ(kind_by_content("\x89PNG\r\n\x1a\n"), "a PNG picture");
  EXPECT_THAT(kind_by_content("\x93NUMPY\x01"), HasSubstr("NPY"));
  EXPECT_EQ(kind_by_content("\n {\"format\": 1}"), "JSON");
  for (const char* other : {"", "   ", "1 2 3", "[plan]", "\x89PNG"})
    EXPECT_EQ(kind_by_content(other), "");
}

TEST(IsNot, NamesTheDetectedKind) {
  EXPECT_EQ(is_not("\x93NUMPY\x01", "a PNG picture"), "is an NPY file, not a PNG picture");
  EXPECT_EQ(is_not("\x93NUMPY\x01", "an NPY file"), "is not an NPY file");
  EXPECT_EQ(is_not("1 2 3", "JSON"), "is not JSON");
}

TEST(ReadFile, RejectsPipesAndDevicesWithoutBlocking) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero")}) {
    EXPECT_THAT(input_error([&] { read_file(path); }),
                AllOf(HasSubstr(path), HasSubstr("ordinary file")));
    EXPECT_THAT(input_error([&] { check_readable(path); }), HasSubstr("ordinary file"));
  }
}

TEST(WriteFile, KeepsAProtectedFileEvenForRoot) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json");
  write_file(path, "old");
  std::filesystem::create_symlink(path, folder.file("link"));
  ::chmod(path.c_str(), 0444);
  for (const std::string& name : {path, folder.file("link")}) {
    EXPECT_THAT(input_error([&] { write_file(name, "new"); }),
                AllOf(HasSubstr(name), HasSubstr("protected (mode 444)")));
    EXPECT_THAT(input_error([&] { check_writable(name); }), HasSubstr("protected"));
  }
  EXPECT_EQ(read_file(path), "old");
}

TEST(WriteFile, CreatesTheTargetOfALink) {
  const test::TemporaryFolder folder;
  std::filesystem::create_symlink("target", folder.file("link"));
  write_file(folder.file("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(read_file(folder.file("target")), "new");
}

TEST(SameFile, IsRecognisedByAnyNameEvenBeforeItExists) {
  const test::TemporaryFolder folder;
  const std::string a = folder.file("a"), b = folder.file("b"), c = folder.file("c");
  write_file(a, "x");
  write_file(b, "x");
  std::filesystem::create_directory(folder.file("inner"));
  std::filesystem::create_hard_link(a, folder.file("hard"));
  std::filesystem::create_symlink(a, folder.file("soft"));
  std::filesystem::create_symlink("c", folder.file("to c"));
  std::filesystem::create_directory_symlink(folder.file(""), folder.file("here"));
  for (const char* other : {"a", "./a", "inner/../a", "hard", "soft", "here/a", "here/here/soft"})
    EXPECT_TRUE(is_same_file(a, folder.file(other))) << other;
  for (const char* other : {"c", "./c", "inner/../c", "to c", "here/c", "here/to c"})
    EXPECT_TRUE(is_same_file(c, folder.file(other))) << other;
  for (const char* other : {"b", "c", "inner/a", "missing/a"})
    EXPECT_FALSE(is_same_file(a, folder.file(other))) << other;
  EXPECT_FALSE(is_same_file(c, folder.file("inner/c")));
  EXPECT_FALSE(is_same_file("/dev/null", "/dev/null"));
}

}  // namespace
}  // namespace prostm
