#pragma once
/// Plans as focal points over time: the base of emitters of paths and of foci.

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "prostm/core/quantity.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/emit/focus_sample.hpp"
#include "prostm/emit/mute.hpp"
#include "prostm/plan/focus_speed.hpp"
#include "prostm/plan/lifted_plan.hpp"
#include "prostm/plan/method.hpp"

namespace prostm {

/// Moment when a new plan takes over: at each path's lap end, or at the next block.
enum class SwitchAt : std::uint8_t { Lap, Now };
template <>
inline constexpr std::array<std::string_view, 2> kNames<SwitchAt> = {"lap", "now"};

/// Shape of the intensity a over a period of AM, from 0 to 0 with its peak of 1 in the middle,
/// (B4). `raised-cosine`: a = (1 − cos 2πt)/2; the radiation pressure a² has the mean 3/8, 1/2 at
/// the frequency of the modulation and 1/8 at twice that. `sine-magnitude`: a = |sin πt|, the
/// square root of a raised cosine; so a² is a raised cosine: mean 1/2, 1/2 at the frequency,
/// nothing at twice that.
enum class Waveform : std::uint8_t { RaisedCosine, SineMagnitude };
template <>
inline constexpr std::array<std::string_view, 2> kNames<Waveform> = {"raised-cosine",
                                                                     "sine-magnitude"};

struct EmitSettings {
  int foci = 4;                      ///< focal points, 1..8
  double full_scale_pressure = 0.0;  ///< pressure at intensity 1 [unit of the target]; > 0
  double silent_below = 0.01;        ///< share of full scale under which a sample is silent
  double power_limit = 4.0;          ///< largest Σ intensity² over simultaneous focal points, > 0
  /// largest factor of pressure that compensates tilted skin, (E8), 1 to 4; 1: off
  double tilt_bound = 1.0;
  SwitchAt switch_at = SwitchAt::Lap;  ///< moment when a new plan takes over
  /// time of a fade down or up over the full range [s], at least 40 samples
  double fade_time = 1e-3;
  double stall_time = 0.100;  ///< without a new plan for this long, the output fades [s]
  /// time of that fade and of the one after lose() [s], at most 40 ms
  double stall_fade_time = 0.010;
  // for foci, which need no fades: their modulation falls silent by itself
  double am_frequency = 200.0;  ///< frequency of modulation [Hz], 25 to a 126th of the sample rate
  Waveform am_waveform = Waveform::SineMagnitude;  ///< shape of the intensity

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
  bool operator==(const EmitSettings&) const = default;
};

/// @throws std::invalid_argument with a sentence that names the setting, its value and its bound;
/// the sample rate [Hz] must be 1 kHz to 1 MHz.
void validate(const EmitSettings& settings, double sample_rate);

/// Returns the number of samples in a period of method am's modulation, (B4), rounded. Frequencies
/// are 25 Hz to a 126th of the sample rate, at which intensity changes by less than 1/40 per
/// sample.
/// @throws std::invalid_argument with a sentence for other frequencies.
int am_period(const EmitSettings& settings, double sample_rate);

/// The drive law, (E4): intensity = sqrt(pressure / full scale), since radiation pressure goes with
/// the square of acoustic pressure; clipped to 1, 0 below the silent share and for negative
/// pressure. `saturated` is set when it was clipped. @pre full_scale > 0, both finite.
double drive_intensity(double pressure, double full_scale, double silent_below, bool& saturated);

/// Returns the largest intensity², or share of full scale's radiation pressure, that each of
/// `paths` focal points may have if all request the same, (E4a): min(1, power_limit / paths).
/// @pre paths ≥ 1, power_limit > 0.
double even_share(int paths, double power_limit);

/// A plan's take-over, reported to the pipeline in sample counts.
struct TakeOver {
  std::int64_t plan = 0;             ///< id of the plan
  std::int64_t arrival_sample = 0;   ///< first sample made after it arrived
  std::int64_t first_sample = 0;     ///< first sample that follows it
  std::int64_t redrawn_sample = -1;  ///< sample at which 90 % of its path was drawn; −1: never
};

struct EmitStats {
  std::int64_t samples = 0;    ///< samples emitted, summed over focal points
  std::int64_t saturated = 0;  ///< samples clipped at full scale
  std::int64_t limited = 0;    ///< samples scaled down by the power limit
  std::int64_t faded = 0;      ///< samples in a fade of a transition
  std::int64_t laps_started = 0, laps_cut = 0;
  std::int64_t stalls = 0;         ///< fade-outs because no plan arrived
  std::int64_t refused_plans = 0;  ///< plans with a number that is not finite or out of bounds
  std::int64_t dropped_paths = 0;  ///< paths beyond the number of focal points, not drawn
  std::int64_t changed_paths = 0;  ///< paths played at another period than planned, PlayedPath
  std::int64_t silenced = 0;       ///< samples with a pressure above 0 and under silent_below
  double max_focus_step = 0.0;     ///< largest, between samples with intensity > 1 % [m]
};

/// Share of laps that were not cut short; 1 without laps.
double laps_completed(const EmitStats& stats);
template <>
std::span<const Quantity<EmitStats>> quantities<EmitStats>();

/// Turns plans into samples. submit() and lose() belong to one thread, fill() to another; neither
/// waits.
class Emitter : public SampleSource {
 public:
  ~Emitter() override;

  /// The slot for the next plan; fill it, then submit(). Its previous contents are unspecified.
  /// Planner's thread.
  LiftedPlan& draft();
  /// Hands the draft over; it replaces a plan that the device has not fetched yet. Arc lengths are
  /// computed anew. A plan is counted as refused and treated as lose() if it is of the other method
  /// or has a number that is not finite, a coordinate beyond 10 m, a loop or phase out of bounds,
  /// or pressures that do not match its points. Planner's thread.
  void submit() noexcept;
  /// Fades out within 50 ms, until the next plan. For a hand that is gone or a non-finite number.
  /// Planner's thread.
  void lose() noexcept;
  /// Obeys a mute from the next block on: while it is on, output fades out as after lose(), and
  /// submitted plans are discarded; the first plan after it is played. @pre before the first
  /// fill().
  void obey(std::shared_ptr<const Mute> mute) noexcept;

  int foci() const final;

  /// Takes the oldest unread report; false if all are read. A plan is reported once 90 % of it has
  /// been drawn or no focal point follows it. Keeps 1024 reports; later ones are lost. Planner's
  /// thread.
  bool next_take_over(TakeOver& out);
  /// Returns a copy of the counters as of the last block. Any one thread.
  EmitStats stats() const;

 protected:
  struct Exchange;
  /// @param method method of the plans that it takes. @throws as validate() does.
  Emitter(const EmitSettings& settings, double sample_rate, Method method);
  Exchange& exchange() { return *exchange_; }

 private:
  std::unique_ptr<Exchange> exchange_;
};

/// Makes an emitter for the plans of a method. @param max_speed of an audible focal point, above 0
/// and at most kMaxFocusSpeed [m/s]. @throws as its constructor does.
std::unique_ptr<Emitter> make_emitter(Method method, const EmitSettings& settings,
                                      double sample_rate, double max_speed = kMaxFocusSpeed);

}  // namespace prostm
