#pragma once
/// Advisory locks of whole files (flock), on file systems with and without them.

#include <string>

namespace prostm {

enum class LockKind { Shared, Exclusive };
enum class LockResult {
  Taken,       ///< until the descriptor is closed or unlocked
  Held,        ///< another open file has a lock that excludes this one
  Unavailable  ///< the file system has no locks, e.g. NFS without a lock daemon
};

/// Tries to lock an open file; never blocks. Only EWOULDBLOCK means that the lock is held: a file
/// system without locks returns ENOLCK, ENOSYS, EOPNOTSUPP, EINVAL or others.
/// @param path names the file in the warning about a missing lock.
LockResult try_lock(int fd, LockKind kind, const std::string& path);

/// Sets the receiver of the warning (once per process) that a file system has no locks. Without a
/// receiver nothing is printed. Thread-safe only before the first try_lock().
void set_lock_warning(void (*receive)(const std::string& sentence));

}  // namespace prostm
