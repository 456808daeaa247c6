#pragma once
/// A device that sends timed samples of focal points to other programs, by prostm-stream/1.

#include <cstdint>
#include <memory>
#include <string>

#include "prostm/core/text/host_port.hpp"
#include "prostm/device/device.hpp"
#include "prostm/device/stream/stream_settings.hpp"
#include "prostm/device/stream/stream_stats.hpp"

namespace prostm {

/// Keeps real time by itself (BlockClock), with or without subscribers: it pulls a block every
/// block period and passes it to a thread that sends it to up to eight subscribers. The device's
/// own thread never waits for them. In the protocol, samples are numbered on from start to start
/// within a session; in this interface, they are numbered from 0 at each start.
class StreamDevice final : public Device {
 public:
  /// Starts listening. @param address numeric, or localhost; port 0: any free one.
  /// @throws std::invalid_argument for a setting out of bounds, or an address where it cannot
  /// listen.
  StreamDevice(const StreamSettings& settings, const HostPort& address);
  ~StreamDevice() override;

  static DeviceInfo info_of(const StreamSettings& settings);
  const DeviceInfo& info() const override;
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  /// While a loop plays, a new one replaces it at its end; while a stream plays, loops are refused.
  /// A loop holds at most kMostLoop focal points, over all its samples.
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override;
  double play_time(std::int64_t sample) const override;
  double ask_time(std::int64_t sample) const override;

  std::uint16_t port() const;
  StreamStats stream_stats() const;

  static constexpr std::size_t kMostLoop = 65536;
  static constexpr std::uint16_t kUsualPort = 7140;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
