#pragma once
/// Whether the system lets a program keep time: real-time priority and locked memory.

#include <string>

namespace prostm {

struct RealtimeLimits {
  bool priority = false;  ///< raise_thread_priority() gets real-time scheduling
  bool memory = false;    ///< lock_memory() may lock everything
};
/// Looks at the limits and capabilities of this process; changes nothing.
RealtimeLimits realtime_limits();

/// Keeps all memory of this process, present and future, from being swapped out, as it is touched.
/// Does nothing where a limit stands in the way: with a limit, later memory could be refused.
/// @return whether the memory is locked.
bool lock_memory();

/// One sentence each: whether it is allowed, and what to do where it is not.
std::string priority_sentence(bool is_allowed);
std::string memory_sentence(bool is_allowed);

}  // namespace prostm
