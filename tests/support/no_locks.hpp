#pragma once
/// A file system without locks, for tests.

#include <atomic>

namespace prostm::test {

/// During its lifetime flock() fails with `error` in the whole test program, libraries included.
class NoLocks {
 public:
  explicit NoLocks(int error) { error_ = error; }
  ~NoLocks() { error_ = 0; }
  NoLocks(const NoLocks&) = delete;
  NoLocks& operator=(const NoLocks&) = delete;

  static int error() { return error_; }  ///< 0: flock() works

 private:
  static std::atomic<int> error_;
};

}  // namespace prostm::test
