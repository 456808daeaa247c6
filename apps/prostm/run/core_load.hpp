#pragma once
/// Load on all cores, for runs that must share the machine.

#include <sys/types.h>

namespace prostm::app {

/// A process of ordinary priority with one thread per core, which compute while the load is
/// switched on. It ends with this program, however that ends.
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
