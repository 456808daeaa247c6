#pragma once
/// The callback in which the vendor's SDK requests control points. Needs the SDK.

#include <atomic>
#include <ultraleap/haptics/streaming.hpp>
#include <vector>

#include "prostm/device/device.hpp"
#include "prostm/device/safety/detail/point_gate.hpp"
#include "prostm/device/ultraleap/detail/play_log.hpp"

namespace prostm {

/// Passes a source's samples to the SDK, in order and each once, in one pass over each interval.
/// Keeps points apart by PointGate, and fades in at a start and out at an end, so that neither
/// clicks. The callback does not allocate, lock or throw; calls after stop() are allowed and emit
/// silence.
class UltraleapEmission {
 public:
  enum class Fault : std::uint8_t {
    None,
    Rate,     ///< the interval between samples is not the one the source was made for
    Stalled,  ///< no callback came for a second
    Sdk       ///< an exception
  };

  struct Setup {
    double rate = 0.0;              ///< of the device [Hz]
    int foci = 1;                   ///< of a sample
    double least_separation = 0.0;  ///< [m]
    double fade_time = 1e-3;        ///< of a fade over the full range [s]
  };

  /// Prepares for a source, which is used until stop(). @pre stopped.
  void start(SampleSource& source, const Setup& setup);
  /// Fades out; returns when the faded samples have left the array, or after 100 ms.
  void fade_out();
  /// Begins to fade out. Any thread.
  void mute() { wanted_.store(0.0F, std::memory_order_relaxed); }
  /// Checks that callbacks still arrive. Any thread. @pre started.
  void watch();
  /// Releases the source, which is not used any more even if callbacks continue.
  void stop();

  /// For the SDK; `emission` is a pointer to this class.
  static void callback(const Ultraleap::Haptics::StreamingEmitter& emitter,
                       Ultraleap::Haptics::OutputInterval& interval,
                       const Ultraleap::Haptics::LocalTimePoint& deadline, void* emission) noexcept;

  const PlayLog& log() const { return log_; }
  std::int64_t late_calls() const { return late_.load(std::memory_order_relaxed); }
  /// Reason why the emission has silenced itself, if it has.
  Fault fault() const { return fault_.load(std::memory_order_acquire); }
  /// Interval between samples when the fault Rate was found [s].
  double found_interval() const { return found_interval_.load(std::memory_order_relaxed); }

 private:
  void emit(Ultraleap::Haptics::OutputInterval& interval,
            const Ultraleap::Haptics::LocalTimePoint& deadline);
  void fail(Fault fault);
  void fill_silence(Ultraleap::Haptics::OutputInterval& interval);
  std::size_t expected(const Ultraleap::Haptics::OutputInterval& interval) const;
  void pull(std::size_t samples);
  void set_points(Ultraleap::Haptics::TimePointOnOutputInterval& point);

  // constant between start() and stop()
  SampleSource* source_ = nullptr;
  Setup setup_;
  float fade_step_ = 1.0F;

  // used by the callback's thread
  PointGate gate_;
  std::vector<FocusSample> block_, now_;   // samples pulled in one piece; the current sample
  std::size_t at_ = 0, end_ = 0;           // samples of block_ that are not used yet
  std::int64_t pulled_ = 0, emitted_ = 0;  // samples
  float gain_ = 0.0F;

  PlayLog log_;
  std::atomic<float> wanted_{0.0F};       // gain to fade to
  std::atomic<double> silent_from_{0.0};  // play time of the first silent sample after mute(), or 0
  std::atomic<bool> open_{false}, inside_{false};  // samples may be emitted; in a callback
  std::atomic<std::size_t> points_{0};             // control points requested from the SDK
  std::atomic<double> last_call_{0.0};             // time of the last call, or of start()
  std::atomic<double> suspected_{0.0};             // time when calls were first missing
  std::atomic<std::int64_t> late_{0};
  std::atomic<Fault> fault_{Fault::None};
  std::atomic<double> found_interval_{0.0};
};

}  // namespace prostm
