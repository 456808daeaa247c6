#pragma once
/// Lock files: a file next to another, naming the process that has exclusive use of it. They work
/// on file systems without locks, and between machines that share a folder.

#include <string>

namespace prostm {

/// Whether to replace a lock file of another machine, which may still be in use.
enum class ForeignLock { Respected, Replaced };

/// Holds PATH.lock from construction to destruction. The file is created with O_EXCL and names the
/// host, the process and when it started, so that a lock file left by a crash is recognised: if its
/// process on this host no longer runs, it is replaced. Whether a process of another host, or of
/// another container, still runs cannot be determined: such a lock file is an error unless
/// `foreign` allows replacing it.
class LockFile {
 public:
  /// @param path file to lock. @param override_option command-line option that allows replacing,
  /// for messages. @throws InputError: another process has locked the file, or the lock file cannot
  /// be created.
  LockFile(const std::string& path, ForeignLock foreign, const std::string& override_option);
  ~LockFile();  ///< removes the lock file, unless another process has replaced it
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

  /// A sentence about the lock file that was replaced; empty if there was none.
  const std::string& notice() const { return notice_; }

 private:
  std::string path_, text_, notice_;  // path and content of the lock file
};

}  // namespace prostm
