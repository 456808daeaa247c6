#pragma once
/// From an emission's samples to those of a device: stages in a row, a limiter last.

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

/// Passes on the first of every `factor` samples. A sample in which an emission falls silent to
/// jump may be dropped; the limiter silences the jump again.
class Decimation final : public SampleStage {
 public:
  explicit Decimation(int factor) : factor_(factor) {}
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

 private:
  void follow(SampleSource& from) override;

  int factor_;
  std::vector<FocusSample> scratch_;
};

/// Hands a copy of every sample to one other thread, as long as that keeps up.
class SampleTap final : public SampleStage {
 public:
  /// @param samples number that may wait, each of one focal point.
  explicit SampleTap(std::size_t samples) : ring_(samples) {}
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;

  /// Takes the oldest waiting sample; false if no sample waits. The other thread.
  bool next(FocusSample& out) { return ring_.pop(out); }
  /// Number of samples that found no room. Any thread.
  std::int64_t lost() const { return lost_.load(std::memory_order_relaxed); }

 private:
  SpscRing<FocusSample> ring_;
  std::atomic<std::int64_t> lost_{0};
};

/// A source, any stages after it, and a limiter that stays the last.
class SampleChain final : public SampleSource {
 public:
  /// @param source outlives this.
  SampleChain(SampleSource& source, const SampleLimits& limits);

  /// Adds a stage after the existing ones, before the limiter. @pre nothing pulls.
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
  /// Falls silent while this is on, whatever the source does. @pre nothing pulls.
  void obey(std::shared_ptr<const Mute> mute) noexcept { limiter_.obey(std::move(mute)); }
  /// Lets somebody look at what leaves; it outlives this. @pre nothing pulls.
  void show(SoundWatch& watch) noexcept { watch_ = &watch; }
  /// Work of the limiter. Any thread.
  SafetyStats safety() const { return limiter_.stats(); }
  /// Samples of a focal point that it changed because a stage erred. Any thread.
  std::int64_t limited() const { return erred_samples(safety()); }

 private:
  void append(std::unique_ptr<SampleStage> stage);
  SampleSource& source_;
  std::vector<std::unique_ptr<SampleStage>> stages_;
  SafetyLimiter limiter_;
  SoundWatch* watch_ = nullptr;
};

/// Makes the chain that a device needs: decimated, and with one intensity if it has only one.
/// @param limits of the emission: the rate is the device's, and with decimation samples may change
/// more, so that the change in time stays the same.
std::unique_ptr<SampleChain> make_sample_chain(SampleSource& source, const DeviceInfo& device,
                                               const SampleLimits& limits);

}  // namespace prostm
