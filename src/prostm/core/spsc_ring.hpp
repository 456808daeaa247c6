#pragma once
/// SpscRing<T>: a bounded queue for one writer and one reader. Wait-free, never allocates after
/// construction.

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace prostm {

template <class T>
class SpscRing {
 public:
  /// @param capacity number of values, ≥ 1. @throws std::invalid_argument.
  explicit SpscRing(std::size_t capacity) : slots_(capacity + 1) {
    if (capacity == 0)
      throw std::invalid_argument("the capacity of a ring is 0; it must be at least 1");
  }
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  std::size_t capacity() const { return slots_.size() - 1; }

  /// Returns false and changes nothing if the ring is full. Writer's thread only.
  bool push(const T& value) {
    T* slot = back();
    if (slot == nullptr) return false;
    *slot = value;
    commit();
    return true;
  }
  /// The slot to fill in place before commit(); nullptr when full. Writer's thread only.
  T* back() {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    return next(head) == tail_.load(std::memory_order_acquire) ? nullptr : &slots_[head];
  }
  /// Makes the slot of back() visible to the reader. @pre back() was not nullptr. Writer's thread
  /// only.
  void commit() {
    head_.store(next(head_.load(std::memory_order_relaxed)), std::memory_order_release);
  }

  /// The oldest value, nullptr when empty. Reader's thread only.
  T* front() {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    return tail == head_.load(std::memory_order_acquire) ? nullptr : &slots_[tail];
  }
  /// Drops the oldest value. @pre front() was not nullptr. Reader's thread only.
  void pop() {
    tail_.store(next(tail_.load(std::memory_order_relaxed)), std::memory_order_release);
  }
  /// Copies the oldest value out and drops it; false when empty. Reader's thread only.
  bool pop(T& out) {
    T* slot = front();
    if (slot == nullptr) return false;
    out = *slot;
    pop();
    return true;
  }

 private:
  std::size_t next(std::size_t i) const { return i + 1 == slots_.size() ? 0 : i + 1; }
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

}  // namespace prostm
