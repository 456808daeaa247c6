#pragma once
/// A stream on a device that only loads segments.

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "prostm/device/detail/block_clock.hpp"
#include "prostm/device/device.hpp"

namespace prostm {

/// Fills blocks from the stream and loads each as the segment that plays next, while the one before
/// it plays. In real time it does so on a thread of its own, paced by BlockClock; otherwise in
/// pull(). A late block is counted, and the device repeats the previous block until it arrives. A
/// device that refuses a block while the stream plays counts as vanished.
class SegmentStream final : public Device {
 public:
  /// @throws std::invalid_argument for a device that cannot load segments.
  explicit SegmentStream(std::unique_ptr<Device> device);
  ~SegmentStream() override;

  const DeviceInfo& info() const override { return info_; }
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  void pull(int n) override;
  /// Refused while a stream plays.
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override;
  double play_time(std::int64_t sample) const override;
  double ask_time(std::int64_t sample) const override;
  std::string description() const override { return device_->description(); }
  bool is_hot() const override { return device_->is_hot(); }
  const PlayedSamples* played() const override { return device_->played(); }

 private:
  void run(const std::stop_token& stop);
  bool load_block();

  const std::unique_ptr<Device> device_;
  DeviceInfo info_;
  SampleSource* source_ = nullptr;
  std::vector<FocusSample> block_;
  std::int64_t blocks_ = 0;  // blocks loaded, by the thread that pulls

  mutable std::mutex mutex_;  // guards the members below
  DeviceStats stats_;
  std::optional<BlockClock> clock_;

  std::atomic<bool> lost_{false};  // a block was refused while the stream played
  std::jthread thread_;
};

}  // namespace prostm
