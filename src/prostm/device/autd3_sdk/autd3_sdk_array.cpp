#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

#include "prostm/device/autd3_sdk/detail/autd3_sdk_session.hpp"
#include "prostm/device/detail/link_loss.hpp"
#include "prostm/device/detail/segment_player.hpp"
#include "prostm/device/thread_priority.hpp"

namespace prostm {
namespace {

using Clock = sdk::Session::Clock;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using Seconds = std::chrono::duration<double>;

constexpr std::int64_t kPeriod = 25'000;  // of 40 kHz [ns]
constexpr double kRamp = 8e-3;            // ramp of the intensity from and to silence [s]
constexpr microseconds kMargin{300};      // wait after a turn, for the error between clocks
constexpr microseconds kPoll{500};        // between polls of the playing bank
constexpr int kMostTurns = 20;            // turns within which a bank must play
constexpr milliseconds kRetry{50};
// share of a block's time: if the link took longer for a missed block, the link caused the miss
constexpr double kSlowLink = 0.5;
constexpr double kUnitWidth = 192e-3;  // [m]

std::vector<Pose> side_by_side(std::size_t count) {
  std::vector<Pose> units;
  for (std::size_t u = 0; u < count; ++u) {
    const double x = kUnitWidth * (static_cast<double>(u) - 0.5 * static_cast<double>(count - 1));
    units.push_back(Pose(Eigen::Translation3d(x, 0.0, 0.0)) * autd3_middle());
  }
  return units;
}

SlotSettings slot_settings(const Autd3SdkSetup& setup) {
  return {.foci = setup.foci, .own_intensities = setup.own_intensities};
}

double seconds_of(Clock::time_point time) {
  return Seconds(time.time_since_epoch()).count();
}

DeviceInfo info_with(const Autd3SdkSetup& setup, const Autd3SdkBudget& budget) {
  return {.name = "AUTD3 (SDK)",
          .sample_rate = 1e9 / static_cast<double>(kPeriod * budget.divider),
          .block_samples = budget.block_samples,
          .max_foci = setup.own_intensities ? kMostSlots / 2 : kMostSlots,
          .intensity_per_focus = setup.own_intensities,
          .streams = true,
          .loads_segments = true,
          .decimation = budget.divider,
          .place_unit = kSlotUnit,
          .comes_back = true};
}

}  // namespace

struct Autd3SdkArray::Impl {
  explicit Impl(const Autd3SdkSetup& s);

  DeviceStatus refuse(const std::string& why);
  DeviceStatus begin(SampleSource& from);
  void run(const std::stop_token& stop);
  bool begin_stream();
  bool play_block();
  void fill_block();
  bool write_block(int bank);
  bool wait_for_turn(int bank);
  bool all_play(int bank);
  bool check_units();
  void fall_silent();
  void reconnect(const std::stop_token& stop);
  std::chrono::nanoseconds block_duration() const { return std::chrono::nanoseconds(block_time); }

  const Autd3SdkSetup setup;
  sdk::Session session;  // used by the streaming thread while it runs
  std::unique_ptr<SlotEncoder> encoder;
  Autd3SdkBudget budget;
  DeviceInfo info;
  std::string description;

  SampleSource* source = nullptr;
  SegmentPlayer segment;
  bool plays_segment = false;
  std::vector<FocusSample> samples;           // of a block
  std::vector<SlotWord> words;                // of a sample, all units
  std::vector<std::vector<SlotWord>> blocks;  // of each unit
  std::int64_t block = 0;                     // next block to fill
  std::int64_t block_time = 0, turn = 0;      // length of a block, next change of banks [ns]
  int playing = 0;                            // bank
  float gain = 0.0F;
  bool muted = false, falls = false;

  std::atomic<bool> hot{false};
  std::atomic<std::int64_t> times_muted{0};
  mutable std::mutex mutex;  // guards the members below
  DeviceStatus status = DeviceStatus::Idle;
  std::string problem;
  DeviceStats stats;
  LinkLoss loss;
  std::int64_t turn_block = 0;  // a block, and the time when it began to play
  Clock::time_point turn_time;

  std::jthread thread;
};

Autd3SdkArray::Impl::Impl(const Autd3SdkSetup& s)
    : setup(s),
      session({s.address, static_cast<int>(s.units.size()), std::clamp(s.failsafe_ms, 60, 100)}) {
  if (!session.open()) throw std::invalid_argument(session.problem());
  const std::vector<Pose> units = s.units.empty() ? side_by_side(session.units()) : s.units;
  const double frames_per_ms = session.measure();
  if (frames_per_ms == 0.0) throw std::invalid_argument(session.problem());
  SlotSettings slots = slot_settings(s);
  budget = best_autd3_sdk_budget(slot_count(slots), frames_per_ms);
  slots.sample_rate = 1e9 / static_cast<double>(kPeriod * budget.divider);
  encoder = std::make_unique<SlotEncoder>(units, s.medium, slots);
  description = fmt::format(
      "{} unit{}, firmware {}; {:.1f} frames per ms, of which blocks of {:.1f} ms take {:.0f} %",
      session.units(), session.units() == 1 ? "" : "s", session.firmware(), frames_per_ms,
      1e3 * budget.block_time, 100.0 * budget.load);
  info = info_with(s, budget);
  block_time = budget.block_samples * budget.divider * kPeriod;
  stats.queue_blocks = 1;
  const auto length = static_cast<std::size_t>(budget.block_samples * encoder->slots());
  words.resize(units.size() * static_cast<std::size_t>(encoder->slots()));
  blocks.assign(units.size(), std::vector<SlotWord>(length));
}

void Autd3SdkArray::Impl::run(const std::stop_token& stop) {
  raise_thread_priority();
  while (!stop.stop_requested()) {
    bool works = begin_stream();
    while (works && !stop.stop_requested()) works = play_block();
    if (!works) reconnect(stop);
  }
  fall_silent();
}

/// Prepares both banks; leaves a silent block playing.
bool Autd3SdkArray::Impl::begin_stream() {
  gain = 0.0F;
  muted = falls = false;
  playing = 0;
  encoder->reset();
  if (!session.set_silencer(budget.divider)) return false;
  for (const int bank : {1, 0}) {
    // bank 0 plays silence until bank 1 does
    const sdk::Pattern pattern{.bank = bank,
                               .divider = budget.divider,
                               .samples = budget.block_samples,
                               .slots = budget.slots,
                               .sound_speed = setup.medium.speed_of_sound()};
    if (!session.post_all([&](sdk::Datagram& d) { sdk::config_pattern(d, pattern); })) return false;
    for (std::vector<SlotWord>& unit : blocks) std::fill(unit.begin(), unit.end(), SlotWord{0});
    turn = (session.unit_time(Clock::now()) / block_time + 1) * block_time;
    if (!write_block(bank) || !wait_for_turn(bank)) return false;
  }
  const std::lock_guard lock(mutex);
  status = DeviceStatus::Running;
  problem.clear();
  loss.found(Clock::now(), budget.block_time, stats);
  turn_block = block - 1;
  turn_time = session.host_time(turn - block_time);
  return true;
}

/// Writes the next block to the free bank and waits until it plays. @return false if a unit is
/// lost.
bool Autd3SdkArray::Impl::play_block() {
  fill_block();
  const bool counts = !muted;
  const std::int64_t expected = turn;
  const Clock::time_point begun = Clock::now();
  if (!write_block(1 - playing)) return false;
  const bool is_slow = Clock::now() - begun > kSlowLink * block_duration();
  if (!wait_for_turn(1 - playing)) return false;
  const std::int64_t missed = (turn - block_time - expected) / block_time + (counts ? 0 : 1);
  {
    const std::lock_guard lock(mutex);
    stats.blocks = block;
    stats.late_blocks += missed > 0 && counts ? 1 : 0;
    stats.missed_blocks += missed;
    // units mute themselves if too few messages arrive over the link
    if (is_slow || !counts) stats.slow_blocks += missed;
    turn_block = block - 1;
    turn_time = session.host_time(turn - block_time);
  }
  return check_units();
}

/// Checks which units are hot or muted. Unmutes muted ones once they play a silent block.
bool Autd3SdkArray::Impl::check_units() {
  unsigned all = 0;
  for (std::size_t u = 0; u < session.units(); ++u) all |= session.state(u);
  hot = (all & sdk::kHot) != 0;
  if ((all & sdk::kFailsafe) == 0) {
    muted = false;
    return true;
  }
  if (!muted) {
    muted = true;
    gain = 0.0F;
    ++times_muted;
    return true;
  }
  // units refuse this while the cause of the mute persists; the next block tries again
  session.release_failsafe();
  return session.works();
}

void Autd3SdkArray::Impl::fill_block() {
  if (muted) {
    for (std::vector<SlotWord>& unit : blocks) std::fill(unit.begin(), unit.end(), SlotWord{0});
    return;
  }
  source->fill(block * budget.block_samples, samples);
  ++block;
  const auto width = static_cast<std::size_t>(source->foci());
  const auto slots = static_cast<std::size_t>(encoder->slots());
  const auto step = static_cast<float>(1.0 / (kRamp * info.sample_rate));
  for (std::size_t s = 0; s < samples.size() / width; ++s) {
    gain = std::clamp(gain + (falls ? -step : step), 0.0F, 1.0F);
    const std::span<FocusSample> sample = std::span(samples).subspan(s * width, width);
    for (FocusSample& focus : sample) focus.intensity *= gain;
    encoder->encode(sample, words);
    for (std::size_t u = 0; u < blocks.size(); ++u)
      std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(u * slots), slots,
                  blocks[u].begin() + static_cast<std::ptrdiff_t>(s * slots));
  }
}

/// Writes the block to a bank, to play at the next turn.
bool Autd3SdkArray::Impl::write_block(int bank) {
  const std::size_t length = blocks.front().size();
  for (std::size_t first = 0; first < length; first += sdk::kFociPerFrame) {
    const std::size_t count = std::min<std::size_t>(sdk::kFociPerFrame, length - first);
    for (std::size_t u = 0; u < blocks.size(); ++u) {
      sdk::Datagram* frame = session.room(u);
      if (frame == nullptr) return false;
      sdk::write_foci(*frame, bank, static_cast<int>(first),
                      std::span(blocks[u]).subspan(first, count));
      session.post(u);
    }
  }
  return session.activate(bank);
}

bool Autd3SdkArray::Impl::all_play(int bank) {
  for (std::size_t u = 0; u < session.units(); ++u) {
    const std::uint8_t state = session.state(u);
    const int plays = (state & sdk::kPatternBank) != 0 ? 1 : 0;
    if (plays != bank || (state & sdk::kTransitionPending) != 0) return false;
  }
  return true;
}

/// Waits until all units play a bank; sets `turn` to the end of its block.
bool Autd3SdkArray::Impl::wait_for_turn(int bank) {
  // after a stall the turn is long past
  turn = std::max(turn, session.unit_time(Clock::now()) / block_time * block_time);
  for (int turns = 0; turns < kMostTurns; ++turns, turn += block_time) {
    // do not wait for a clock that has jumped
    const Clock::time_point latest = Clock::now() + 2 * block_duration();
    if (!session.listen(std::min(session.host_time(turn) + kMargin, latest))) return false;
    do {
      if (!session.read_state()) return false;
      const std::int64_t now = session.unit_time(Clock::now());
      if (all_play(bank)) {
        turn = (now / block_time + 1) * block_time;
        playing = bank;
        return true;
      }
      if (now > turn + block_time / 2) break;
    } while (session.listen(Clock::now() + kPoll));
    if (!session.works()) return false;
  }
  return session.give_up("does not switch to the next block; switch the units off and on");
}

/// Ramps down, then clears the units.
void Autd3SdkArray::Impl::fall_silent() {
  if (!session.works() || source == nullptr) return;
  falls = true;
  if (gain > 0.0F && play_block())
    session.listen(std::min(session.host_time(turn), Clock::now() + 2 * block_duration()));
  session.close();
}

/// Searches for lost units until they are back. The stream pauses.
void Autd3SdkArray::Impl::reconnect(const std::stop_token& stop) {
  const auto say = [&] {
    const std::lock_guard lock(mutex);
    status = DeviceStatus::Vanished;
    problem = session.problem();
    loss.lose(std::min(turn_time, Clock::now()), stats);
  };
  say();
  while (!stop.stop_requested()) {
    const Clock::time_point tried = Clock::now();
    if (session.resume()) return;
    if (session.units_answer()) {
      if (session.open(stop)) return;
      say();
    }
    std::this_thread::sleep_until(tried + kRetry);
  }
}

DeviceStatus Autd3SdkArray::Impl::refuse(const std::string& why) {
  const std::lock_guard lock(mutex);
  problem = why;
  if (status != DeviceStatus::Running) status = DeviceStatus::Refused;
  return DeviceStatus::Refused;
}

/// Starts to stream. @pre not running.
DeviceStatus Autd3SdkArray::Impl::begin(SampleSource& from) {
  if (from.foci() < 1 || from.foci() > setup.foci)
    return refuse(fmt::format("The device AUTD3 (SDK) was set up for 1 to {} focal points, not {}.",
                              setup.foci, from.foci()));
  if (!session.resume() && !session.open()) return refuse(session.problem());
  source = &from;
  samples.resize(static_cast<std::size_t>(budget.block_samples * from.foci()));
  block = 0;
  {
    const std::lock_guard lock(mutex);
    stats = {.queue_blocks = 1};
    loss = {};
    status = DeviceStatus::Running;
    problem.clear();
    turn_block = 0;
    turn_time = Clock::now() + 4 * block_duration();
  }
  thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  return DeviceStatus::Running;
}

Autd3SdkArray::Autd3SdkArray(const Autd3SdkSetup& setup) : impl_(std::make_unique<Impl>(setup)) {}

Autd3SdkArray::~Autd3SdkArray() {
  stop();
  impl_->session.close();
}

DeviceInfo Autd3SdkArray::info_of(const Autd3SdkSetup& setup) {
  return info_with(setup, best_autd3_sdk_budget(slot_count(slot_settings(setup)), 1e3));
}

const DeviceInfo& Autd3SdkArray::info() const {
  return impl_->info;
}

DeviceStatus Autd3SdkArray::status() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->status;
}

std::string Autd3SdkArray::problem() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->problem;
}

DeviceStatus Autd3SdkArray::start(SampleSource& source) {
  stop();
  impl_->plays_segment = false;
  return impl_->begin(source);
}

void Autd3SdkArray::stop() {
  if (!impl_->thread.joinable()) return;
  impl_->thread.request_stop();
  impl_->thread.join();
  impl_->source = nullptr;
  impl_->plays_segment = false;
  const std::lock_guard lock(impl_->mutex);
  impl_->status = DeviceStatus::Idle;
}

DeviceStatus Autd3SdkArray::load_segment(std::span<const FocusSample> samples, int foci) {
  const bool runs = impl_->thread.joinable();
  if (runs && !impl_->plays_segment)
    return impl_->refuse("A stream plays; stop it before a segment is loaded.");
  if (foci < 1 || foci > impl_->setup.foci)
    return impl_->refuse(
        fmt::format("The segment has {} focal points a sample; the device AUTD3 "
                    "(SDK) was set up for 1 to {}.",
                    foci, impl_->setup.foci));
  if (const std::string why = segment_problem(samples, foci, impl_->info.max_foci); !why.empty())
    return impl_->refuse(why);
  if (runs && foci != impl_->segment.foci()) stop();
  if (!impl_->thread.joinable()) impl_->segment.reset(foci);
  impl_->segment.load(samples);
  if (impl_->thread.joinable()) return DeviceStatus::Running;
  const DeviceStatus begun = impl_->begin(impl_->segment);
  impl_->plays_segment = begun == DeviceStatus::Running;
  return begun;
}

DeviceStats Autd3SdkArray::stats() const {
  const std::lock_guard lock(impl_->mutex);
  DeviceStats now = impl_->stats;
  impl_->loss.add(Clock::now(), impl_->budget.block_time, now);
  return now;
}

std::int64_t Autd3SdkArray::samples() const {
  const std::lock_guard lock(impl_->mutex);
  return std::max<std::int64_t>(0, impl_->turn_block) * impl_->budget.block_samples;
}

double Autd3SdkArray::play_time(std::int64_t sample) const {
  const std::lock_guard lock(impl_->mutex);
  const auto from = static_cast<double>(sample - impl_->turn_block * impl_->budget.block_samples);
  return seconds_of(impl_->turn_time) + from / impl_->info.sample_rate;
}

double Autd3SdkArray::ask_time(std::int64_t sample) const {
  return play_time(sample) - impl_->budget.block_time;
}

bool Autd3SdkArray::is_hot() const {
  return impl_->hot;
}

const Autd3SdkBudget& Autd3SdkArray::budget() const {
  return impl_->budget;
}

std::int64_t Autd3SdkArray::muted() const {
  return impl_->times_muted;
}

std::string Autd3SdkArray::description() const {
  return impl_->description;
}

}  // namespace prostm
