#include "prostm/device/realtime_limits.hpp"

#if defined(__linux__)
#include <linux/capability.h>
#include <sys/mman.h>
#include <sys/resource.h>
#endif

#include <cstdint>
#include <fstream>

#include "prostm/device/thread_priority.hpp"

namespace prostm {
namespace {

#if defined(__linux__)
/// Whether this process has a capability, by its number.
bool has_capability(int number) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "CapEff:") continue;
    std::uint64_t set = 0;
    return static_cast<bool>(status >> std::hex >> set) && ((set >> number) & 1U) != 0;
  }
  return false;
}

/// Whether a limit of this process is at least `wanted`.
bool limit_allows(__rlimit_resource which, rlim_t wanted) {
  rlimit limit{};
  return getrlimit(which, &limit) == 0 &&
         (limit.rlim_cur == RLIM_INFINITY || limit.rlim_cur >= wanted);
}
#endif

/// Returns the remedy: the line to add to the file of limits.
std::string allow(const char* line) {
  return std::string("write \"* - ") + line +
         "\" into /etc/security/limits.d/prostm.conf and log in again";
}

}  // namespace

RealtimeLimits realtime_limits() {
  RealtimeLimits limits;
#if defined(__linux__)
  limits.priority = limit_allows(RLIMIT_RTPRIO, kRealtimePriority) || has_capability(CAP_SYS_NICE);
  limits.memory = limit_allows(RLIMIT_MEMLOCK, RLIM_INFINITY) || has_capability(CAP_IPC_LOCK);
#endif
  return limits;
}

bool lock_memory() {
#if defined(__linux__)
  return realtime_limits().memory && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
#else
  return false;
#endif
}

std::string priority_sentence(bool is_allowed) {
  if (is_allowed) return "Real-time priority is allowed, and the array's thread takes it.";
  return "Real-time priority is not allowed, so the queue must absorb delays by other programs: " +
         allow("rtprio 10") + " (ulimit -r).";
}

std::string memory_sentence(bool is_allowed) {
  if (is_allowed) return "Memory may be locked (--lock-memory), so that it is never swapped out.";
  return "Memory may not be locked, so it may be swapped out to disk: " +
         allow("memlock unlimited") + " (ulimit -l).";
}

}  // namespace prostm
