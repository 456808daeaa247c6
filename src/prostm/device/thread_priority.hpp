#pragma once
/// Asks the system to let a thread run on time.

namespace prostm {

/// The priority of real-time scheduling: above ordinary threads, below what the system itself runs.
inline constexpr int kRealtimePriority = 10;

/// For the calling thread: round-robin real-time scheduling where the system allows it, else a
/// higher priority where it allows that, and short time slices; and wake-ups without slack.
/// Whatever is refused is left as it is: an unprivileged process keeps the default scheduling, and
/// the queue of blocks must cover for it. @return whether real-time scheduling was allowed.
bool raise_thread_priority() noexcept;

}  // namespace prostm
