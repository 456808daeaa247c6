#include "prostm/device/simulated/simulated_array.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "prostm/core/require.hpp"
#include "prostm/device/detail/block_clock.hpp"
#include "prostm/device/detail/segment_player.hpp"
#include "prostm/device/thread_priority.hpp"

namespace prostm {
namespace {

using SteadyClock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::int64_t kMostWaiting =
    64;  // blocks that may be unpublished while a reader holds the lock

/// Returns the pressure of intensity 1: that of the whole array at full output, 200 mm above its
/// origin [Pa, rms]. 0 if that point is behind the array or on it.
double full_scale_of(const TransducerArray& array, const Medium& medium) {
  const Vec3 middle(0.0, 0.0, 0.2);
  const Wave sound = wave(array, medium);
  double sum = 0.0;
  for (std::size_t i = 0; i < array.position.size(); ++i) {
    if ((array.position[i] - middle).norm() < kNearestPoint) return 0.0;
    sum += std::abs(propagate(array, sound, i, middle));
  }
  return sum;
}

ArrayOutputSettings output_settings(const SimulatedArraySettings& s, const TransducerArray& array,
                                    const Medium& medium) {
  ArrayOutputSettings out;
  out.solver.method = s.solver;
  out.solver.iterations = out.solver.method == FocusMethod::GsPat ? 20 : 1;
  out.solver.full_scale = full_scale_of(array, medium);
  out.transducer.frequency = array.frequency;
  out.transducer.sample_rate = s.sample_rate;
  out.transducer.memoryless = s.memoryless;
  return out;
}

const SimulatedArraySettings& validated(const SimulatedArraySettings& s) {
  require_bounds(s);
  require_between("most_queue_blocks", s.most_queue_blocks, s.queue_blocks, 10);
  if (s.solver != FocusMethod::Weighted && s.solver != FocusMethod::GsPat &&
      s.solver != FocusMethod::Superposition) {
    throw std::invalid_argument("solver = \"" + std::string(name_of(s.solver)) +
                                "\" must be weighted, gs-pat or superposition");
  }
  return s;
}

SteadyClock::duration to_duration(double seconds) {
  return std::chrono::round<SteadyClock::duration>(Seconds(seconds));
}

/// Data of the pulling thread; no other thread accesses it while that thread runs.
struct Stream {
  SampleSource* source = nullptr;
  std::optional<BlockClock> clock;  // in real time
  DeviceStats stats;
  std::int64_t filled = 0;           // samples
  std::vector<FocusSample> waiting;  // blocks that are not published yet
  std::int64_t waiting_blocks = 0;
};

}  // namespace

struct SimulatedArray::Impl {
  Impl(const SimulatedArraySettings& s, const TransducerArray& a, const Medium& m);

  // constant
  const SimulatedArraySettings settings;
  const TransducerArray array;
  const Medium medium;
  DeviceInfo info;
  const std::int64_t history_samples;
  const int most_queue;  // blocks

  // faults
  std::atomic<double> delay{0.0};
  std::atomic<bool> refuses{false};
  std::atomic<std::int64_t> vanish_after{-1};

  // published by the pulling thread, under the mutex
  mutable std::mutex mutex;
  DeviceStatus status = DeviceStatus::Idle;
  std::string problem;
  DeviceStats stats;
  std::optional<BlockClock> clock;
  int foci = 0;
  std::vector<FocusSample> ring;  // sample i lies at (i mod its size in samples)
  std::int64_t filled = 0;        // samples

  Stream stream;
  SegmentPlayer segment;
  std::jthread thread;

  DeviceStatus refuse(const std::string& sentence);
  DeviceStatus begin(SampleSource& s);
  void run(const std::stop_token& stop);
  bool pull_block();
  void publish();
  std::int64_t played() const;
  double time_of(std::int64_t sample, bool played) const;
};

SimulatedArray::Impl::Impl(const SimulatedArraySettings& s, const TransducerArray& a,
                           const Medium& m)
    : settings(validated(s)),
      array(a),
      medium(m),
      info(info_of(s, a)),
      history_samples(static_cast<std::int64_t>(std::ceil(s.history * s.sample_rate))),
      most_queue(std::max(s.queue_blocks, s.most_queue_blocks)) {
  stats.queue_blocks = s.queue_blocks;
}

DeviceStatus SimulatedArray::Impl::refuse(const std::string& sentence) {
  const std::lock_guard lock(mutex);
  problem = sentence;
  if (status != DeviceStatus::Running) status = DeviceStatus::Refused;
  return DeviceStatus::Refused;
}

/// Starts to pull. @pre not running, the source fits.
DeviceStatus SimulatedArray::Impl::begin(SampleSource& s) {
  if (thread.joinable()) thread.join();  // thread of a stream that vanished
  const auto width = static_cast<std::size_t>(s.foci());
  stream = Stream();
  stream.source = &s;
  stream.stats.queue_blocks = settings.queue_blocks;
  stream.waiting.resize(static_cast<std::size_t>(kMostWaiting * settings.block_samples) * width);
  if (settings.realtime) {
    const double period = settings.block_samples / settings.sample_rate;
    stream.clock.emplace(SteadyClock::now(), to_duration(period), settings.queue_blocks,
                         settings.most_queue_blocks);
    stream.stats.queue_blocks = stream.clock->queue_blocks();
  }
  {
    const std::lock_guard lock(mutex);
    foci = s.foci();
    // queued samples are filled and not yet played, so they come on top of the history
    const auto capacity = static_cast<std::size_t>(history_samples + std::int64_t{most_queue + 1} *
                                                                         settings.block_samples);
    ring.assign(capacity * width, FocusSample());
    status = DeviceStatus::Running;
    problem.clear();
    filled = 0;
    publish();
  }
  if (settings.realtime) {
    thread = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  return DeviceStatus::Running;
}

void SimulatedArray::Impl::run(const std::stop_token& stop) {
  raise_thread_priority();
  while (!stop.stop_requested()) {
    std::this_thread::sleep_until(stream.clock->ask_time(stream.stats.blocks) +
                                  to_duration(delay.load()));
    if (stop.stop_requested() || !pull_block()) return;
  }
}

/// Pulls the next block; false when the array has vanished.
bool SimulatedArray::Impl::pull_block() {
  const std::int64_t vanishes = vanish_after.load();
  if (vanishes >= 0 && stream.stats.blocks >= vanishes) {
    const std::lock_guard lock(mutex);
    publish();
    status = DeviceStatus::Vanished;
    problem = "The simulated array vanished after " + std::to_string(stats.blocks) +
              " blocks, as requested; start it again.";
    return false;
  }

  // fill first, then read the clock
  const std::size_t size = stream.waiting.size() / static_cast<std::size_t>(kMostWaiting);
  stream.source->fill(stream.filled,
                      std::span(stream.waiting)
                          .subspan(static_cast<std::size_t>(stream.waiting_blocks) * size, size));
  ++stream.waiting_blocks;
  stream.filled += settings.block_samples;
  if (stream.clock) {
    const BlockClock::Filled result = stream.clock->fill(stream.stats.blocks, SteadyClock::now());
    stream.stats.late_blocks += result.late ? 1 : 0;
    stream.stats.missed_blocks += result.missed;
    stream.stats.queue_blocks = stream.clock->queue_blocks();
  }
  ++stream.stats.blocks;

  // a reader that holds the lock may have been descheduled: in real time, do not wait for it while
  // there is room
  std::unique_lock lock(mutex, std::defer_lock);
  if (settings.realtime && stream.waiting_blocks < kMostWaiting) {
    if (!lock.try_lock()) return true;
  } else {
    lock.lock();
  }
  publish();
  return true;
}

/// Publishes the waiting blocks. @pre the mutex is held, by the pulling thread or while no thread
/// is pulling.
void SimulatedArray::Impl::publish() {
  const auto width = static_cast<std::size_t>(foci);
  const std::size_t capacity = ring.size() / width;
  const std::int64_t samples = stream.waiting_blocks * settings.block_samples;
  for (std::int64_t i = 0; i < samples; ++i) {
    const std::size_t slot = static_cast<std::size_t>(filled + i) % capacity;
    std::copy_n(stream.waiting.begin() + static_cast<std::ptrdiff_t>(i) * foci, width,
                ring.begin() + static_cast<std::ptrdiff_t>(slot * width));
  }
  stream.waiting_blocks = 0;
  filled = stream.filled;
  stats = stream.stats;
  clock = stream.clock;
}

/// Samples that have left the array. @pre the mutex is held.
std::int64_t SimulatedArray::Impl::played() const {
  if (!clock) return filled;
  // the block that plays now is among those in the queue, or the one before them
  const auto now = SteadyClock::now();
  const std::int64_t oldest = std::max<std::int64_t>(0, stats.blocks - most_queue - 1);
  for (std::int64_t block_index = stats.blocks - 1; block_index >= oldest; --block_index) {
    const double age = Seconds(now - clock->play_time(block_index)).count();
    if (age < 0.0) continue;
    const auto within = static_cast<std::int64_t>(age * settings.sample_rate) + 1;
    return block_index * settings.block_samples +
           std::min<std::int64_t>(within, settings.block_samples);
  }
  return oldest * settings.block_samples;
}

SimulatedArray::SimulatedArray(const SimulatedArraySettings& settings, const TransducerArray& array,
                               const Medium& medium)
    : impl_(std::make_unique<Impl>(settings, array, medium)) {}

SimulatedArray::~SimulatedArray() {
  stop();
}

const DeviceInfo& SimulatedArray::info() const {
  return impl_->info;
}

DeviceStatus SimulatedArray::status() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->status;
}

std::string SimulatedArray::problem() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->problem;
}

DeviceStatus SimulatedArray::start(SampleSource& source) {
  if (impl_->refuses) {
    return impl_->refuse("The simulated array refuses to start, as requested.");
  }
  if (status() == DeviceStatus::Running) {
    return impl_->refuse("The simulated array is running already; stop it first.");
  }
  if (source.foci() < 1 || source.foci() > impl_->settings.max_foci) {
    return impl_->refuse("The stream has " + std::to_string(source.foci()) +
                         " focal points a sample; the simulated array plays 1 to " +
                         std::to_string(impl_->settings.max_foci) + ".");
  }
  return impl_->begin(source);
}

void SimulatedArray::stop() {
  if (impl_->thread.joinable()) {
    impl_->thread.request_stop();
    impl_->thread.join();
  }
  const std::lock_guard lock(impl_->mutex);
  if (impl_->stream.waiting_blocks > 0) impl_->publish();
  impl_->stream.source = nullptr;
  impl_->status = DeviceStatus::Idle;
}

DeviceStatus SimulatedArray::load_segment(std::span<const FocusSample> samples, int foci) {
  Impl& impl = *impl_;
  if (impl.refuses) {
    return impl.refuse("The simulated array refuses the segment, as requested.");
  }
  const bool running = status() == DeviceStatus::Running;
  const std::string problem = segment_problem(samples, foci, impl.settings.max_foci);
  if (!problem.empty()) return impl.refuse(problem);
  if (running && (impl.stream.source != &impl.segment || impl.segment.foci() != foci)) {
    return impl.refuse(
        "The simulated array is playing a stream, or a segment with another number of focal "
        "points; "
        "stop it first.");
  }
  if (!running) impl.segment.reset(foci);
  impl.segment.load(samples);
  return running ? DeviceStatus::Running : impl.begin(impl.segment);
}

DeviceStats SimulatedArray::stats() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->stats;
}

double SimulatedArray::Impl::time_of(std::int64_t sample, bool played) const {
  const SimulatedArraySettings& s = settings;
  const std::lock_guard lock(mutex);
  if (!clock) return static_cast<double>(sample) / s.sample_rate;
  const std::int64_t block = sample / s.block_samples;
  const SteadyClock::time_point start = played ? clock->play_time(block) : clock->ask_time(block);
  return Seconds(start.time_since_epoch()).count() +
         static_cast<double>(sample % s.block_samples) / s.sample_rate;
}

double SimulatedArray::play_time(std::int64_t sample) const {
  return impl_->time_of(sample, true);
}

double SimulatedArray::ask_time(std::int64_t sample) const {
  return impl_->time_of(sample, false);
}

void SimulatedArray::set_faults(const SimulatedFaults& faults) {
  impl_->delay = faults.delay;
  impl_->refuses = faults.refuse;
  impl_->vanish_after = faults.vanish_after;
}

void SimulatedArray::pull(int n) {
  for (int i = 0; i < n; ++i) {
    if (status() != DeviceStatus::Running || !impl_->pull_block()) return;
  }
}

std::vector<FocusSample> SimulatedArray::read_back(std::int64_t first, std::int64_t n) const {
  const std::lock_guard lock(impl_->mutex);
  const std::int64_t end = impl_->played();
  const std::int64_t begin = std::max<std::int64_t>(0, end - impl_->history_samples);
  if (n < 0 || first < begin || n > end - first) {
    std::ostringstream text;
    text << "samples " << first << " to " << first + n << " cannot be read back; the kept ones are "
         << begin << " to " << end;
    throw std::out_of_range(text.str());
  }
  const auto width = static_cast<std::size_t>(impl_->foci);
  std::vector<FocusSample> out;
  out.reserve(static_cast<std::size_t>(n) * width);
  for (std::int64_t i = first; i < first + n; ++i) {
    const std::size_t slot = static_cast<std::size_t>(i) % (impl_->ring.size() / width) * width;
    const auto from = impl_->ring.begin() + static_cast<std::ptrdiff_t>(slot);
    out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(width));
  }
  return out;
}

int SimulatedArray::foci() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->foci;
}

std::int64_t SimulatedArray::samples() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->played();
}

std::vector<std::complex<double>> SimulatedArray::output(std::int64_t first, std::int64_t n) const {
  const SimulatedArraySettings& s = impl_->settings;
  ArrayOutput array(impl_->array, impl_->medium, output_settings(s, impl_->array, impl_->medium));
  // in real time the oldest samples may be dropped a moment later
  const auto moment = static_cast<std::int64_t>(s.realtime ? 0.1 * s.sample_rate : 0.0);
  const std::int64_t kept = std::max<std::int64_t>(0, samples() - impl_->history_samples + moment);
  const std::int64_t begin = std::min(first, std::max(kept, first - kLeadIn));
  const std::vector<FocusSample> played = read_back(begin, first + n - begin);
  const auto width = static_cast<std::size_t>(foci());
  std::vector<LiveFocus> foci(width);
  std::vector<std::complex<double>> out;
  out.reserve(static_cast<std::size_t>(n) * array.envelopes().size());
  for (std::size_t i = 0; i < played.size(); i += width) {
    for (std::size_t f = 0; f < width; ++f) foci[f] = {played[i + f].p_D, played[i + f].intensity};
    array.step(foci);
    if (begin + static_cast<std::int64_t>(i / width) < first) continue;
    out.insert(out.end(), array.envelopes().begin(), array.envelopes().end());
  }
  return out;
}

std::vector<double> SimulatedArray::pressure(std::int64_t first, std::int64_t n,
                                             std::span<const Vec3> points) const {
  using Rows = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<std::complex<double>> envelopes = output(first, n);
  const auto transducers = static_cast<Eigen::Index>(impl_->array.position.size());
  const Wave sound = wave(impl_->array, impl_->medium);
  Eigen::MatrixXcd g(transducers, static_cast<Eigen::Index>(points.size()));
  for (Eigen::Index m = 0; m < g.cols(); ++m) {
    for (Eigen::Index i = 0; i < transducers; ++i) {
      g(i, m) = propagate(impl_->array, sound, static_cast<std::size_t>(i),
                          points[static_cast<std::size_t>(m)]);
    }
  }
  const Eigen::Map<const Rows> a(envelopes.data(), static_cast<Eigen::Index>(n), transducers);
  std::vector<double> out(static_cast<std::size_t>(n) * points.size());
  Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      out.data(), a.rows(), g.cols()) = (a * g).cwiseAbs();
  return out;
}

}  // namespace prostm
