#pragma once
/// Work on all cores that a run has to share the machine with.

#include <sys/types.h>

namespace prostm::app {

/// A process of ordinary priority with as many threads as there are cores, which compute while they
/// are told to. It ends with this program, however that ends.
class CoreLoad {
 public:
  /// @pre this process has one thread so far. @throws InputError where no process can be made.
  CoreLoad();
  ~CoreLoad();
  CoreLoad(const CoreLoad&) = delete;
  CoreLoad& operator=(const CoreLoad&) = delete;

  void set(bool works);

 private:
  pid_t child_ = -1;
  int pipe_ = -1;
  bool works_ = false;
};

}  // namespace prostm::app
