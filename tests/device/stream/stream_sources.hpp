#pragma once
/// Sources of samples for tests of the stream.

#include <atomic>
#include <cstdint>
#include <optional>

#include "prostm/emit/focus_sample.hpp"
#include "support/heap_guard.hpp"

namespace prostm::test {

/// Samples that carry their index, modulo kCycle, and that of the focal point.
class NumberedSource final : public SampleSource {
 public:
  static constexpr std::int64_t kCycle = 1 << 20;

  explicit NumberedSource(int foci = 2) : foci_(foci) {}
  int foci() const override { return foci_; }
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override {
    if (!guard_) guard_.emplace();
    allocations = guard_->allocations();
    const auto width = static_cast<std::size_t>(foci_);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const std::int64_t sample = first + static_cast<std::int64_t>(i / width);
      out[i].p_D =
          Eigen::Vector3f(static_cast<float>(sample % kCycle), static_cast<float>(i % width), 0.2F);
      out[i].intensity = intensity;
    }
    filled = first + static_cast<std::int64_t>(out.size() / width);
  }

  std::atomic<float> intensity{0.5F};
  std::atomic<std::size_t> allocations{0};  ///< on the thread that pulls, since the first block
  std::atomic<std::int64_t> filled{0};

 private:
  int foci_;
  std::optional<HeapGuard> guard_;
};

}  // namespace prostm::test
