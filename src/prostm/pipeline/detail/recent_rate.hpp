#pragma once
/// Rate of growth of a counter. Private to pipeline.

#include <array>
#include <cstddef>
#include <cstdint>

namespace prostm {

/// Growth per second over the last second, or since the first count if that is shorter.
class RecentRate {
 public:
  /// @param time the time of the count, not before the last one [s].
  void add(double time, std::int64_t count) {
    entries_[newest_ = (newest_ + 1) % entries_.size()] = {time, count};
    if (size_ < entries_.size()) ++size_;
    // keep entries of at most the last second
    while (size_ > 1 && time - oldest().time > kSpan) --size_;
  }
  /// Rate [Hz]; 0 with fewer than two counts.
  double rate() const {
    if (size_ < 2) return 0.0;
    const Entry &first = oldest(), &last = entries_[newest_];
    return last.time > first.time
               ? static_cast<double>(last.count - first.count) / (last.time - first.time)
               : 0.0;
  }

 private:
  static constexpr double kSpan = 1.0;  // [s]
  struct Entry {
    double time = 0.0;
    std::int64_t count = 0;
  };
  const Entry& oldest() const {
    return entries_[(newest_ + entries_.size() + 1 - size_) % entries_.size()];
  }

  std::array<Entry, 128> entries_{};
  std::size_t newest_ = 0, size_ = 0;
};

}  // namespace prostm
