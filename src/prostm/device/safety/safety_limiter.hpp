#pragma once
/// The last stage before every device: keeps all output within its limits.

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "prostm/core/quantity.hpp"
#include "prostm/device/safety/focus_levels.hpp"
#include "prostm/device/safety/head_levels.hpp"
#include "prostm/device/safety/safety_settings.hpp"
#include "prostm/device/sample_stage.hpp"
#include "prostm/emit/mute.hpp"

namespace prostm {

/// Levels of an array, for its limiter. Constant; shared by threads.
struct SafetyLevels {
  /// @throws std::invalid_argument as validate(array) does.
  SafetyLevels(const TransducerArray& array, const Medium& medium, double head_distance);

  FocusLevels focus;
  HeadLevel head;               ///< at full drive
  double radiation_per_square;  ///< radiation pressure over acoustic pressure² [1/Pa]
  double share_low;      ///< smallest amplitude over the largest, after the longest way in air
  double likely_by_low;  ///< likely amplitude over the smallest
  float full_scale;      ///< acoustic pressure of intensity 1, for devices that define it so [Pa]
};

/// Limits on the samples of a chain.
struct SampleLimits {
  double power = 4.0;     ///< largest Σ intensity² of a sample, in addition to the cap
  double change = 0.025;  ///< largest change of an intensity from sample to sample
  SafetySettings caps = {};
  /// Null: the array is unknown, and the caps on levels at focal points and at the head are off.
  std::shared_ptr<const SafetyLevels> levels = nullptr;
  double sample_rate = 40e3;   ///< [Hz]
  bool one_intensity = false;  ///< the device has one intensity for all focal points of a sample
};

/// Reason for changing a sample.
enum class SafetyLimit : std::uint8_t {
  NotFinite,
  OutOfRange,  ///< an intensity outside 0 to 1
  Change,
  Power,
  Place,  ///< a position without known levels: too near to the array, behind or beside it
  Intensity,
  AcousticPressure,
  RadiationPressure,
  MeanRadiationPressure,
  HeadLevel,
  Jump,  ///< held because of a jump, until silent
  Ramp   ///< after the start, and after silence
};
inline constexpr std::size_t kSafetyLimits = 12;

/// Statistics of a limiter. Counts are samples of a focal point. Levels are the largest that were
/// reached, as intervals: from the smallest to the largest amplitude of the sources, and from focal
/// points that do not add up to those that do. Likely values have likely_amplitude(), and focal
/// points that do not add up.
struct SafetyStats {
  std::int64_t not_finite = 0, out_of_range = 0, change = 0, power = 0, place = 0, intensity = 0,
               acoustic_pressure = 0, radiation_pressure = 0, mean_radiation_pressure = 0,
               head_level = 0, jump = 0, ramp = 0;
  /// Acoustic pressure (rms) at a focal point [Pa].
  double acoustic_low = 0.0, acoustic_likely = 0.0, acoustic_high = 0.0;
  double radiation_low = 0.0, radiation_likely = 0.0, radiation_high = 0.0;  ///< [Pa]
  double mean_low = 0.0, mean_high = 0.0;  ///< mean radiation pressure [Pa]
  /// Mean sound level at the head [dB]; 0: silence. The cap applies to the estimate.
  double head_low = 0.0, head_likely = 0.0, head_estimate = 0.0, head_bound = 0.0;
};
template <>
std::span<const Quantity<SafetyStats>> quantities<SafetyStats>();

/// Samples that a limiter changed because of an error of an earlier stage.
std::int64_t erred_samples(const SafetyStats& stats);
/// Samples that it lowered to keep a cap.
std::int64_t capped_samples(const SafetyStats& stats);
/// Name of the cap that lowered most of them.
const char* main_cap(const SafetyStats& stats);

/// Limits the samples that are sent to a device, whatever the earlier stages do.
///
/// Guarantees, for any input: finite numbers; positions with known levels; focal points that move
/// by at most kMaxFocusSpeed (8 m/s) from sample to sample while their intensity is above 0;
/// intensities from 0 to the cap that change by at most `change` per sample; Σ intensity² within
/// both limits; acoustic and radiation pressure of every sample within their caps; the means of
/// radiation pressure and of the level at the head within theirs, over any second and over longer
/// times. Levels are upper bounds: every transducer is assumed to have the largest amplitude of the
/// sources, to be driven with Σ intensity, at most fully, and to arrive in phase. Output takes 50
/// ms to reach its full level after the start, and after 100 ms of silence; intensities up to 1 %
/// count as silence here. A mute silences it within 10 ms.
///
/// Samples within all limits pass unchanged, to the bit, unless a level is within 25 % (in
/// pressure) of its cap: there the limiter lowers intensities whose sum exceeds a full drive, and
/// whose excess has no effect, so that a cap sets in without a step. A focal point that jumps is
/// held at its last position until it is silent; all focal points are held if the device has one
/// intensity for all, or if a cap requires a faster fall than `change`.
class SafetyLimiter final : public SampleStage {
 public:
  explicit SafetyLimiter(const SampleLimits& limits);
  void fill(std::int64_t first, std::span<FocusSample> out) noexcept override;
  /// @pre no thread is pulling.
  void obey(std::shared_ptr<const Mute> mute) noexcept { mute_ = std::move(mute); }

  /// As of the last block. Any thread.
  SafetyStats stats() const;

 private:
  /// Level of a sample.
  struct Level {
    float pressure = 0.0F;  ///< at the loudest focal point, at full drive [Pa]
    float drive = 0.0F;     ///< Σ intensity, in terms of drives; above 1 means full
    float own = 0.0F;       ///< at the loudest focal point, by its own share of the drive [Pa]
    float energy = 0.0F;    ///< of the drives, if focal points do not add up
  };
  /// The largest drive, or factor on all intensities, within a limit.
  struct Allowed {
    float most;
    SafetyLimit limit;
  };
  struct Focus {
    FocusSample last;
    float given = 0.0F;          ///< intensity before limits
    float full_pressure = 0.0F;  ///< at the position of `last` [Pa]
    float wanted_pressure = 0.0F;
  };
  /// A mean over time that is kept within a cap, (G3).
  struct Mean {
    float mean = 0.0F, low = 0.0F;
    float allowed(float cap) const;
    void add(float now, float now_low, float weight);
  };

  void follow(SampleSource& from) override;
  void limit(std::span<FocusSample> now) noexcept;
  void clean(std::size_t focus, FocusSample& now) noexcept;
  bool jumps(std::size_t focus, const FocusSample& now) const noexcept;
  void advance_ramps(std::span<const FocusSample> wanted, bool muted) noexcept;
  Level level(std::span<const FocusSample> samples) const noexcept;
  Allowed cap_drive(float pressure) const noexcept;
  Allowed scale(std::span<const FocusSample> now) const noexcept;
  bool hold_jumps(std::span<FocusSample> now) noexcept;
  void keep_caps(std::span<FocusSample> now) noexcept;
  void hold(std::size_t focus, FocusSample& now) noexcept;
  void hold_all(std::span<FocusSample> now, SafetyLimit reason) noexcept;
  void account(std::span<const FocusSample> now) noexcept;
  void count(SafetyLimit reason, std::int64_t n = 1) noexcept {
    counts_[static_cast<std::size_t>(reason)] += n;
  }
  void publish() noexcept;

  const SampleLimits limits_;
  const float change_, power_, step_, ramp_, mute_fall_, weight_;
  const std::int64_t silence_;  // samples after which a ramp begins
  float head_cap_ = 0.0F;       // of the mean of drive²
  std::shared_ptr<const Mute> mute_;

  std::vector<Focus> focus_;
  bool holding_ = false;  // all focal points are held until they are silent
  SafetyLimit held_for_{};
  float ceiling_, unmuted_ = 1.0F;
  std::int64_t silent_ = 0;  // samples
  Mean radiation_, head_;
  std::array<std::int64_t, kSafetyLimits> counts_{};
  float acoustic_low_ = 0.0F, acoustic_high_ = 0.0F, mean_low_ = 0.0F, mean_high_ = 0.0F,
        head_low_ = 0.0F, head_high_ = 0.0F;

  std::array<std::atomic<std::int64_t>, kSafetyLimits> published_counts_{};
  std::array<std::atomic<float>, 6> published_levels_{};
};

}  // namespace prostm
