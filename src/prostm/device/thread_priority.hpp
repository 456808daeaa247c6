#pragma once
/// Raises the scheduling priority of a thread.

namespace prostm {

/// The real-time priority: above ordinary threads, below the system's own real-time threads.
inline constexpr int kRealtimePriority = 10;

/// Gives the calling thread round-robin real-time scheduling if the system allows it, otherwise a
/// higher priority if that is allowed, and short time slices. Also removes the slack of its timers.
/// A refused request changes nothing: an unprivileged process keeps the default scheduling, and the
/// queue of blocks must absorb its delays. @return whether real-time scheduling was allowed.
bool raise_thread_priority() noexcept;

}  // namespace prostm
