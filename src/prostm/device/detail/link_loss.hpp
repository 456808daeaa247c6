#pragma once
/// Counts how often the link to an array is lost, and the blocks that are missed meanwhile.

#include <chrono>
#include <cmath>
#include <optional>

#include "prostm/device/device.hpp"

namespace prostm {

class LinkLoss {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Records that the link is lost and that nothing plays from `since` on. Counts once until
  /// found().
  void lose(Time since, DeviceStats& stats) {
    if (since_) return;
    since_ = since;
    ++stats.lost_links;
  }
  /// Records that blocks play again. @param block_time [s].
  void found(Time now, double block_time, DeviceStats& stats) {
    add(now, block_time, stats);
    since_.reset();
  }
  /// Adds the blocks that were missed until now, if the link is lost.
  void add(Time now, double block_time, DeviceStats& stats) const {
    if (!since_ || now < *since_) return;
    const double seconds = std::chrono::duration<double>(now - *since_).count();
    const auto blocks = static_cast<std::int64_t>(std::llround(seconds / block_time));
    stats.lost_blocks += blocks;
    stats.missed_blocks += blocks;
  }

 private:
  std::optional<Time> since_;
};

}  // namespace prostm
