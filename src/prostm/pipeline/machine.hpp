#pragma once
/// The machine that a run in real time would have.

#include <string>

#include "prostm/core/distribution.hpp"

namespace prostm {

struct Machine {
  std::string cpu;                 ///< model; empty where the system does not tell
  int cores = 0;                   ///< that this process may use
  std::string vectors;             ///< instructions that the kernels use, by Highway's name
  bool realtime_priority = false;  ///< whether the array's thread gets it
  /// How late a thread like the array's wakes up from sleeping for 1 ms [s].
  Summary sleep_late;
};

/// Takes `seconds`, which a thread spends with short sleeps.
Machine look_at_machine(double seconds);

}  // namespace prostm
