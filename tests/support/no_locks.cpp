#include "support/no_locks.hpp"

#include <sys/file.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

namespace prostm::test {

std::atomic<int> NoLocks::error_{0};

}  // namespace prostm::test

// Overrides the function of libc, also for shared libraries.
extern "C" int flock(int fd, int operation) noexcept {
  const int error = prostm::test::NoLocks::error();
  if (error == 0) return static_cast<int>(::syscall(SYS_flock, fd, operation));
  errno = error;
  return -1;
}
