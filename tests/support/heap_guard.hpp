#pragma once
/// Counts heap allocations of the calling thread, to prove that a loop does not allocate.

#include <cstddef>

namespace prostm::test {

/// `HeapGuard guard; …; EXPECT_EQ(guard.allocations(), 0u);`
class HeapGuard {
 public:
  HeapGuard();
  std::size_t allocations() const;  ///< by this thread, since construction

 private:
  std::size_t start_;
};

}  // namespace prostm::test
