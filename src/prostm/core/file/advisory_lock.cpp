#include "prostm/core/file/advisory_lock.hpp"

#include <fmt/format.h>
#include <sys/file.h>

#include <atomic>
#include <cerrno>
#include <system_error>

namespace prostm {
namespace {

void (*warning_receiver)(const std::string& sentence) = nullptr;

void warn_once(const std::string& path, int error) {
  static std::atomic_flag warned;
  if (warning_receiver == nullptr || warned.test_and_set()) return;
  warning_receiver(
      fmt::format("the file system of {} has no locks ({}): nothing prevents another program from "
                  "writing the same file meanwhile",
                  path, std::generic_category().message(error)));
}

}  // namespace

LockResult try_lock(int fd, LockKind kind, const std::string& path) {
  const int how = (kind == LockKind::Exclusive ? LOCK_EX : LOCK_SH) | LOCK_NB;
  int failed = 0;
  do {
    failed = ::flock(fd, how);
  } while (failed != 0 && errno == EINTR);
  if (failed == 0) return LockResult::Taken;
  const int error = errno;
  if (error == EWOULDBLOCK) return LockResult::Held;
  warn_once(path, error);
  return LockResult::Unavailable;
}

void set_lock_warning(void (*receive)(const std::string& sentence)) {
  warning_receiver = receive;
}

}  // namespace prostm
