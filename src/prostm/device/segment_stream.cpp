#include "prostm/device/segment_stream.hpp"

#include <algorithm>
#include <stdexcept>

#include "prostm/device/thread_priority.hpp"

namespace prostm {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr int kQueue = 1;  // blocks: while one plays, the next is loaded

double seconds_of(SteadyClock::time_point time) {
  return Seconds(time.time_since_epoch()).count();
}

}  // namespace

SegmentStream::SegmentStream(std::unique_ptr<Device> device)
    : device_(std::move(device)), info_(device_->info()) {
  if (!info_.loads_segments)
    throw std::invalid_argument("device " + info_.name + " cannot load segments");
  info_.streams = true;
}

SegmentStream::~SegmentStream() {
  stop();
}

DeviceStatus SegmentStream::status() const {
  return lost_ ? DeviceStatus::Vanished : device_->status();
}

std::string SegmentStream::problem() const {
  const std::string problem = device_->problem();
  return problem.empty() ? "Device " + info_.name + " plays a stream; stop it first." : problem;
}

DeviceStatus SegmentStream::start(SampleSource& source) {
  stop();
  source_ = &source;
  block_.assign(static_cast<std::size_t>(info_.block_samples * source.foci()), FocusSample());
  blocks_ = 0;
  lost_ = false;
  {
    const std::lock_guard lock(mutex_);
    stats_ = {};
    stats_.queue_blocks = kQueue;
    clock_.reset();
    if (info_.keeps_time) {
      const Seconds period(info_.block_samples / info_.sample_rate);
      clock_.emplace(SteadyClock::now(), std::chrono::round<BlockClock::Duration>(period), kQueue);
    }
  }
  // load the first block now, so that a refusal is reported here
  if (!load_block()) return DeviceStatus::Refused;
  if (info_.keeps_time) thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  return DeviceStatus::Running;
}

void SegmentStream::run(const std::stop_token& stop) {
  raise_thread_priority();
  for (;;) {
    SteadyClock::time_point asked;
    {
      const std::lock_guard lock(mutex_);
      asked = clock_->ask_time(blocks_);
    }
    std::this_thread::sleep_until(asked);
    if (stop.stop_requested()) return;
    if (!load_block()) {
      lost_ = true;
      return;
    }
  }
}

/// Loads the next block; false if the device refuses it.
bool SegmentStream::load_block() {
  source_->fill(blocks_ * info_.block_samples, block_);
  if (device_->load_segment(block_, source_->foci()) != DeviceStatus::Running) return false;
  const std::lock_guard lock(mutex_);
  if (clock_) {
    const BlockClock::Filled filled = clock_->fill(blocks_, SteadyClock::now());
    stats_.late_blocks += filled.late ? 1 : 0;
    stats_.missed_blocks += filled.missed;
    stats_.queue_blocks = clock_->queue_blocks();
  }
  stats_.blocks = ++blocks_;
  return true;
}

void SegmentStream::stop() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  device_->stop();
  source_ = nullptr;
}

void SegmentStream::pull(int n) {
  // the loaded block plays, then the next one is loaded
  for (int k = 0; k < n; ++k) {
    device_->pull(1);
    if (!load_block()) {
      lost_ = true;
      return;
    }
  }
}

DeviceStatus SegmentStream::load_segment(std::span<const FocusSample> samples, int foci) {
  if (source_ != nullptr) return DeviceStatus::Refused;
  return device_->load_segment(samples, foci);
}

DeviceStats SegmentStream::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

std::int64_t SegmentStream::samples() const {
  const std::lock_guard lock(mutex_);
  // the block that was loaded last has not played yet
  std::int64_t played = std::max<std::int64_t>(0, stats_.blocks - 1);
  if (clock_) {
    const auto now = SteadyClock::now();
    while (played > 0 && clock_->play_time(played) > now) --played;
  }
  return played * info_.block_samples;
}

double SegmentStream::play_time(std::int64_t sample) const {
  const std::lock_guard lock(mutex_);
  const std::int64_t block = sample / info_.block_samples;
  const double within = static_cast<double>(sample % info_.block_samples) / info_.sample_rate;
  if (!clock_) return static_cast<double>(sample) / info_.sample_rate;
  return seconds_of(clock_->play_time(block)) + within;
}

double SegmentStream::ask_time(std::int64_t sample) const {
  const std::lock_guard lock(mutex_);
  if (!clock_) return static_cast<double>(sample) / info_.sample_rate;
  return seconds_of(clock_->ask_time(sample / info_.block_samples));
}

}  // namespace prostm
