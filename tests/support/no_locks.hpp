#pragma once
/// A file system without locks, for tests.

#include <atomic>

namespace prostm::test {

/// Makes flock() fail with `error` during its lifetime, in the whole program including libraries.
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
