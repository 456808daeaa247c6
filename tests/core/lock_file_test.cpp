/// Locks on file systems with and without them, and lock files.
#include "prostm/core/file/lock_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "prostm/core/file/advisory_lock.hpp"
#include "prostm/core/file/file.hpp"
#include "support/input_errors.hpp"
#include "support/no_locks.hpp"

namespace prostm {
namespace {

using test::input_error;
using testing::AllOf;
using testing::HasSubstr;

std::vector<std::string>& warnings() {
  static std::vector<std::string> all;
  return all;
}

TEST(AdvisoryLock, DistinguishesAHeldLockFromAFileSystemWithoutLocks) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("a");
  write_file(path, "x");
  const int one = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  const int two = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  EXPECT_EQ(try_lock(one, LockKind::Shared, path), LockResult::Taken);
  EXPECT_EQ(try_lock(two, LockKind::Shared, path), LockResult::Taken);
  EXPECT_EQ(try_lock(two, LockKind::Exclusive, path), LockResult::Held);
  set_lock_warning([](const std::string& sentence) { warnings().push_back(sentence); });
  for (const int error : {ENOLCK, EOPNOTSUPP, ENOSYS, EINVAL, EIO}) {
    const test::NoLocks none(error);
    EXPECT_EQ(try_lock(two, LockKind::Exclusive, path), LockResult::Unavailable);
  }
  set_lock_warning(nullptr);
  ASSERT_EQ(warnings().size(), 1U);  // once for all files
  EXPECT_THAT(warnings()[0], AllOf(HasSubstr(path), HasSubstr("has no locks")));
  ::close(one);
  ::close(two);
}

/// A lock file of another process, made from this one's by changing some members.
class LockFiles : public testing::Test {
 protected:
  LockFiles() : path_(folder_.file("a.jsonl")), lock_(path_ + ".lock") {
    const LockFile mine(path_, ForeignLock::Respected, "--force");
    own_ = nlohmann::json::parse(read_file(lock_));
  }
  void leave(const nlohmann::json& change) {
    nlohmann::json other = own_;
    other.update(change);
    std::ofstream(lock_) << other.dump();
  }
  std::string refusal() {
    return input_error([&] { const LockFile file(path_, ForeignLock::Respected, "--force"); });
  }
  std::string notice(ForeignLock foreign) {
    const LockFile file(path_, foreign, "--force");
    return file.notice();
  }

  const test::TemporaryFolder folder_;
  const std::string path_, lock_;
  nlohmann::json own_;
};

TEST_F(LockFiles, LastForALifetimeOnEveryFileSystem) {
  EXPECT_FALSE(std::filesystem::exists(lock_));
  {
    const LockFile file(path_, ForeignLock::Respected, "--force");
    EXPECT_EQ(file.notice(), "");
    const test::NoLocks none(ENOLCK);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("is being written by another program"),
                                 HasSubstr(std::to_string(::getpid()))));
    // the option concerns other machines, so it does not override a process of this one
    EXPECT_THAT(input_error([&] { const LockFile other(path_, ForeignLock::Replaced, "--force"); }),
                HasSubstr("is being written by another program"));
  }
  EXPECT_EQ(folder_.entries(), 0U);
}

TEST_F(LockFiles, AreReplacedAfterACrashOnTheSameHost) {
  // a process that ends without removing the file
  const pid_t child = ::fork();
  if (child == 0) {
    static_cast<void>(new LockFile(path_, ForeignLock::Respected, "--force"));
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  EXPECT_THAT(notice(ForeignLock::Respected),
              AllOf(HasSubstr("no longer runs"), HasSubstr(std::to_string(child))));
  leave({{"started", "1"}});  // the process number has been reused
  EXPECT_THAT(notice(ForeignLock::Respected), HasSubstr("no longer runs"));
  if (own_["machine"] != "") {
    leave({{"boot", "an earlier start of the machine"}});
    EXPECT_THAT(notice(ForeignLock::Respected), HasSubstr("no longer runs"));
  }
  EXPECT_EQ(folder_.entries(), 0U);
}

TEST_F(LockFiles, OfOtherHostsAndContainersRequireTheOption) {
  for (const nlohmann::json& change :
       {nlohmann::json{{"host", "lab-2"}}, nlohmann::json{{"machine", "another"}},
        nlohmann::json{{"pids", "pid:[1]"}}}) {
    leave(change);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("give --force"), HasSubstr(lock_)));
    EXPECT_TRUE(std::filesystem::exists(lock_));
    EXPECT_THAT(notice(ForeignLock::Replaced), HasSubstr("because --force is given"));
    EXPECT_FALSE(std::filesystem::exists(lock_));
  }
  leave({{"host", "lab-2"}});
  EXPECT_THAT(refusal(), HasSubstr("on lab-2"));
  for (const char* text : {"", "{", "[]", "{\"host\":1}"}) {  // a crash while the file was written
    std::ofstream(lock_) << text;
    EXPECT_THAT(refusal(), HasSubstr("give --force"));
  }
}

TEST_F(LockFiles, AreKeptIfAnotherOwnerHasReplacedThem) {
  {
    const LockFile file(path_, ForeignLock::Respected, "--force");
    leave({{"host", "lab-2"}});
  }
  EXPECT_TRUE(std::filesystem::exists(lock_));
  EXPECT_EQ(folder_.entries(), 1U);
}

TEST_F(LockFiles, RequireAFolder) {
  const std::string path = folder_.file("missing/a");
  EXPECT_THAT(input_error([&] { const LockFile file(path, ForeignLock::Respected, "--force"); }),
              AllOf(HasSubstr(path + ".lock"), HasSubstr("cannot be created")));
}

}  // namespace
}  // namespace prostm
