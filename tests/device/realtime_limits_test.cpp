// System limits, tested in processes with their own limits.

#include "prostm/device/realtime_limits.hpp"

#include <gtest/gtest.h>

#if defined(__linux__)
#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <vector>

namespace prostm {
namespace {

void drop_capabilities() {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  const __user_cap_data_struct none[2] = {};
  syscall(SYS_capset, &header, none);
}

/// Exit status of a child process that runs `test`: 0 if the test holds.
int in_child(const std::function<bool()>& test) {
  const pid_t child = fork();
  if (child == 0) _exit(test() ? 0 : 1);
  int status = -1;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

void limit(__rlimit_resource which, rlim_t value) {
  rlimit old{};
  getrlimit(which, &old);
  const rlimit now{value, old.rlim_max};
  setrlimit(which, &now);
}

TEST(RealtimeLimits, ALimitPreventsLockingTheMemory) {
  EXPECT_EQ(in_child([] {
              drop_capabilities();
              limit(RLIMIT_MEMLOCK, 65536);
              limit(RLIMIT_RTPRIO, 0);
              const RealtimeLimits limits = realtime_limits();
              if (limits.memory || limits.priority || lock_memory()) return false;
              // ordinary allocations still work
              const std::vector<char> memory(std::size_t{64} << 20, 'x');
              return memory[12345] == 'x';
            }),
            0);
}

TEST(RealtimeLimits, WithoutALimitTheMemoryIsLocked) {
#ifdef PROSTM_SANITIZED
  GTEST_SKIP() << "sanitizers prevent locking of memory";
#endif
  EXPECT_EQ(in_child([] {
              if (!realtime_limits().memory) return true;  // this machine cannot show it
              if (!lock_memory()) return false;
              const std::vector<char> memory(std::size_t{1} << 20, 'x');
              // a locked page cannot be discarded
              void* page =
                  mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
              return madvise(page, 4096, MADV_DONTNEED) != 0 && memory[12345] == 'x';
            }),
            0);
}

TEST(RealtimeLimits, TheSentencesExplainWhatToDo) {
  EXPECT_NE(priority_sentence(false).find("rtprio 10"), std::string::npos);
  EXPECT_NE(memory_sentence(false).find("memlock unlimited"), std::string::npos);
  EXPECT_EQ(priority_sentence(true).find("limits.d"), std::string::npos);
  EXPECT_EQ(memory_sentence(true).find("limits.d"), std::string::npos);
}

}  // namespace
}  // namespace prostm
#endif
