#pragma once
/// Counters of a stream to other programs.

#include <cstdint>

namespace prostm {

/// Counters of the server.
struct StreamStats {
  int subscribers = 0;
  std::int64_t skipped_blocks = 0;    ///< blocks dropped for slow subscribers, over all subscribers
  std::int64_t refused_requests = 0;  ///< answered with an error message
  std::int64_t ignored_datagrams = 0;  ///< datagrams of other protocols, or from servers
};

}  // namespace prostm
