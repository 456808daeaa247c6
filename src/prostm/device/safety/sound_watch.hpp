#pragma once
/// Detects when a device's output begins and ends, to the sample.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/emit/focus_sample.hpp"
#include "prostm/emit/mute.hpp"

namespace prostm {

/// A begin or an end of a device's output.
struct SoundChange {
  std::int64_t sample = 0;  ///< the first audible one, or the first silent one again
  bool on = false;
  std::int64_t stream = 0;  ///< number of the device's start, from 1; samples count from it
  std::uint64_t label = 0;  ///< label at the beginning of the sound
};

/// Inspects the samples that are sent to a device. A sound begins with the first sample that has an
/// intensity above 0. It ends with the first sample of a silence that is due to a mute or lasts for
/// kSilenceTime; shorter silences belong to modulation and to paths with gaps. Never blocks or
/// allocates in the device's thread.
class SoundWatch {
 public:
  /// Time within which a mute silences emitter and limiter [s]. The end of a sound is known this
  /// long after a mute.
  static constexpr double kMuteTime = 0.010;
  static constexpr double kSilenceTime = 0.100;  ///< [s]

  /// @param sample_rate of the device [Hz].
  SoundWatch(std::shared_ptr<const Mute> mute, double sample_rate);

  /// Sets the label of sounds that begin from now on. Call it before unmuting. Any one thread.
  void label(std::uint64_t label) noexcept { label_.store(label, std::memory_order_relaxed); }

  /// Inspects samples from `first` on, of `foci` focal points each, in order and without gaps.
  /// Called by the device's thread.
  void look(std::int64_t first, std::span<const FocusSample> out, int foci) noexcept;
  /// Call it when the device has stopped: a current sound ends after its last sample, and samples
  /// count from 0 again. @pre no thread is pulling.
  void end() noexcept;

  /// Number of the device's current start, from 1. Any thread.
  std::int64_t stream() const noexcept { return stream_.load(std::memory_order_acquire); }
  /// Changes dropped because the queue of unread ones was full. Any thread.
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

  // ---- the reader's thread, if there is one ----
  /// Announces a reader, so that is_read() reports its progress.
  void begin_reading() noexcept { read_by_.store(true, std::memory_order_relaxed); }
  /// The oldest unread change; null if there is no such change.
  const SoundChange* front() { return changes_.front(); }
  /// Removes the oldest change. @pre front() is not null.
  void pop();

  /// Whether the reader has read everything, or there is no reader. Any thread.
  bool is_read() const noexcept;

 private:
  void change(bool on, std::int64_t sample) noexcept;

  const std::shared_ptr<const Mute> mute_;
  const std::int64_t mute_samples_, silence_samples_;
  SpscRing<SoundChange> changes_{256};
  std::atomic<std::uint64_t> label_{0};
  std::atomic<std::int64_t> stream_{1}, lost_{0}, made_{0}, taken_{0};
  std::atomic<bool> read_by_{false};

  // used by the device's thread
  bool sounds_ = false, was_muted_ = false;
  std::int64_t silent_from_ = 0;  // the sample after the last audible one
  std::int64_t muted_for_ = 0;    // samples
  std::uint64_t sounding_ = 0;    // label of the current sound
};

}  // namespace prostm
