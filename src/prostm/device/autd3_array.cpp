#include "prostm/device/autd3_array.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "prostm/device/detail/autd3_session.hpp"
#include "prostm/device/detail/dead_man.hpp"
#include "prostm/device/thread_priority.hpp"

namespace prostm {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr double kCarrier = 40e3;  // [Hz], from which all sampling rates are divided
constexpr double kMostLoad = 0.75;
constexpr double kLongBlock = 20e-3, kShortBlock = 10e-3;  // [s]
constexpr int kLeastDivider = 4;                           // 10 kHz, above which nothing is gained
constexpr int kMostDivider = 20;  // 2 kHz, below which fingers feel the steps
constexpr double kRamp = 3e-3;    // of a dead man's modulation [s]
constexpr int kModulationDivider = 20;
constexpr double kModulationSample = kModulationDivider / kCarrier;
constexpr double kEarly =
    0.5e-3;  // by which the modulation ends before a block whose time is known so well [s]
constexpr std::chrono::milliseconds kRetry{100};

Clock::duration to_duration(double seconds) {
  return std::chrono::round<Clock::duration>(Seconds(seconds));
}

double seconds_of(Clock::time_point time) {
  return Seconds(time.time_since_epoch()).count();
}

}  // namespace

Autd3Budget autd3_budget(int slots, int divider, double block_time, double frames_per_ms) {
  Autd3Budget budget;
  budget.slots = slots;
  budget.divider = divider;
  budget.block_samples = static_cast<int>(std::lround(block_time * kCarrier / divider));
  budget.block_frames = autd3::foci_frames(slots, budget.block_samples);
  budget.block_time = budget.block_samples * divider / kCarrier;
  budget.load = (budget.block_frames + 1) / (1e3 * budget.block_time * frames_per_ms);
  return budget;
}

Autd3Budget best_autd3_budget(int slots, double frames_per_ms) {
  for (int divider = kLeastDivider; divider <= kMostDivider; ++divider) {
    for (const double block_time : {kShortBlock, kLongBlock}) {
      const Autd3Budget budget = autd3_budget(slots, divider, block_time, frames_per_ms);
      if (budget.load <= kMostLoad) return budget;
    }
  }
  char words[200];
  std::snprintf(words, sizeof(words),
                "the link takes %.2f frames per ms, too few for %d slots at 2 kHz; use fewer focal "
                "points or a faster network",
                frames_per_ms, slots);
  throw std::invalid_argument(words);
}

struct Autd3Array::Impl {
  explicit Impl(const Autd3Setup& s);

  void open();
  void run(const std::stop_token& stop);
  bool begin_stream();
  bool play_block(const std::stop_token& stop);
  bool wait_for_turn(const std::stop_token& stop);
  void fill_block();
  bool write_block(int segment, autd3::Transition transition);
  bool keep_sounding();
  void fall_silent();
  void connect_again(const std::stop_token& stop);

  const Autd3Setup setup;
  const std::vector<Pose> units;
  autd3::Session session;  // by the thread that streams, while there is one
  SlotEncoder encoder;
  Autd3Budget budget;
  DeviceInfo info;

  SampleSource* source = nullptr;
  std::vector<FocusSample> samples;           // of a block
  std::vector<SlotWord> words;                // of a sample, all units
  std::vector<std::vector<SlotWord>> blocks;  // of each unit
  std::int64_t block = 0;                     // to be filled next
  int playing = 0, modulation = 0;            // segments
  bool sounds = false;
  Clock::time_point next_turn;  // when the block that was written last begins to play

  mutable std::mutex mutex;  // guards the members below
  DeviceStatus status = DeviceStatus::Idle;
  std::string problem;
  DeviceStats stats;
  std::int64_t turn_block = 0;  // a block, and when it began to play
  Clock::time_point turn_time;

  std::jthread thread;
};

namespace {

std::vector<Pose> units_of(const Autd3Setup& setup) {
  return setup.units.empty() ? std::vector<Pose>{autd3_middle()} : setup.units;
}

}  // namespace

Autd3Array::Impl::Impl(const Autd3Setup& s)
    : setup(s),
      units(units_of(s)),
      session({s.host, s.port}, units),
      encoder(units, s.medium, {.foci = s.foci, .own_intensities = s.own_intensities}) {
  open();
  if (!session.problem().empty()) throw std::invalid_argument(session.problem());
  budget = best_autd3_budget(encoder.slots(), session.frames_per_ms());
  info.name = "AUTD3";
  info.sample_rate = kCarrier / budget.divider;
  info.block_samples = budget.block_samples;
  info.max_foci = s.own_intensities ? kMostSlots / 2 : kMostSlots;
  info.intensity_per_focus = s.own_intensities;
  info.streams = true;
  info.decimation = budget.divider;
  stats.queue_blocks = 1;
  const auto length = static_cast<std::size_t>(budget.block_samples);
  words.resize(units.size() * static_cast<std::size_t>(encoder.slots()));
  blocks.assign(units.size(),
                std::vector<SlotWord>(length * static_cast<std::size_t>(encoder.slots())));
}

/// Opens the session. Its problem() is empty if that worked.
void Autd3Array::Impl::open() {
  session.open();
}

void Autd3Array::Impl::run(const std::stop_token& stop) {
  raise_thread_priority();
  while (!stop.stop_requested()) {
    bool works = begin_stream();
    while (works && !stop.stop_requested()) works = play_block(stop);
    if (!works) connect_again(stop);
  }
  fall_silent();
}

/// Sets both segments, silent, to play in turn.
bool Autd3Array::Impl::begin_stream() {
  sounds = false;
  autd3::silencer(session.frame(0), budget.divider);
  session.same_for_all();
  const auto silent = [&](autd3::Frame& frame, int segment) {
    autd3::modulation(frame, std::array<std::uint8_t, 2>{0, 0}, segment, kModulationDivider);
    session.same_for_all();
    return session.exchange();
  };
  // a modulation of 0 holds before anything else can sound
  if (!session.exchange()) return false;
  autd3::gpio(session.frame(0), 1);
  session.same_for_all();
  modulation = 1;
  if (!session.exchange() || !silent(session.frame(0), modulation)) return false;
  for (std::vector<SlotWord>& unit : blocks) std::fill(unit.begin(), unit.end(), SlotWord{0});
  if (!write_block(0, autd3::Transition::Immediate)) return false;
  if (!write_block(1, autd3::Transition::Alternate)) return false;
  if (!session.poll()) return false;
  playing = session.playing_segment();
  next_turn = Clock::now();
  const std::lock_guard lock(mutex);
  status = DeviceStatus::Running;
  problem.clear();
  return true;
}

/// Writes the next block when the segment for it is free. @return false if the link is lost.
bool Autd3Array::Impl::play_block(const std::stop_token& stop) {
  if (!wait_for_turn(stop)) return false;
  if (stop.stop_requested()) return true;
  const int free = 1 - playing;
  fill_block();
  const Clock::time_point turn = next_turn;
  if (!write_block(free, autd3::Transition::Later) || !session.poll()) return false;
  // what was written after the segment's turn came is not played whole: it stays silent
  const bool late = session.playing_segment() != playing || Clock::now() > turn;
  {
    const std::lock_guard lock(mutex);
    stats.blocks = block;
    stats.late_blocks += late ? 1 : 0;
    stats.missed_blocks += late ? 1 : 0;
  }
  sounds = sounds && !late;
  return late || keep_sounding();
}

/// Waits until the segment that was written last plays.
bool Autd3Array::Impl::wait_for_turn(const std::stop_token& stop) {
  const Clock::time_point end = next_turn + to_duration(4.0 * budget.block_time);
  for (;;) {
    if (stop.stop_requested()) return true;
    if (!session.poll()) return false;
    const int now_playing = session.playing_segment();
    if (now_playing >= 0 && now_playing != playing) {
      playing = now_playing;
      break;
    }
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(autd3::Session::kPolls);
  }
  const Clock::time_point now = Clock::now();
  next_turn = now + to_duration(budget.block_time);
  const std::lock_guard lock(mutex);
  turn_block = block - 1;
  turn_time = now;
  return true;
}

void Autd3Array::Impl::fill_block() {
  source->fill(block * budget.block_samples, samples);
  ++block;
  const auto width = static_cast<std::size_t>(source->foci());
  const auto slots = static_cast<std::size_t>(encoder.slots());
  for (std::size_t s = 0; s < samples.size() / width; ++s) {
    encoder.encode(std::span(samples).subspan(s * width, width), words);
    for (std::size_t u = 0; u < blocks.size(); ++u)
      std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(u * slots), slots,
                  blocks[u].begin() + static_cast<std::ptrdiff_t>(s * slots));
  }
}

bool Autd3Array::Impl::write_block(int segment, autd3::Transition transition) {
  const autd3::FociSegment foci{.segment = segment,
                                .transition = transition,
                                .slots = budget.slots,
                                .samples = budget.block_samples,
                                .divider = budget.divider,
                                .sound_speed = setup.medium.speed_of_sound()};
  for (int index = 0; index < budget.block_frames; ++index) {
    for (std::size_t u = 0; u < blocks.size(); ++u)
      autd3::foci(session.frame(u), foci, blocks[u], index);
    if (!session.exchange()) return false;
  }
  return true;
}

/// Makes the block that was written audible, from its begin to its end.
bool Autd3Array::Impl::keep_sounding() {
  const double next = Seconds(next_turn - Clock::now()).count();
  const SoundingTime time{sounds, std::max(0.0, next) + kEarly,
                          std::max(0.0, next) + budget.block_time - kEarly};
  std::array<std::uint8_t, autd3::kMostModulation> levels;
  const int count = write_dead_man(time, kRamp, kModulationSample, levels);
  modulation = 1 - modulation;
  autd3::modulation(session.frame(0), std::span(levels).first(static_cast<std::size_t>(count)),
                    modulation, kModulationDivider);
  session.same_for_all();
  sounds = true;
  return session.exchange();
}

/// Ramps down, then makes the units forget what they play.
void Autd3Array::Impl::fall_silent() {
  std::array<std::uint8_t, autd3::kMostModulation> levels;
  const int count = write_dead_man({sounds, 0.0, kRamp}, kRamp, kModulationSample, levels);
  modulation = 1 - modulation;
  autd3::modulation(session.frame(0), std::span(levels).first(static_cast<std::size_t>(count)),
                    modulation, kModulationDivider);
  session.same_for_all();
  if (session.exchange()) {
    std::this_thread::sleep_for(to_duration(2.0 * kRamp));
    autd3::clear_and_synchronise(session.frame(0));
    session.same_for_all();
    session.exchange();
  }
  session.close();
}

/// Tries to open the link again until it works. The stream goes on meanwhile, unheard.
void Autd3Array::Impl::connect_again(const std::stop_token& stop) {
  sounds = false;
  {
    const std::lock_guard lock(mutex);
    status = DeviceStatus::Vanished;
    problem = session.problem();
  }
  while (!stop.stop_requested()) {
    const Clock::time_point tried = Clock::now();
    if (session.open()) return;
    std::this_thread::sleep_until(tried + kRetry);
  }
}

Autd3Array::Autd3Array(const Autd3Setup& setup) : impl_(std::make_unique<Impl>(setup)) {}

Autd3Array::~Autd3Array() {
  stop();
}

const DeviceInfo& Autd3Array::info() const {
  return impl_->info;
}

DeviceStatus Autd3Array::status() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->status;
}

std::string Autd3Array::problem() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->problem;
}

DeviceStatus Autd3Array::start(SampleSource& source) {
  stop();
  const auto refuse = [&](const std::string& why) {
    const std::lock_guard lock(impl_->mutex);
    impl_->problem = why;
    return impl_->status = DeviceStatus::Refused;
  };
  if (source.foci() > impl_->setup.foci)
    return refuse("Device AUTD3 was set up for " + std::to_string(impl_->setup.foci) +
                  " focal points, not " + std::to_string(source.foci()) + ".");
  if (impl_->session.problem().empty() && !impl_->session.is_open()) impl_->open();
  if (!impl_->session.problem().empty()) return refuse(impl_->session.problem());
  impl_->source = &source;
  impl_->samples.assign(static_cast<std::size_t>(impl_->budget.block_samples * source.foci()),
                        FocusSample());
  impl_->block = 0;
  {
    const std::lock_guard lock(impl_->mutex);
    impl_->stats = {};
    impl_->stats.queue_blocks = 1;
    impl_->turn_block = 0;
    impl_->turn_time = Clock::now() + to_duration(impl_->budget.block_time);
    impl_->status = DeviceStatus::Running;
    impl_->problem.clear();
  }
  impl_->thread = std::jthread([this](const std::stop_token& stop) { impl_->run(stop); });
  return DeviceStatus::Running;
}

void Autd3Array::stop() {
  if (!impl_->thread.joinable()) return;
  impl_->thread.request_stop();
  impl_->thread.join();
  impl_->source = nullptr;
  const std::lock_guard lock(impl_->mutex);
  impl_->status = DeviceStatus::Idle;
}

DeviceStatus Autd3Array::load_segment(std::span<const FocusSample>, int) {
  return DeviceStatus::Refused;
}

DeviceStats Autd3Array::stats() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->stats;
}

std::int64_t Autd3Array::samples() const {
  const std::lock_guard lock(impl_->mutex);
  return std::max<std::int64_t>(0, impl_->turn_block) * impl_->budget.block_samples;
}

double Autd3Array::play_time(std::int64_t sample) const {
  const std::lock_guard lock(impl_->mutex);
  const auto from = static_cast<double>(sample - impl_->turn_block * impl_->budget.block_samples);
  return seconds_of(impl_->turn_time) + from / impl_->info.sample_rate;
}

double Autd3Array::ask_time(std::int64_t sample) const {
  return play_time(sample) - impl_->budget.block_time;
}

const Autd3Budget& Autd3Array::budget() const {
  return impl_->budget;
}

std::string Autd3Array::description() const {
  char words[200];
  std::snprintf(words, sizeof(words), "%s; %.2f frames per ms", impl_->session.firmware().c_str(),
                impl_->session.frames_per_ms());
  return words;
}

}  // namespace prostm
