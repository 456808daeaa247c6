#include "prostm/study/session/response_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "prostm/core/file/file.hpp"
#include "prostm/core/random.hpp"
#include "support/full_disk.hpp"
#include "support/input_errors.hpp"
#include "support/no_locks.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;

ResponseLine line_of(int i) {
  return {{"kind", "trial"}, {"trial", i}, {"text", std::string(static_cast<std::size_t>(i), 'x')}};
}

std::string written(const std::string& path, int lines) {
  ResponseFile file(path);
  for (int i = 1; i <= lines; ++i) file.append(line_of(i));
  return read_file(path);
}

void put(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

TEST(ResponseFile, ContinuesWhereItEnded) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.jsonl");
  written(path, 3);
  {
    ResponseFile file(path);
    ASSERT_EQ(file.lines().size(), 3U);
    EXPECT_EQ(file.lines()[1], line_of(2));
    EXPECT_FALSE(file.found_cut_off());
    file.append(line_of(4));
  }
  const auto lines = responses_from_text(read_file(path), path);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[3], line_of(4));
}

TEST(ResponseFile, TruncationLosesAtMostTheLastLine) {
  const test::TemporaryFolder folder;
  const std::string whole = written(folder.file("whole.jsonl"), 4);
  const std::string path = folder.file("a.jsonl");
  for (std::size_t size = 0; size <= whole.size(); size += 3) {
    put(path, whole.substr(0, size));
    std::filesystem::remove(path + ".cut-off");
    const auto complete = static_cast<std::size_t>(
        std::count(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size), '\n'));
    {
      ResponseFile file(path);
      ASSERT_EQ(file.lines().size(), complete);
      const std::size_t ends = complete == 0 ? 0 : whole.substr(0, size).rfind('\n') + 1;
      ASSERT_EQ(file.found_cut_off(), ends < size);
      if (ends < size) {
        ASSERT_EQ(read_file(path + ".cut-off"), whole.substr(ends, size - ends) + "\n");
      }
      for (std::size_t i = complete; i < 4; ++i) file.append(line_of(static_cast<int>(i) + 1));
    }
    ASSERT_EQ(read_file(path), whole);
  }
}

TEST(ResponseFile, DetectsEveryChangedByte) {
  const test::TemporaryFolder folder;
  const std::string whole = written(folder.file("whole.jsonl"), 3);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    for (const char other : {'0', 'x', '\n', ' '}) {
      if (whole[at] == other) continue;
      std::string text = whole;
      text[at] = other;
      std::string cut_off;
      bool same = false;
      try {
        const auto lines = responses_from_text(text, "a", &cut_off);
        // without its line end the last one is incomplete; nothing else may pass
        same = lines.size() == 3 || (at + 1 != whole.size() && cut_off.empty());
      } catch (const InputError& error) {
        ASSERT_THAT(error.what(), HasSubstr("line "));
      }
      ASSERT_FALSE(same) << at << other;
    }
  }
}

TEST(ResponseFile, DetectsMovedDoubledAndMissingLines) {
  const test::TemporaryFolder folder;
  const std::string text = written(folder.file("whole.jsonl"), 3);
  const std::size_t a = text.find('\n') + 1, b = text.find('\n', a) + 1;
  const std::string first = text.substr(0, a), second = text.substr(a, b - a),
                    third = text.substr(b);
  for (const std::string& other : {first + third, second + first + third, first + second + second,
                                   second + third, first + second + third + third}) {
    EXPECT_THAT(test::input_error([&] { responses_from_text(other, "a"); }),
                HasSubstr("does not match its check"));
  }
  EXPECT_THAT(test::input_error([&] { responses_from_text("{\"a\":1}\n", "a"); }),
              HasSubstr("line 1 does not end with its check"));
  EXPECT_THAT(test::input_error([&] { responses_from_text(text + "nonsense\n", "a"); }),
              HasSubstr("line 4 is not a JSON object"));
}

TEST(ResponseFile, IsLeftUnchangedIfItWasEdited) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.jsonl");
  std::string text = written(path, 3);
  text.replace(text.find("\"trial\":2"), 9, "\"trial\":7");
  put(path, text + "{\"half");
  EXPECT_THAT(test::input_error([&] { ResponseFile file(path); }), HasSubstr("line 2"));
  EXPECT_EQ(read_file(path), text + "{\"half");
}

TEST(ResponseFile, IsUnchangedIfTheDiskIsFull) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.jsonl");
  written(path, 2);
  ResponseFile file(path);
  const std::string before = read_file(path);
  for (std::size_t room = 0; room < 20; ++room) {
    const test::FullDisk full(before.size() + room);
    EXPECT_THAT(test::input_error([&] { file.append(line_of(3)); }),
                HasSubstr("could not be written"));
    ASSERT_EQ(read_file(path), before);
  }
  file.append(line_of(3));
  EXPECT_EQ(responses_from_text(read_file(path), path).size(), 3U);
}

TEST(ResponseFile, IsLockedForOneProgram) {
  const test::TemporaryFolder folder;
  const ResponseFile file(folder.file("a.jsonl"));
  EXPECT_THAT(test::input_error([&] { ResponseFile other(folder.file("a.jsonl")); }),
              HasSubstr("written by another program"));
  EXPECT_THAT(test::input_error([&] { ResponseFile none(folder.file("missing/a.jsonl")); }),
              HasSubstr("cannot be created"));
}

TEST(ResponseFile, IsLockedForOneProgramWithoutLocksToo) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.jsonl");
  for (const int error : {ENOLCK, ENOSYS, EOPNOTSUPP}) {
    const test::NoLocks none(error);
    ResponseFile file(path);
    file.append(line_of(1));
    EXPECT_THAT(test::input_error([&] { ResponseFile other(path); }),
                HasSubstr("written by another program"));
  }
  EXPECT_EQ(ResponseFile(path).lines().size(), 3U);
  EXPECT_EQ(folder.entries(), 1U);
}

TEST(ResponseFile, IsLockedAgainstAProgramWithoutALockFile) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a.jsonl");
  written(path, 1);
  const int fd = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_EQ(::flock(fd, LOCK_EX | LOCK_NB), 0);
  EXPECT_THAT(test::input_error([&] { ResponseFile other(path); }),
              HasSubstr("written by another program"));
  ::close(fd);
  EXPECT_EQ(ResponseFile(path).lines().size(), 1U);
}

}  // namespace
}  // namespace prostm
