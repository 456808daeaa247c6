#pragma once
/// Permissions for real-time output: real-time priority and locked memory.

#include <string>

namespace prostm {

struct RealtimeLimits {
  bool priority = false;  ///< raise_thread_priority() gets real-time scheduling
  bool memory = false;    ///< lock_memory() may lock everything
};
/// Reads the limits and capabilities of this process; changes nothing.
RealtimeLimits realtime_limits();

/// Locks all memory of this process, present and future, as it is touched, so that it is never
/// swapped out. Does nothing under a limit, because later allocations could then fail.
/// @return whether the memory is locked.
bool lock_memory();

/// One sentence each: whether it is allowed, and the remedy if not.
std::string priority_sentence(bool is_allowed);
std::string memory_sentence(bool is_allowed);

}  // namespace prostm
