#pragma once
/// The callback in which the vendor's SDK asks for control points. Needs the SDK.

#include <atomic>
#include <ultraleap/haptics/streaming.hpp>
#include <vector>

#include "prostm/device/device.hpp"
#include "prostm/device/safety/detail/point_gate.hpp"
#include "prostm/device/ultraleap/detail/play_log.hpp"

namespace prostm {

/// Gives a source's samples to the SDK, in order and each once, in one walk of each interval. Keeps
/// points apart by PointGate, and rises from silence and falls into it within a fade, so that
/// neither a start nor an end clicks. The callback allocates, locks and throws nothing; it may go
/// on after stop(), and is silent then.
class UltraleapEmission {
 public:
  enum class Fault : std::uint8_t {
    None,
    Rate,     ///< the interval between samples is not what the source was made for
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
  /// Finds out whether callbacks still come. Any thread. @pre started.
  void watch();
  /// Lets go of the source. After this the source is not used, even if callbacks go on.
  void stop();

  /// For the SDK; `emission` is a pointer to this class.
  static void callback(const Ultraleap::Haptics::StreamingEmitter& emitter,
                       Ultraleap::Haptics::OutputInterval& interval,
                       const Ultraleap::Haptics::LocalTimePoint& deadline, void* emission) noexcept;

  const PlayLog& log() const { return log_; }
  std::int64_t late_calls() const { return late_.load(std::memory_order_relaxed); }
  /// Why it has fallen silent by itself, if it has.
  Fault fault() const { return fault_.load(std::memory_order_acquire); }
  /// Interval between samples when the fault Rate was found [s].
  double found_interval() const { return found_interval_.load(std::memory_order_relaxed); }

 private:
  void emit(Ultraleap::Haptics::OutputInterval& interval,
            const Ultraleap::Haptics::LocalTimePoint& deadline);
  void fail(Fault fault);
  void be_silent(Ultraleap::Haptics::OutputInterval& interval);
  std::size_t expected(const Ultraleap::Haptics::OutputInterval& interval) const;
  void pull(std::size_t samples);
  void set_points(Ultraleap::Haptics::TimePointOnOutputInterval& point);

  // constant between start() and stop()
  SampleSource* source_ = nullptr;
  Setup setup_;
  float fade_step_ = 1.0F;

  // the callback's thread
  PointGate gate_;
  std::vector<FocusSample> block_, now_;   // samples waiting in one piece; the one that is set
  std::size_t at_ = 0, end_ = 0;           // samples of block_ that wait
  std::int64_t pulled_ = 0, emitted_ = 0;  // samples
  float gain_ = 0.0F;

  PlayLog log_;
  std::atomic<float> wanted_{0.0F};       // gain to fade to
  std::atomic<double> silent_from_{0.0};  // when the first silent sample after mute() plays; 0: not
  std::atomic<bool> open_{false}, inside_{false};  // samples may be given; a callback is at work
  std::atomic<std::size_t> points_{0};             // control points that the SDK was asked for
  std::atomic<double> last_call_{0.0};             // time, or that of start()
  std::atomic<double> suspected_{0.0};             // time when calls were missed first
  std::atomic<std::int64_t> late_{0};
  std::atomic<Fault> fault_{Fault::None};
  std::atomic<double> found_interval_{0.0};
};

}  // namespace prostm
