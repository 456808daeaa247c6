#include "prostm/device/autd3/autd3_array.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "prostm/device/autd3/detail/autd3_loops.hpp"
#include "prostm/device/autd3/detail/autd3_stream.hpp"
#include "prostm/device/autd3/detail/autd3_timing.hpp"
#include "prostm/device/thread_priority.hpp"

namespace prostm {
namespace {

using Clock = autd3::Session::Clock;

constexpr std::chrono::milliseconds kRetry{100};
constexpr double kFastest = 8.0;      // speed above which a step of a focal point is a jump [m/s]
constexpr double kUsualFrames = 1.0;  // per ms, before a link is measured

std::vector<Pose> units_of(const Autd3Setup& setup) {
  if (setup.units.size() > autd3::kMostUnits) {
    throw std::invalid_argument(fmt::format("AUTD3 is driven with up to {} units, not {}",
                                            autd3::kMostUnits, setup.units.size()));
  }
  return setup.units.empty() ? std::vector<Pose>{autd3_middle()} : setup.units;
}

SlotSettings slots_of(const Autd3Setup& setup) {
  return {.foci = setup.foci, .own_intensities = setup.own_intensities};
}

DeviceInfo info_for(const Autd3Setup& setup, const Autd3Budget& budget) {
  DeviceInfo info;
  info.name = "AUTD3";
  info.sample_rate = budget.sample_rate();
  info.block_samples = budget.block_samples;
  info.max_foci = setup.own_intensities ? kMostSlots / 2 : kMostSlots;
  info.intensity_per_focus = setup.own_intensities;
  info.streams = true;
  info.loads_segments = true;
  info.decimation = budget.divider;
  info.place_unit = kSlotUnit;
  info.comes_back = true;
  return info;
}

}  // namespace

struct Autd3Array::Impl {
  explicit Impl(const Autd3Setup& setup);

  bool is_ready();
  DeviceStatus set_status(DeviceStatus now, const std::string& why = {});
  void run_stream(const std::stop_token& stop);
  void run_loops(const std::stop_token& stop);
  template <class Begin, class Play>
  void keep_running(const std::stop_token& stop, Begin&& begin, Play&& play);
  void reconnect(const std::stop_token& stop);
  DeviceStatus load(std::span<const FocusSample> samples, int foci);

  const Autd3Setup setup;
  const std::vector<Pose> units;
  autd3::Session session;                // used by the playing thread while it runs
  std::unique_ptr<SlotEncoder> encoder;  // likewise, or by the thread that loads loops
  autd3::Output output;
  Autd3Budget budget;
  DeviceInfo info;
  std::string description;
  std::unique_ptr<autd3::Stream> stream;
  autd3::Loops loops;
  bool loops_play = false;

  mutable std::mutex mutex;  // guards the members below
  DeviceStatus status = DeviceStatus::Idle;
  std::string problem;

  std::atomic<bool> hot{false};
  std::atomic<int> link_process{0};
  std::jthread thread;
};

Autd3Array::Impl::Impl(const Autd3Setup& s)
    : setup(s),
      units(units_of(s)),
      session(s.address, units),
      output(session),
      loops(session, output) {
  SlotSettings slots = slots_of(s);
  const int count = slot_count(slots);  // throws for too many focal points, before any connection
  if (!session.open(autd3::Session::kOpenTime) || !session.measure())
    throw std::invalid_argument(session.problem());
  link_process = session.link_process();
  budget = best_autd3_budget(count, session.frames_per_ms(), session.slow_frame(), s.block_time);
  slots.sample_rate = budget.sample_rate();
  encoder = std::make_unique<SlotEncoder>(units, s.medium, slots);
  info = info_for(s, budget);
  output.configure(count, budget.divider, budget.block_samples, s.medium.speed_of_sound());
  stream = std::make_unique<autd3::Stream>(session, output, *encoder, budget);
  description = fmt::format(
      "{} unit{}, {}; {:.2f} frames per ms; {} slots at {:.1f} kHz, which is {:.2f} mm between "
      "samples at {:g} m/s; blocks of {:.1f} ms, so a latency of {:.0f} to {:.0f} ms; "
      "{:.0f} % of the link",
      units.size(), units.size() == 1 ? "" : "s", session.firmware(), session.frames_per_ms(),
      budget.slots, 1e-3 * budget.sample_rate(), 1e3 * budget.step(), kAutd3DrawSpeed,
      1e3 * budget.block_time, 1e3 * budget.block_time, 2e3 * budget.block_time, 1e2 * budget.load);
}

/// Reopens the link if it is closed; false if that fails.
bool Autd3Array::Impl::is_ready() {
  if (session.is_open() || session.open(autd3::Session::kOpenTime)) {
    link_process = session.link_process();
    return true;
  }
  return false;
}

DeviceStatus Autd3Array::Impl::set_status(DeviceStatus now, const std::string& why) {
  const std::lock_guard lock(mutex);
  problem = why;
  return status = now;
}

template <class Begin, class Play>
void Autd3Array::Impl::keep_running(const std::stop_token& stop, Begin&& begin, Play&& play) {
  raise_thread_priority();
  while (!stop.stop_requested()) {
    bool works = begin();
    if (works) set_status(DeviceStatus::Running);
    while (works && !stop.stop_requested()) {
      works = play();
      hot.store(session.is_hot(), std::memory_order_relaxed);
    }
    if (!works) reconnect(stop);
  }
  output.finish();
  link_process = 0;
}

void Autd3Array::Impl::run_stream(const std::stop_token& stop) {
  keep_running(
      stop, [&] { return stream->begin(); }, [&] { return stream->play_block(stop); });
}

void Autd3Array::Impl::run_loops(const std::stop_token& stop) {
  const double step = kFastest / budget.sample_rate();
  keep_running(
      stop, [&] { return loops.begin(step); }, [&] { return loops.play(stop); });
}

/// Retries to open the link until that succeeds.
void Autd3Array::Impl::reconnect(const std::stop_token& stop) {
  link_process = 0;
  stream->lose();
  set_status(DeviceStatus::Vanished, session.problem());
  while (!stop.stop_requested()) {
    const Clock::time_point tried = Clock::now();
    if (session.open(autd3::Session::kOpenTime)) {
      link_process = session.link_process();
      return;
    }
    std::this_thread::sleep_until(tried + kRetry);
  }
}

DeviceStatus Autd3Array::Impl::load(std::span<const FocusSample> samples, int foci) {
  const std::string why = autd3::loop_problem(samples, foci, setup.foci, encoder->slots());
  if (!why.empty()) return set_status(DeviceStatus::Refused, why);
  autd3::Loop loop;
  loop.foci = foci;
  loop.samples.assign(samples.begin(), samples.end());
  // the firmware requires at least two slots
  while (loop.length() * encoder->slots() < 2)
    loop.samples.insert(loop.samples.end(), samples.begin(), samples.end());
  const auto slots = static_cast<std::size_t>(encoder->slots()),
             width = static_cast<std::size_t>(foci);
  const auto length = static_cast<std::size_t>(loop.length());
  loop.words.assign(units.size(), std::vector<SlotWord>(length * slots));
  std::vector<SlotWord> words(units.size() * slots);
  encoder->reset();
  // in the second round, phases continue from the loop's end
  for (std::size_t i = 0; i < 2 * length; ++i) {
    const std::size_t s = i % length;
    encoder->encode(std::span(loop.samples).subspan(s * width, width), words);
    for (std::size_t u = 0; u < units.size(); ++u)
      std::copy_n(words.begin() + static_cast<std::ptrdiff_t>(u * slots), slots,
                  loop.words[u].begin() + static_cast<std::ptrdiff_t>(s * slots));
  }
  loops.load(std::move(loop));
  return DeviceStatus::Running;
}

Autd3Array::Autd3Array(const Autd3Setup& setup) : impl_(std::make_unique<Impl>(setup)) {}

Autd3Array::~Autd3Array() {
  stop();
  impl_->session.close();
}

DeviceInfo Autd3Array::info_of(const Autd3Setup& setup) {
  const int slots = slot_count(slots_of(setup));
  return info_for(setup, best_autd3_budget(slots, kUsualFrames, 0.0, setup.block_time));
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
  if (source.foci() > impl_->setup.foci) {
    return impl_->set_status(DeviceStatus::Refused,
                             fmt::format("Device AUTD3 was set up for {} focal points, not {}.",
                                         impl_->setup.foci, source.foci()));
  }
  if (!impl_->is_ready()) return impl_->set_status(DeviceStatus::Refused, impl_->session.problem());
  impl_->stream->start(source);
  impl_->set_status(DeviceStatus::Running);
  impl_->thread = std::jthread([this](const std::stop_token& stop) { impl_->run_stream(stop); });
  return DeviceStatus::Running;
}

void Autd3Array::stop() {
  if (!impl_->thread.joinable()) return;
  impl_->thread.request_stop();
  impl_->thread.join();
  impl_->loops_play = false;
  impl_->loops.forget();
  impl_->set_status(DeviceStatus::Idle);
}

DeviceStatus Autd3Array::load_segment(std::span<const FocusSample> samples, int foci) {
  if (impl_->thread.joinable() && !impl_->loops_play) {
    const std::lock_guard lock(impl_->mutex);
    impl_->problem = "Device AUTD3 plays a stream; stop it before a loop is loaded.";
    return DeviceStatus::Refused;
  }
  if (impl_->loops_play) return impl_->load(samples, foci);
  if (!impl_->is_ready()) return impl_->set_status(DeviceStatus::Refused, impl_->session.problem());
  const DeviceStatus loaded = impl_->load(samples, foci);
  if (loaded != DeviceStatus::Running) return loaded;
  impl_->loops_play = true;
  impl_->set_status(DeviceStatus::Running);
  impl_->thread = std::jthread([this](const std::stop_token& stop) { impl_->run_loops(stop); });
  return DeviceStatus::Running;
}

DeviceStats Autd3Array::stats() const {
  return impl_->stream->stats();
}

std::int64_t Autd3Array::samples() const {
  return impl_->stream->samples();
}

double Autd3Array::play_time(std::int64_t sample) const {
  return impl_->stream->play_time(sample);
}

double Autd3Array::ask_time(std::int64_t sample) const {
  return impl_->stream->ask_time(sample);
}

bool Autd3Array::is_hot() const {
  return impl_->hot.load(std::memory_order_relaxed);
}

std::string Autd3Array::description() const {
  return impl_->description;
}

const Autd3Budget& Autd3Array::budget() const {
  return impl_->budget;
}

int Autd3Array::link_process() const {
  return impl_->link_process.load(std::memory_order_relaxed);
}

}  // namespace prostm
