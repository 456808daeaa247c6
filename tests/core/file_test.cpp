#include "core/file.hpp"

#include <sys/stat.h>

#include <fstream>

#include "support/full_disk.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::HasSubstr;

TEST(WriteFile, ReplacesTheWholeContentAndLeavesNothingElse) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.json"), bytes("one\0two", 7);
  write_file(path, "something longer that was there before");
  write_file(path, bytes);
  EXPECT_EQ(read_file(path), bytes);
  EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteFile, KeepsALinkAndWritesWhatItPointsTo) {
  const test::TemporaryFolder folder;
  write_file(folder.file("target"), "old");
  std::filesystem::create_symlink(folder.file("target"), folder.file("link"));
  write_file(folder.file("link"), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(read_file(folder.file("target")), "new");
}

TEST(WriteFile, NamesAMissingFolderAndAFolder) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("missing/a.json");
  EXPECT_THAT(input_error([&] { write_file(path, "x"); }),
              AllOf(HasSubstr(path), HasSubstr("No such file"), HasSubstr("a folder that exists")));
  EXPECT_THAT(input_error([&] { write_file(folder.file(""), "x"); }), HasSubstr("is a folder"));
}

TEST(CheckWritable, SaysBeforeTheWorkWhatWriteFileWouldSayAfterIt) {
  const test::TemporaryFolder folder;
  check_writable("-");
  check_writable(folder.file("a.json"));
  EXPECT_EQ(folder.entries(), 0u);
  const std::string missing = folder.file("missing/a.json");
  EXPECT_EQ(input_error([&] { check_writable(missing); }),
            input_error([&] { write_file(missing, "x"); }));
  EXPECT_THAT(input_error([&] { check_writable(folder.file("")); }), HasSubstr("is a folder"));
}

TEST(WriteFile, SaysThatADiskIsFullAndKeepsWhatWasThere) {
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

TEST(WriteFile, SaysThatAFolderIsNotWritable) {
  if (::geteuid() == 0) {
    // root may write into any folder but those of the kernel
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

TEST(ReadFile, SaysWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(input_error([&] { read_file(folder.file("none")); }),
              HasSubstr("none cannot be read"));
  EXPECT_THAT(input_error([&] { read_file(folder.file("")); }), HasSubstr("is a folder"));
  std::ofstream(folder.file("empty")).flush();
  EXPECT_THAT(input_error([&] { read_file(folder.file("empty")); }), HasSubstr("is empty"));
  write_file(folder.file("large"), std::string((3U << 20) + 1, 'x'));
  EXPECT_THAT(input_error([&] { read_file(folder.file("large"), 3U << 20); }),
              HasSubstr("larger than the 3 MB"));
  EXPECT_THAT(input_error([&] { read_file("/dev/zero", 1U << 20); }),
              HasSubstr("larger than the 1 MB"));
}

}  // namespace
}  // namespace prostm
