#include "prostm/pipeline/realtime/machine.hpp"

// the same targets as for the kernels
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#endif
#include <hwy/highway.h>

#if defined(__linux__)
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <chrono>
#include <fstream>
#include <thread>

#include "prostm/core/stage_timer.hpp"
#include "prostm/device/thread_priority.hpp"
#include "prostm/pipeline/realtime/cores.hpp"

namespace prostm {
namespace {

/// The value of "model name", as reported by Linux on x86.
std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != line.npos) return line.substr(colon + 2);
  }
  return {};
}

/// Returns the best target of the processor among those that the kernels were compiled for: Highway
/// gives better targets lower bits.
std::string vector_target() {
  const auto usable = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(usable & -usable);
}

}  // namespace

Machine look_at_machine(double seconds) {
  constexpr std::chrono::milliseconds kSleep{1};
  Machine machine;
  machine.cpu = cpu_model();
  machine.cores = usable_cores();
  machine.vectors = vector_target();
  Distribution late;
  std::jthread sleeper([&] {
    machine.realtime_priority = raise_thread_priority();
    const StageTimer whole;
    while (whole.seconds() < seconds) {
      const StageTimer timer;
      std::this_thread::sleep_for(kSleep);
      late.add(timer.seconds() - 1e-3);
    }
  });
  sleeper.join();
  machine.sleep_late = late.summary();
  return machine;
}

MachineUse machine_use() {
  MachineUse use;
#if defined(__linux__)
  const double tick = 1.0 / static_cast<double>(sysconf(_SC_CLK_TCK));
  std::ifstream file("/proc/stat");
  std::string name;
  double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, irq = 0, soft = 0, stolen = 0;
  if (file >> name >> user >> nice >> system >> idle >> waiting >> irq >> soft >> stolen) {
    use.busy = tick * (user + nice + system + irq + soft);
    use.stolen = tick * stolen;
  }
  rusage own{};
  if (getrusage(RUSAGE_SELF, &own) == 0) {
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    use.own = seconds(own.ru_utime) + seconds(own.ru_stime);
    use.faults = own.ru_majflt;
  }
#endif
  return use;
}

}  // namespace prostm
