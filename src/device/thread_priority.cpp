#include "device/thread_priority.hpp"

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace prostm {

void raise_thread_priority() noexcept {
#if defined(__linux__)
  constexpr int kRealTime = 10;  // above ordinary threads, below what the system itself runs
  constexpr int kNice = -11;
  sched_param parameter{};
  parameter.sched_priority = kRealTime;
  if (pthread_setschedparam(pthread_self(), SCHED_RR, &parameter) != 0) {
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
  }
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);  // [ns]; the default is 50 µs
#endif
}

}  // namespace prostm
