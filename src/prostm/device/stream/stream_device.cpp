#include "prostm/device/stream/stream_device.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>

#include "prostm/core/settings.hpp"
#include "prostm/device/detail/block_clock.hpp"
#include "prostm/device/detail/segment_player.hpp"
#include "prostm/device/stream/detail/stream_server.hpp"
#include "prostm/device/thread_priority.hpp"

namespace prostm {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

const StreamSettings& validated(const StreamSettings& s) {
  require_bounds(s);
  return s;
}

/// Data of the pulling thread; no other thread accesses it while that thread runs.
struct Stream {
  SampleSource* source = nullptr;
  std::optional<BlockClock> clock;
  DeviceStats stats;
  std::int64_t unsent = 0;  // samples dropped because the ring was full
  std::int64_t loop = 0;    // number of the playing segment
  std::int64_t loop_first = 0, loop_play_ns = 0;
};

}  // namespace

struct StreamDevice::Impl {
  Impl(const StreamSettings& s, const HostPort& address)
      : settings(validated(s)),
        info(info_of(s)),
        server(address, s),
        spare(static_cast<std::size_t>(s.block_samples * s.max_foci)) {
    stats.queue_blocks = s.queue_blocks();
  }

  const StreamSettings settings;
  const DeviceInfo info;
  stream::StreamServer server;

  // published by the pulling thread, under the mutex
  mutable std::mutex mutex;
  DeviceStatus status = DeviceStatus::Idle;
  std::string problem;
  DeviceStats stats;
  std::optional<BlockClock> clock;

  Stream stream;
  std::int64_t before = 0;         // samples of the session before this start
  std::vector<FocusSample> spare;  // buffer for a block that will be dropped
  SegmentPlayer segment;
  std::int64_t loops = 0, loops_before = 0;  // loaded, in all and before the segment's reset
  std::jthread thread;

  DeviceStatus refuse(const std::string& sentence);
  DeviceStatus begin(SampleSource& source);
  void end();
  void run(const std::stop_token& stop);
  void pull_block();
  void send(stream::BlockRecord& record, std::int64_t block);
  double time_of(std::int64_t sample, bool played) const;
};

DeviceStatus StreamDevice::Impl::refuse(const std::string& sentence) {
  const std::lock_guard lock(mutex);
  problem = sentence;
  if (status != DeviceStatus::Running) status = DeviceStatus::Refused;
  return DeviceStatus::Refused;
}

/// Starts to pull. @pre not running, the source fits.
DeviceStatus StreamDevice::Impl::begin(SampleSource& source) {
  const double period = settings.block_samples / info.sample_rate;
  stream = Stream();
  stream.source = &source;
  stream.stats.queue_blocks = settings.queue_blocks();
  stream.clock.emplace(SteadyClock::now(),
                       std::chrono::round<SteadyClock::duration>(Seconds(period)),
                       settings.queue_blocks());
  {
    const std::lock_guard lock(mutex);
    status = DeviceStatus::Running;
    problem.clear();
    stats = stream.stats;
    clock = stream.clock;
  }
  server.set_running(true);
  thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  return DeviceStatus::Running;
}

void StreamDevice::Impl::end() {
  if (!thread.joinable()) return;
  thread.request_stop();
  thread.join();
  server.set_running(false);
  before += stream.stats.blocks * settings.block_samples;
  const std::lock_guard lock(mutex);
  stats = stream.stats;
  clock = stream.clock;
}

void StreamDevice::Impl::run(const std::stop_token& stop) {
  raise_thread_priority();
  for (;;) {
    std::this_thread::sleep_until(stream.clock->ask_time(stream.stats.blocks));
    if (stop.stop_requested()) return;
    pull_block();
  }
}

void StreamDevice::Impl::pull_block() {
  // fill first, then read the clock
  const std::int64_t block = stream.stats.blocks, first = block * settings.block_samples;
  stream::BlockRecord* record = server.draft();
  const auto size = static_cast<std::size_t>(settings.block_samples * stream.source->foci());
  if (record != nullptr) {
    record->samples = settings.block_samples;
    record->foci = stream.source->foci();
  }
  stream.source->fill(first, record == nullptr ? std::span(spare).first(size) : record->span());
  const BlockClock::Filled filled = stream.clock->fill(block, SteadyClock::now());
  stream.stats.late_blocks += filled.late ? 1 : 0;
  stream.stats.missed_blocks += filled.missed;
  stream.stats.queue_blocks = stream.clock->queue_blocks();
  ++stream.stats.blocks;
  if (record != nullptr) {
    send(*record, block);
  } else {
    stream.unsent += settings.block_samples;
  }

  // a reader that holds the lock may have been descheduled: do not wait for it
  const std::unique_lock lock(mutex, std::try_to_lock);
  if (!lock) return;
  stats = stream.stats;
  clock = stream.clock;
}

/// Passes the filled record to the server's thread.
void StreamDevice::Impl::send(stream::BlockRecord& record, std::int64_t block) {
  record.first = before + block * settings.block_samples;
  record.play_ns = stream::to_ns(stream.clock->play_time(block));
  record.missed = stream.stats.missed_blocks;
  record.unsent = stream.unsent;
  record.loop = 0;
  if (stream.source == &segment) {
    const SegmentPlayer::Playing playing = segment.playing();
    if (playing.number != stream.loop) {
      const std::int64_t within = before + playing.first - record.first;
      stream.loop = playing.number;
      stream.loop_first = before + playing.first;
      stream.loop_play_ns = record.play_ns + within * std::llround(1e9 / info.sample_rate);
    }
    record.loop = static_cast<std::uint32_t>(loops_before + stream.loop);
    record.loop_first = stream.loop_first;
    record.loop_play_ns = stream.loop_play_ns;
  }
  server.send();
}

StreamDevice::StreamDevice(const StreamSettings& settings, const HostPort& address)
    : impl_(std::make_unique<Impl>(settings, address)) {}

StreamDevice::~StreamDevice() {
  stop();
}

DeviceInfo StreamDevice::info_of(const StreamSettings& settings) {
  return {.name = "stream",
          .sample_rate = StreamSettings::kSampleRate,
          .block_samples = settings.block_samples,
          .max_foci = settings.max_foci,
          .intensity_per_focus = true,
          .streams = true,
          .loads_segments = true};
}

const DeviceInfo& StreamDevice::info() const {
  return impl_->info;
}

DeviceStatus StreamDevice::status() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->status;
}

std::string StreamDevice::problem() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->problem;
}

DeviceStatus StreamDevice::start(SampleSource& source) {
  if (status() == DeviceStatus::Running)
    return impl_->refuse("The stream is running already; stop it first.");
  if (source.foci() < 1 || source.foci() > impl_->settings.max_foci) {
    return impl_->refuse("The emission has " + std::to_string(source.foci()) +
                         " focal points a sample; this stream takes 1 to " +
                         std::to_string(impl_->settings.max_foci) + " (max_foci of [stream]).");
  }
  impl_->server.set_loop(nullptr);
  return impl_->begin(source);
}

void StreamDevice::stop() {
  impl_->end();
  const std::lock_guard lock(impl_->mutex);
  impl_->stream.source = nullptr;
  impl_->status = DeviceStatus::Idle;
}

DeviceStatus StreamDevice::load_segment(std::span<const FocusSample> samples, int foci) {
  Impl& impl = *impl_;
  const bool running = status() == DeviceStatus::Running;
  const std::string problem = segment_problem(samples, foci, impl.settings.max_foci);
  if (!problem.empty()) return impl.refuse(problem);
  if (samples.size() > kMostLoop) {
    return impl.refuse("The loop has " + std::to_string(samples.size()) +
                       " focal points over all its samples; a stream repeats at most " +
                       std::to_string(kMostLoop) + ".");
  }
  if (running && (impl.stream.source != &impl.segment || impl.segment.foci() != foci)) {
    return impl.refuse(
        "The stream plays samples, or a loop with another number of focal points; stop it first.");
  }
  if (!running) {
    impl.segment.reset(foci);
    impl.loops_before = impl.loops;
  }
  ++impl.loops;
  auto loop = std::make_shared<stream::PlayedLoop>();
  loop->id = static_cast<std::uint32_t>(impl.loops);
  loop->foci = foci;
  loop->sample_rate = impl.info.sample_rate;
  loop->samples.assign(samples.begin(), samples.end());
  impl.server.set_loop(std::move(loop));
  impl.segment.load(samples);
  return running ? DeviceStatus::Running : impl.begin(impl.segment);
}

DeviceStats StreamDevice::stats() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->stats;
}

std::int64_t StreamDevice::samples() const {
  const Impl& impl = *impl_;
  const std::lock_guard lock(impl.mutex);
  if (!impl.clock) return 0;
  // the block that plays now is among those sent ahead, or the one before them
  const auto now = SteadyClock::now();
  const std::int64_t oldest =
      std::max<std::int64_t>(0, impl.stats.blocks - impl.settings.queue_blocks() - 1);
  for (std::int64_t block = impl.stats.blocks - 1; block >= oldest; --block) {
    const double age = Seconds(now - impl.clock->play_time(block)).count();
    if (age < 0.0) continue;
    const auto within = static_cast<std::int64_t>(age * impl.info.sample_rate) + 1;
    return block * impl.settings.block_samples +
           std::min<std::int64_t>(within, impl.settings.block_samples);
  }
  return oldest * impl.settings.block_samples;
}

double StreamDevice::Impl::time_of(std::int64_t sample, bool played) const {
  const std::lock_guard lock(mutex);
  if (!clock) return static_cast<double>(sample) / info.sample_rate;
  const std::int64_t block = sample / settings.block_samples;
  const SteadyClock::time_point start = played ? clock->play_time(block) : clock->ask_time(block);
  return Seconds(start.time_since_epoch()).count() +
         static_cast<double>(sample % settings.block_samples) / info.sample_rate;
}

double StreamDevice::play_time(std::int64_t sample) const {
  return impl_->time_of(sample, true);
}

double StreamDevice::ask_time(std::int64_t sample) const {
  return impl_->time_of(sample, false);
}

std::uint16_t StreamDevice::port() const {
  return impl_->server.port();
}

StreamStats StreamDevice::stream_stats() const {
  return impl_->server.stats();
}

}  // namespace prostm
