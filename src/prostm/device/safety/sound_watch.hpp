#pragma once
/// When a device's output begins and ends, to the sample.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/emit/focus_sample.hpp"
#include "prostm/emit/mute.hpp"

namespace prostm {

/// The output of a device begins, or ends.
struct SoundChange {
  std::int64_t sample = 0;  ///< the first that sounds, or the first that is silent again
  bool on = false;
  std::int64_t stream = 0;  ///< start of the device that samples count from, from 1
  std::uint64_t label = 0;  ///< as it was when the sound began
};

/// Looks at the samples that leave for a device. A sound begins with the first sample that has an
/// intensity above 0. It ends with the first sample of a silence that a mute holds, or that lasts
/// kSilenceTime: shorter ones belong to modulation and to paths with gaps. The samples' thread
/// neither waits nor allocates.
class SoundWatch {
 public:
  /// Time within which emitter and limiter are silent under a mute [s]. As long after a mute the
  /// end of a sound is known.
  static constexpr double kMuteTime = 0.010;
  static constexpr double kSilenceTime = 0.100;  ///< [s]

  /// @param sample_rate of the device [Hz].
  SoundWatch(std::shared_ptr<const Mute> mute, double sample_rate);

  /// Names what sounds from now on. Call it before the mute is lifted. Any one thread.
  void label(std::uint64_t label) noexcept { label_.store(label, std::memory_order_relaxed); }

  /// Looks at samples first … of `foci` focal points each, in order and without gaps. The device's
  /// thread.
  void look(std::int64_t first, std::span<const FocusSample> out, int foci) noexcept;
  /// The device has stopped: a sound that is on ends after its last sample, and samples count from
  /// 0 again. @pre nothing pulls.
  void end() noexcept;

  /// The start of the device that samples count from now, from 1. Any thread.
  std::int64_t stream() const noexcept { return stream_.load(std::memory_order_acquire); }
  /// Changes that found no room, since nobody read those before. Any thread.
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

  // ---- the reader's thread, if there is one ----
  /// From now on others may wait for what is read.
  void begin_reading() noexcept { read_by_.store(true, std::memory_order_relaxed); }
  /// The oldest change; null without one.
  const SoundChange* front() { return changes_.front(); }
  /// Goes on to the next. @pre front() is not null.
  void pop();

  /// Whether the reader has read all, or nobody reads. Any thread.
  bool is_read() const noexcept;

 private:
  void change(bool on, std::int64_t sample) noexcept;

  const std::shared_ptr<const Mute> mute_;
  const std::int64_t mute_samples_, silence_samples_;
  SpscRing<SoundChange> changes_{256};
  std::atomic<std::uint64_t> label_{0};
  std::atomic<std::int64_t> stream_{1}, lost_{0}, made_{0}, taken_{0};
  std::atomic<bool> read_by_{false};

  // the device's thread
  bool sounds_ = false, was_muted_ = false;
  std::int64_t silent_from_ = 0;  // the sample after the last that sounded
  std::int64_t muted_for_ = 0;    // samples
  std::uint64_t sounding_ = 0;    // label of the sound that is on
};

}  // namespace prostm
