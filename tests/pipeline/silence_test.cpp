// How long the array keeps emitting after each event that must silence it, in real time.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>

#include "interrupt.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/pipeline/runner.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

using test::eventually;

constexpr double kStated = 0.050, kSilent = 0.110;  // [s]
constexpr double kNever = 1e9;                      // [s]
constexpr float kLargestChange = 0.02505F;          // of an intensity, between samples

/// Checks that an event silences the array in time. Load on the machine only lengthens the measured
/// time, so one of a few trials must be in time. None may click.
/// @param trial returns the time from the event to the last non-zero sample handed over [s].
template <class Trial>
void expect_silence(const char* event, double within, const Trial& trial) {
  double least = kNever;
  int trials = 0;
  while (least > within && trials < 8 && !testing::Test::HasFailure()) {
    least = std::min(least, trial());
    ++trials;
  }
  std::printf("%-34s last sound handed over %5.1f ms later (trial %d)\n", event, 1e3 * least,
              trials);
  EXPECT_LE(least, within) << event;
}

/// An array that takes a block each millisecond, and records when it last got a non-zero one.
class NotedArray final : public Device {
 public:
  NotedArray() {
    info_ = {.name = "noted", .sample_rate = 40e3, .block_samples = 40, .max_foci = 4};
    info_.intensity_per_focus = info_.streams = true;
  }
  ~NotedArray() override { stop(); }
  const DeviceInfo& info() const override { return info_; }
  DeviceStatus status() const override {
    return running ? DeviceStatus::Running : DeviceStatus::Idle;
  }
  std::string problem() const override { return {}; }
  DeviceStatus start(SampleSource& source) override {
    running = true;
    thread_ = std::jthread([this, &source](const std::stop_token& stop) { play(source, stop); });
    return DeviceStatus::Running;
  }
  void stop() override {
    thread_ = {};
    running = false;
  }
  DeviceStatus load_segment(std::span<const FocusSample>, int) override {
    return DeviceStatus::Refused;
  }
  DeviceStats stats() const override {
    DeviceStats stats;
    stats.blocks = blocks_;
    return stats;
  }
  std::int64_t samples() const override { return blocks_ * info_.block_samples; }
  double play_time(std::int64_t sample) const override {
    return started_ + static_cast<double>(sample) / info_.sample_rate;
  }
  bool is_hot() const override { return hot; }

  bool sounds() const { return steady_now() - last_sound < 0.005 && loud; }
  /// Waits until it emits; false if it never does.
  bool sounding() const {
    return eventually([this] { return sounds(); });
  }

  std::atomic<bool> hot{false}, running{false}, loud{false};
  std::atomic<double> last_sound{-kNever};  // handed over [s of the clock]
  std::atomic<float> largest_change{0.0F};  // of an intensity, between samples
  std::atomic<bool> finite{true};

 private:
  void play(SampleSource& source, const std::stop_token& stop) {
    const auto foci = static_cast<std::size_t>(source.foci());
    std::vector<FocusSample> block(40 * foci), last(foci);
    started_ = steady_now();
    for (auto at = std::chrono::steady_clock::now(); !stop.stop_requested();
         at += std::chrono::milliseconds(1)) {
      std::this_thread::sleep_until(at);
      source.fill(samples(), block);
      float most = 0.0F;
      for (std::size_t i = 0; i < block.size(); ++i) {
        const FocusSample& now = block[i];
        const bool known = std::isfinite(now.intensity) && std::isfinite(now.p_D.x()) &&
                           std::isfinite(now.p_D.y()) && std::isfinite(now.p_D.z());
        if (!known) finite = false;
        const float change = std::abs(now.intensity - last[i % foci].intensity);
        largest_change = std::max(largest_change.load(), change);
        most = std::max(most, now.intensity);
        last[i % foci] = now;
      }
      if (most > 0.0F) last_sound = steady_now();
      loud = most > 0.1F;
      ++blocks_;
    }
  }

  DeviceInfo info_;
  std::jthread thread_;
  std::atomic<std::int64_t> blocks_{0};
  std::atomic<double> started_{0.0};
};

/// The scripted hand, held still until told otherwise.
class Told final : public HandSource {
 public:
  explicit Told(const PipelineSettings& s) : hand_(make_scripted_hand(s.scripted_hand, s.track)) {}
  void sample(double time, HandFrame& out) override {
    if (blocks) {
      blocked_at = steady_now();
      std::this_thread::sleep_for(std::chrono::milliseconds(400));
      blocks = false;
    }
    const bool was_gone = gone;
    if ((throws || was_gone) && lost_at == 0.0) lost_at = steady_now();
    if (throws) throw std::runtime_error("the hand failed");
    hand_->sample(time, out);
    if (was_gone) out.hands.clear();
  }
  /// Waits for the first step without a hand. Returns its time.
  double lost() const {
    EXPECT_TRUE(eventually([this] { return lost_at > 0.0; }));
    return lost_at;
  }
  std::atomic<bool> gone{false}, blocks{false}, throws{false};
  std::atomic<double> blocked_at{0.0}, lost_at{0.0};  // [s of the clock]

 private:
  std::unique_ptr<HandSource> hand_;
};

class Onlooker final : public RunObserver {
 public:
  bool on_plan(const WorldFrame&, const PlanFrame& plan) override {
    if (plan.status == PlanStatus::Planned) planned_at = steady_now();
    return goes_on();
  }
  bool on_progress(double) override { return goes_on(); }
  std::atomic<bool> stop{false};
  std::atomic<double> planned_at{0.0};  // [s of the clock]

 private:
  bool goes_on() const { return !stop && !interrupt_.requested(); }
  app::Interrupt interrupt_;
};

PipelineSettings small_and_still() {
  PipelineSettings settings;
  settings.fluid.cells = 32;
  settings.plan.preset = Preset::Fast;
  settings.scripted_hand.still = true;
  return settings;
}

/// A run in real time with output.
struct SoundingRun {
  SoundingRun() {
    auto told = std::make_unique<Told>(settings);
    hands = told.get();
    auto noted = std::make_unique<NotedArray>();
    device = noted.get();
    pipeline = std::make_unique<Pipeline>(settings, std::move(told), mute, std::move(noted));
    thread = std::jthread([this] {
      summary = run(*pipeline, settings, {3600.0, RunMode::RealTime}, observer);
    });
  }
  ~SoundingRun() {
    observer.stop = true;
    if (thread.joinable()) thread.join();
  }
  /// Waits until it has been silent for a while. Returns the time of the last sound after `since`.
  double silence_after(double since) const {
    EXPECT_TRUE(eventually([this] { return steady_now() - device->last_sound > 0.2; }));
    return device->last_sound - since;
  }
  /// The same; also checks that nothing clicked.
  double faded_after(double since) const {
    const double after = silence_after(since);
    EXPECT_LE(device->largest_change, kLargestChange);
    EXPECT_TRUE(device->finite);
    return after;
  }

  PipelineSettings settings = small_and_still();
  std::shared_ptr<Mute> mute = std::make_shared<Mute>();
  Told* hands = nullptr;
  NotedArray* device = nullptr;
  Onlooker observer;
  std::unique_ptr<Pipeline> pipeline;
  RunSummary summary;
  std::jthread thread;
};

TEST(Silence, FollowsALostHandAndAMute) {
  SoundingRun run;
  expect_silence("hand gone", kStated, [&] {
    run.hands->gone = false;
    EXPECT_TRUE(run.device->sounding());
    run.hands->lost_at = 0.0;
    run.hands->gone = true;
    return run.faded_after(run.hands->lost());
  });
  run.hands->gone = false;
  expect_silence("muted by a person", kStated, [&] {
    run.mute->set(MuteReason::Person, false);
    EXPECT_TRUE(run.device->sounding());
    const double since = steady_now();
    run.mute->set(MuteReason::Person, true);
    return run.faded_after(since);
  });
  run.mute->set(MuteReason::Person, false);
  EXPECT_TRUE(run.device->sounding());
}

TEST(Silence, LastsUntilAHotDeviceHasCooled) {
  SoundingRun run;
  expect_silence("device hot", kStated, [&] {
    run.device->hot = false;
    EXPECT_TRUE(run.device->sounding());
    const double since = steady_now();
    run.device->hot = true;
    return run.faded_after(since);
  });
  EXPECT_TRUE(run.mute->on(MuteReason::Hot));
  const double cooled = steady_now();
  run.device->hot = false;
  ASSERT_TRUE(run.device->sounding());
  EXPECT_GE(steady_now() - cooled, 0.9) << "a flickering flag must not pulse the array";
  EXPECT_FALSE(run.mute->on(MuteReason::Hot));
}

TEST(Silence, FollowsAStallOfThePlans) {
  SoundingRun run;
  expect_silence("plans stall, from the last plan", kSilent, [&] {
    EXPECT_TRUE(eventually([&] { return !run.hands->blocks && run.device->sounds(); }));
    run.hands->blocked_at = 0.0;
    run.hands->blocks = true;
    EXPECT_TRUE(eventually([&] {
      return run.hands->blocked_at > 0.0 && steady_now() - run.device->last_sound > 0.05;
    }));
    return run.device->last_sound - run.observer.planned_at;
  });
  EXPECT_LE(run.device->largest_change, kLargestChange);
}

TEST(Silence, FollowsAStopEvenIfAThreadHangs) {
  expect_silence("stopped while hands are held up", kStated, [] {
    SoundingRun run;
    EXPECT_TRUE(run.device->sounding());
    run.hands->blocks = true;
    EXPECT_TRUE(eventually([&] { return run.hands->blocked_at > 0.0; }));
    const double since = steady_now();
    run.observer.stop = true;
    return run.faded_after(since);
  });
}

TEST(Silence, FollowsTheFailureOfAStage) {
  expect_silence("hands throw", kStated, [] {
    SoundingRun run;
    EXPECT_TRUE(run.device->sounding());
    run.hands->throws = true;
    EXPECT_TRUE(eventually([&] { return !run.device->running; }));
    return run.faded_after(run.hands->lost());
  });
}

/// Puts one path, or one focus, at x.
void submit(Emitter& emitter, Method method, double x) {
  LiftedPlan& plan = emitter.draft();
  plan.paths.clear();
  plan.foci.clear();
  if (method == Method::Am) {
    plan.foci.push_back({Vec3(x, 0.0, 0.2), 1.0});
  } else {
    LiftedPath& path = plan.paths.emplace_back();
    path.speed = 7.0;
    for (const double y : {0.0, 0.02, 0.04}) {
      path.p_D.emplace_back(x, y, 0.2);
      path.pressure.push_back(1.0);
    }
  }
  emitter.submit();
}

TEST(Silence, FollowsAPlanThatIsNotFinite) {
  for (const Method method : {Method::ProStm, Method::Am}) {
    const bool is_am = method == Method::Am;
    EmitSettings settings;
    settings.full_scale_pressure = 1.0;
    const auto emitter = make_emitter(method, settings, 40e3);
    SampleChain chain(*emitter,
                      {.levels = std::make_shared<const SafetyLevels>(usx_array(), Medium{}, 0.5)});
    NotedArray device;
    device.start(chain);
    expect_silence(is_am ? "plan of foci with a NaN" : "plan of paths with a NaN", kStated, [&] {
      EXPECT_TRUE(eventually([&] {
        submit(*emitter, method, 0.0);
        return device.sounds();
      }));
      const double since = steady_now();
      submit(*emitter, method, std::numeric_limits<double>::quiet_NaN());
      EXPECT_TRUE(eventually([&] { return steady_now() - device.last_sound > 0.1; }));
      return device.last_sound - since;
    });
    EXPECT_LE(device.largest_change, kLargestChange);
    EXPECT_TRUE(device.finite);
    device.stop();
  }
}

/// Results of a child process.
struct Seen {
  double after = kNever;  // [s]
  float change = 1.0F;
  bool sounded = false, ended = false;
};

/// A run in its own process, since a second signal ends a process at once.
Seen seen_after(int signal) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    Seen seen;
    {
      SoundingRun run;
      seen.sounded = run.device->sounding();
      const double since = steady_now();
      kill(getpid(), signal);
      run.thread.join();
      seen.ended = run.summary.stopped && !run.device->running;
      seen.after = run.device->last_sound - since;
      seen.change = run.device->largest_change;
    }
    const auto written = write(ends[1], &seen, sizeof seen);
    _exit(written == sizeof seen ? 0 : 1);
  }
  close(ends[1]);
  Seen seen;
  if (read(ends[0], &seen, sizeof seen) != sizeof seen) seen = {};
  close(ends[0]);
  waitpid(child, nullptr, 0);
  return seen;
}

TEST(Silence, FollowsEachSignalWithAFade) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    expect_silence(strsignal(signal), kStated, [signal] {
      const Seen seen = seen_after(signal);
      EXPECT_TRUE(seen.sounded && seen.ended);
      EXPECT_LE(seen.change, kLargestChange);
      return seen.after;
    });
  }
}

}  // namespace
}  // namespace prostm
