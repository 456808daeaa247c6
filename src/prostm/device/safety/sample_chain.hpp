#pragma once
/// Stages that turn an emission's samples into those of a device, with a limiter as the last one.

#include <atomic>
#include <memory>
#include <utility>
#include <vector>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/device/device.hpp"
#include "prostm/device/safety/safety_limiter.hpp"
#include "prostm/device/safety/sound_watch.hpp"
#include "prostm/device/sample_stage.hpp"

namespace prostm {

/// Gives all focal points of a sample the largest intensity, for devices with one shared intensity.
class SharedIntensity final : public SampleStage {
 public:
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;
};

/// Passes on the first of every `factor` samples. It may drop the silent sample within which an
/// emission jumps; the limiter then silences the jump again.
class Decimation final : public SampleStage {
 public:
  explicit Decimation(int factor) : factor_(factor) {}
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

 private:
  void follow(SampleSource& from) override;

  int factor_;
  std::vector<FocusSample> scratch_;
};

/// Passes a copy of every sample to one other thread, as long as that thread keeps up.
class SampleTap final : public SampleStage {
 public:
  /// @param samples capacity of the queue, in samples of one focal point.
  explicit SampleTap(std::size_t samples) : ring_(samples) {}
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

  /// Takes the oldest sample of the queue; false if it is empty. Called by the other thread.
  bool next(FocusSample& out) { return ring_.pop(out); }
  /// Number of samples dropped because the queue was full. Any thread.
  std::int64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  SpscRing<FocusSample> ring_;
  std::atomic<std::int64_t> lost_{0};
};

/// A source, any stages after it, and a limiter that is always the last.
class SampleChain final : public SampleSource {
 public:
  /// @param source outlives this.
  SampleChain(SampleSource& source, const SampleLimits& limits);

  /// Adds a stage after the existing ones, before the limiter. @pre no thread is pulling.
  template <class Stage, class... Args>
  Stage& add(Args&&... args) {
    auto stage = std::make_unique<Stage>(std::forward<Args>(args)...);
    Stage& added = *stage;
    append(std::move(stage));
    return added;
  }

  int foci() const override { return source_.foci(); }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    limiter_.fill(first, out);
    if (watch_ != nullptr) watch_->look(first, out, foci());
  }
  /// Silences the output while the mute is on, whatever the source does. @pre no thread is pulling.
  void obey(std::shared_ptr<const Mute> mute) noexcept { limiter_.obey(std::move(mute)); }
  /// Shows all output to `watch`, which outlives this. @pre no thread is pulling.
  void show(SoundWatch& watch) noexcept { watch_ = &watch; }
  /// Statistics of the limiter. Any thread.
  SafetyStats safety() const { return limiter_.stats(); }
  /// Samples of a focal point that it changed because of a stage's error. Any thread.
  std::int64_t limited() const { return erred_samples(safety()); }

 private:
  void append(std::unique_ptr<SampleStage> stage);
  SampleSource& source_;
  std::vector<std::unique_ptr<SampleStage>> stages_;
  SafetyLimiter limiter_;
  SoundWatch* watch_ = nullptr;
};

/// Makes the chain for a device: with its decimation, and with one shared intensity if the device
/// has only one.
/// @param limits of the emission. The chain uses the device's sample rate, and allows a larger
/// change per sample with decimation, so that the change per time stays the same.
std::unique_ptr<SampleChain> make_sample_chain(SampleSource& source, const DeviceInfo& device,
                                               const SampleLimits& limits);

}  // namespace prostm
