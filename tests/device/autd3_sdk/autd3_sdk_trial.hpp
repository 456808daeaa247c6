#pragma once
/// Helpers for tests of the AUTD3 SDK's device: a source, and start-up with the stand-in.

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>

#include "device/autd3_sdk/autd3_sdk_units.hpp"
#include "prostm/device/autd3_sdk/autd3_sdk_array.hpp"
#include "prostm/fields/moving_foci.hpp"
#include "support/eventually.hpp"
#include "support/heap_guard.hpp"

namespace prostm::test {

inline void sleep(int time) {
  std::this_thread::sleep_for(std::chrono::milliseconds(time));
}

/// Time of the steady clock [ns].
inline std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

/// Focal points at up to 7 m/s, and the heap allocations between its calls.
class Moving final : public SampleSource {
 public:
  explicit Moving(int foci) : moving_(3, foci, 0.03) {}
  void set_rate(double rate) { rate_ = rate; }

  int foci() const override { return moving_.count(); }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    if (guard_) allocations_ = static_cast<int>(guard_->allocations());
    const auto width = static_cast<std::size_t>(foci());
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::int64_t sample = first + static_cast<std::int64_t>(i / width);
      const int focus = static_cast<int>(i % width);
      out[i] = {position(sample, focus).cast<float>(), 0.7F};
    }
    filled_ = first + static_cast<std::int64_t>(out.size() / width);
    if (!guard_) guard_.emplace();
  }
  Vec3 position(std::int64_t sample, int focus) const {
    return moving_.position(focus, static_cast<double>(sample) / rate_);
  }
  int allocations() const { return allocations_; }
  std::int64_t filled() const { return filled_; }

 private:
  fields::MovingFoci moving_;
  double rate_ = 10e3;
  std::optional<HeapGuard> guard_;
  std::atomic<int> allocations_{-1};
  std::atomic<std::int64_t> filled_{0};
};

/// Opens an array; retries if the machine was too busy for the stand-in to answer in time.
inline std::unique_ptr<Autd3SdkArray> opened(const Autd3SdkSetup& setup) {
  for (int tries = 1;; ++tries) {
    try {
      return std::make_unique<Autd3SdkArray>(setup);
    } catch (const std::invalid_argument&) {
      if (tries == 40) throw;
    }
  }
}

/// Starts the array, likewise.
inline DeviceStatus started(Device& array, SampleSource& source) {
  DeviceStatus status = array.start(source);
  for (int i = 0; i < 10 && status != DeviceStatus::Running; ++i) status = array.start(source);
  return status;
}

/// Time of the last non-silent sample [s, steady clock].
inline double sounding(SdkUnits& chain) {
  return chain.report()["last_sounding_ns"].get<double>() * 1e-9;
}

inline bool sounds_again(SdkUnits& chain, double since) {
  return eventually([&] { return sounding(chain) > since; });
}

}  // namespace prostm::test
