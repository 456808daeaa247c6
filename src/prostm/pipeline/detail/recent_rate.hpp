#pragma once
/// How fast a count grows. Private to pipeline.

#include <array>
#include <cstddef>
#include <cstdint>

namespace prostm {

/// Growth a second over the last second, or over as much as there is.
class RecentRate {
 public:
  /// @param time when the count was seen, never before the last one [s].
  void add(double time, std::int64_t count) {
    entries_[newest_ = (newest_ + 1) % entries_.size()] = {time, count};
    if (size_ < entries_.size()) ++size_;
    // the oldest that is kept is at most a second old
    while (size_ > 1 && time - oldest().time > kSpan) --size_;
  }
  /// 0 with fewer than two counts [Hz].
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
