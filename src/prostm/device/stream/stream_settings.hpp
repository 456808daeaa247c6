#pragma once
/// Settings of the stream to other programs.

#include "prostm/core/settings.hpp"

namespace prostm {

struct StreamSettings {
  int block_samples = 40;  ///< a block is 1 ms; 1..400
  /// Time from sending a block to playing it, rounded up to whole blocks [s]; 0.001..0.2. It covers
  /// the delays of this machine, of the network and of the receiver, and is part of the latency.
  double lead_time = 0.020;
  int max_foci = 8;  ///< 1..8

  int queue_blocks() const;  ///< lead_time in blocks, rounded up, at least 1

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);

  static constexpr double kSampleRate = 40e3;  ///< [Hz]
};

}  // namespace prostm
