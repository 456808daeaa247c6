#pragma once
/// A device for programs that listen: timed focal samples over TCP and UDP, prostm-stream/1.

#include <cstdint>
#include <memory>
#include <string>

#include "prostm/core/text/host_port.hpp"
#include "prostm/device/device.hpp"
#include "prostm/device/stream/stream_settings.hpp"
#include "prostm/device/stream/stream_stats.hpp"

namespace prostm {

/// Keeps real time by itself (BlockClock), whether anybody listens or not: it pulls a block every
/// block period and hands it to a thread that sends it to up to eight subscribers. Its own thread
/// never waits for them. The samples of a session count on from start to start; those of this
/// interface count from 0 at each start.
class StreamDevice final : public Device {
 public:
  /// Listens at once. @param address a number, or localhost; port 0: any that is free.
  /// @throws std::invalid_argument about a setting, or an address that cannot be listened at.
  StreamDevice(const StreamSettings& settings, const HostPort& address);
  ~StreamDevice() override;

  static DeviceInfo info_of(const StreamSettings& settings);
  const DeviceInfo& info() const override;
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  /// While a loop plays, the new one takes over at its end; while a stream plays, loops are
  /// refused. At most kMostLoop focal points in all.
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
