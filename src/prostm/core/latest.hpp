#pragma once
/// Latest<T>: one writer, one reader, the newest value wins. Wait-free on both sides, never
/// allocates after construction.

#include <array>
#include <atomic>
#include <cstdint>

namespace prostm {

/// Three slots rotate: the writer owns one, the reader owns one, and the index of the third is in
/// `middle_` with a flag that tells whether it is newer than the reader's. A value skipped by the
/// reader is overwritten.
template <class T>
class Latest {
 public:
  Latest() = default;
  explicit Latest(const T& initial) : slots_{initial, initial, initial} {}
  Latest(const Latest&) = delete;
  Latest& operator=(const Latest&) = delete;

  /// Writer's slot: fill it, then publish(). It still holds an earlier value. Writer's thread only.
  T& draft() { return slots_[writer_]; }
  /// Makes the draft the newest value. Writer's thread only.
  void publish() {
    const std::uint8_t old =
        middle_.exchange(static_cast<std::uint8_t>(writer_ | kFresh), std::memory_order_acq_rel);
    writer_ = old & kIndex;
  }
  /// Takes the newest value if one was published since the last call; true if so. Reader's thread
  /// only.
  bool refresh() {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    const std::uint8_t old = middle_.exchange(reader_, std::memory_order_acq_rel);
    reader_ = old & kIndex;
    return true;
  }
  /// The value taken by the last refresh(). Reader's thread only.
  const T& value() const { return slots_[reader_]; }
  T& value() { return slots_[reader_]; }

 private:
  static constexpr std::uint8_t kIndex = 3, kFresh = 4;
  static_assert(std::atomic<std::uint8_t>::is_always_lock_free);
  std::array<T, 3> slots_{};
  std::uint8_t writer_ = 0;
  alignas(64) std::atomic<std::uint8_t> middle_{1};
  alignas(64) std::uint8_t reader_ = 2;
};

}  // namespace prostm
