#pragma once
/// An endless stream to AUTD3 units, block by block.

#include <mutex>
#include <stop_token>

#include "prostm/device/autd3/autd3_budget.hpp"
#include "prostm/device/autd3/detail/autd3_output.hpp"
#include "prostm/device/detail/link_loss.hpp"
#include "prostm/device/device.hpp"

namespace prostm::autd3 {

/// The units play two segments in turn. Each block is written to the idle segment, followed by a
/// modulation that makes it audible until its end. A block that is written too late stays silent,
/// and so does the segment's old content. begin() and play_block() return false if the session
/// failed.
class Stream {
 public:
  Stream(Session& session, Output& output, SlotEncoder& encoder, const Autd3Budget& budget)
      : session_(session), output_(output), encoder_(encoder), budget_(budget) {}

  /// @param source outlives the stream. @pre nothing is playing.
  void start(SampleSource& source);
  /// Starts both segments, silent, in turn.
  bool begin();
  /// Writes the next block once its segment is free.
  bool play_block(const std::stop_token& stop);
  /// Call it when the link is lost: counts the missed blocks until begin() succeeds.
  void lose();

  // any thread
  DeviceStats stats() const;
  std::int64_t samples() const;
  double play_time(std::int64_t sample) const;  // [s] of the steady clock
  double ask_time(std::int64_t sample) const;

 private:
  bool wait_for_turn(const std::stop_token& stop);
  bool write_block(int segment);
  void fill(int from, int to);

  Session& session_;
  Output& output_;
  SlotEncoder& encoder_;
  const Autd3Budget budget_;

  SampleSource* source_ = nullptr;
  std::vector<FocusSample> samples_;  // of a block
  std::vector<SlotWord> words_;       // of a sample, all units
  TurnClock turns_;
  Session::Clock::duration fill_time_{};  // time of a block in the source and the encoder
  std::int64_t block_ = 0;                // next block to fill
  int written_ = 0;                       // segment

  mutable std::mutex mutex_;  // guards the members below
  DeviceStats stats_;
  LinkLoss loss_;
  std::int64_t anchor_block_ = 0;  // a block, and the time when it begins to play
  Session::Clock::time_point anchor_time_{};
};

}  // namespace prostm::autd3
