#pragma once
/// The machine that a run in real time would have.

#include <cstdint>
#include <string>

#include "prostm/core/distribution.hpp"

namespace prostm {

struct Machine {
  std::string cpu;                 ///< model; empty where the system does not tell
  int cores = 0;                   ///< that this process may use, usable_cores()
  std::string vectors;             ///< instructions that the kernels use, by Highway's name
  bool realtime_priority = false;  ///< whether the array's thread gets it
  /// How late a thread like the array's wakes up from sleeping for 1 ms [s].
  Summary sleep_late;
};

/// Takes `seconds`, which a thread spends with short sleeps.
Machine look_at_machine(double seconds);

/// Processor time since the machine, or this program, started.
struct MachineUse {
  double busy = 0.0;        ///< of all programs, summed over cores [s]
  double stolen = 0.0;      ///< that the host of a virtual machine took from it [s]
  double own = 0.0;         ///< of this program [s]
  std::int64_t faults = 0;  ///< times that memory of this program had to come from a disk
};

/// Returns zeros for what the system does not tell. Takes a fraction of a millisecond.
MachineUse machine_use();

}  // namespace prostm
