#pragma once
/// Counters of a stream to other programs.

#include <cstdint>

namespace prostm {

/// Counters of the subscribers' side.
struct StreamStats {
  int subscribers = 0;
  std::int64_t skipped_blocks = 0;     ///< blocks that a subscriber was too slow for, of all
  std::int64_t refused_requests = 0;   ///< answered with an error message
  std::int64_t ignored_datagrams = 0;  ///< that were not of the protocol
};

}  // namespace prostm
