#pragma once
/// Properties of the machine that matter for real time.

#include <cstdint>
#include <string>

#include "prostm/core/distribution.hpp"

namespace prostm {

struct Machine {
  std::string cpu;                 ///< model; empty if unknown
  int cores = 0;                   ///< available to this process, usable_cores()
  std::string vectors;             ///< vector instructions used by the kernels, Highway's name
  bool realtime_priority = false;  ///< whether the array's thread can get it
  /// Wake-up delay of a thread like the array's after sleeping for 1 ms [s].
  Summary sleep_late;
};

/// Measures the machine. Takes `seconds`, spent in short sleeps of a thread.
Machine look_at_machine(double seconds);

/// Processor time since the machine, or this program, started.
struct MachineUse {
  double busy = 0.0;        ///< all programs, summed over cores [s]
  double stolen = 0.0;      ///< taken by the host of a virtual machine [s]
  double own = 0.0;         ///< this program [s]
  std::int64_t faults = 0;  ///< major page faults of this program
};

/// Returns the current use; zeros for values that the system does not report. Takes a fraction of a
/// millisecond.
MachineUse machine_use();

}  // namespace prostm
