#include "prostm/device/thread_priority.hpp"

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#endif

namespace prostm {

#if defined(__linux__)
namespace {

/// Asks the fair scheduler for short time slices, so that the thread runs soon after each wake-up.
/// Needs no privilege; kernels before 6.12 ignore it.
void ask_for_short_slices() noexcept {
  struct Attributes {  // the kernel's struct sched_attr, version 0
    std::uint32_t size;
    std::uint32_t policy;
    std::uint64_t flags;
    std::int32_t nice;
    std::uint32_t priority;
    std::uint64_t runtime, deadline, period;  // [ns]; runtime is the slice
  };
  Attributes attributes{};
  attributes.size = sizeof(Attributes);
  attributes.policy = SCHED_OTHER;
  attributes.nice = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
  attributes.runtime = 100'000;
  syscall(SYS_sched_setattr, 0, &attributes, 0U);
}

}  // namespace
#endif

bool raise_thread_priority() noexcept {
  bool is_realtime = false;
#if defined(__linux__)
  constexpr int kNice = -11;
  sched_param parameter{};
  parameter.sched_priority = kRealtimePriority;
  is_realtime = pthread_setschedparam(pthread_self(), SCHED_RR, &parameter) == 0;
  if (!is_realtime) {
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
    ask_for_short_slices();
  }
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // [ns]; the default is 50 µs
#endif
  return is_realtime;
}

}  // namespace prostm
