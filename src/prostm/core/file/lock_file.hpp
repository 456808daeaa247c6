#pragma once
/// Lock files: a file beside another that names the process which has that one for itself. They
/// work on file systems without locks, and between machines that share a folder.

#include <string>

namespace prostm {

/// Whether a lock file that another machine left or uses is replaced.
enum class ForeignLock { Respected, Replaced };

/// Holds PATH.lock from construction to destruction. The file is created with O_EXCL and names the
/// host, the process and when it started, so that a lock file that a crash left behind is
/// recognised: on this host, where the process is no longer there, it is replaced. Whether a
/// process of another host, or of another container, still runs is not known here: such a lock file
/// is an error unless `foreign` allows to replace it.
class LockFile {
 public:
  /// @param path of the file to have. @param override_option the option of the command line that
  /// allows to take over. @throws InputError: another process has it, or the lock file cannot be
  /// created.
  LockFile(const std::string& path, ForeignLock foreign, const std::string& override_option);
  ~LockFile();  ///< removes the lock file, unless another process took it over
  LockFile(const LockFile&) = delete;
  LockFile& operator=(const LockFile&) = delete;

  /// A sentence about the lock file that was replaced; empty if there was none.
  const std::string& notice() const { return notice_; }

 private:
  std::string path_, text_, notice_;  // of the lock file; what it holds
};

}  // namespace prostm
