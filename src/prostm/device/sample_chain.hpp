#pragma once
/// From an emission's samples to those of a device: stages in a row, a limiter last.

#include <atomic>
#include <memory>
#include <vector>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/device/device.hpp"

namespace prostm {

/// Passes on another source's samples, changed or looked at.
class SampleStage : public SampleSource {
 public:
  int foci() const final { return from_->foci(); }

 protected:
  SampleSource& from() { return *from_; }
  /// Sets the source of its samples. @pre nothing pulls.
  virtual void follow(SampleSource& from) { from_ = &from; }

 private:
  friend class SampleChain;
  SampleSource* from_ = nullptr;
};

/// Gives all focal points of a sample the largest intensity, for devices with one shared intensity.
class SharedIntensity final : public SampleStage {
 public:
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;
};

/// Passes on the first of every `factor` samples.
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

struct SampleLimits {
  double power = 4.0;     ///< largest Σ intensity² of a sample
  double change = 0.025;  ///< largest change of an intensity from sample to sample
};

/// Limits the samples that leave for a device, whatever the stages before it do: finite numbers,
/// intensities from 0 to 1 that change by at most `change` a sample, and Σ intensity² of at most
/// `power`. Samples within these limits pass unchanged, to the bit.
class SampleLimiter final : public SampleStage {
 public:
  explicit SampleLimiter(const SampleLimits& limits) : limits_(limits) {}
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;
  /// Number of samples of a focal point that were changed. Any thread.
  std::int64_t limited() const { return limited_.load(std::memory_order_relaxed); }

 private:
  void follow(SampleSource& from) override;
  const SampleLimits limits_;
  std::vector<FocusSample> last_;  // sample of each focal point
  std::atomic<std::int64_t> limited_{0};
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
  }
  std::int64_t limited() const { return limiter_.limited(); }

 private:
  void append(std::unique_ptr<SampleStage> stage);
  SampleSource& source_;
  std::vector<std::unique_ptr<SampleStage>> stages_;
  SampleLimiter limiter_;
};

/// Makes the chain that a device needs: decimated, and with one intensity if it has only one.
std::unique_ptr<SampleChain> make_sample_chain(SampleSource& source, const DeviceInfo& device,
                                               const SampleLimits& limits);

}  // namespace prostm
