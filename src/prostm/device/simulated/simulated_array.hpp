#pragma once
/// An array in memory: it keeps real time, can be read back, and fails on request.

#include <complex>
#include <memory>
#include <vector>

#include "prostm/acoustics/focus/array_output.hpp"
#include "prostm/core/settings.hpp"
#include "prostm/device/device.hpp"

namespace prostm {

struct SimulatedArraySettings {
  double sample_rate = 40e3;  ///< [Hz], 1 kHz to 1 MHz
  int block_samples = 40;     ///< a block is 1 ms; 1..4096
  int max_foci = 8;           ///< 1..8
  /// 1..10; length of the queue while the machine is calm; each block of it adds a block of latency
  /// and covers a block of delay
  int queue_blocks = 3;
  int most_queue_blocks = 10;  ///< queue_blocks..10; first and greatest length of the queue
  double history = 4.0;        ///< duration of the samples kept for reading back [s], up to 600
  bool realtime = true;        ///< false: no thread and no clock; the caller calls pull()
  FocusMethod solver = FocusMethod::Weighted;  ///< for `output`; or Superposition, GsPat
  bool memoryless = false;  ///< transducers follow their drives at once, unlike (A9)

  void visit(SettingsReader& v) const;
  void visit(SettingsWriter& v);
};

/// Faults for tests and demonstrations.
struct SimulatedFaults {
  double delay = 0.0;              ///< every block is requested this much too late [s]
  bool refuse = false;             ///< start and load_segment are refused
  std::int64_t vanish_after = -1;  ///< vanishes after this many blocks; −1 = never
};

/// In real time its own thread pulls a block every block period, on an absolute schedule
/// (BlockClock), and catches up at once when it wakes late. The thread raises its priority if that
/// is allowed (raise_thread_priority), but does not depend on it. Samples count from 0 at each
/// start.
class SimulatedArray final : public Device, public PlayedSamples {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  SimulatedArray(const SimulatedArraySettings& settings, const TransducerArray& array,
                 const Medium& medium);
  ~SimulatedArray() override;

  /// Returns the info of an array with these settings.
  static DeviceInfo info_of(const SimulatedArraySettings& settings, const TransducerArray& array);
  const DeviceInfo& info() const override;
  DeviceStatus status() const override;
  /// Also says why a start or a segment was refused while the array kept running.
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  /// While a segment plays, a new one replaces it at its end; while a stream plays, segments are
  /// refused.
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  std::int64_t samples() const override;
  double play_time(std::int64_t sample) const override;
  double ask_time(std::int64_t sample) const override;
  void pull(int n) override;
  const PlayedSamples* played() const override { return this; }
  /// Returns `foci` focal points per sample, as far back as `history`.
  std::vector<FocusSample> read_back(std::int64_t first, std::int64_t n) const override;
  int foci() const;  ///< per sample, of the running source or segment; 0 before the first

  void set_faults(const SimulatedFaults& faults);

  /// Returns the envelopes of the transducers, (A9), at the ends of samples first … first+n−1 as
  /// they were played, sample-major. They are recomputed, from up to kLeadIn samples before.
  /// @throws std::out_of_range as read_back does.
  std::vector<std::complex<double>> output(std::int64_t first, std::int64_t n) const;
  /// Returns the rms acoustic pressure [Pa] at points for the same samples, sample-major with one
  /// value per point: |Σ envelope · (A1)|.
  /// @throws std::out_of_range as read_back does. @pre no point is within kNearestPoint of a
  /// transducer.
  std::vector<double> pressure(std::int64_t first, std::int64_t n,
                               std::span<const Vec3> points) const;

  /// Samples computed before the requested ones: 10 ms at 40 kHz, after which transducers have rung
  /// down, and earlier solutions have little effect.
  static constexpr std::int64_t kLeadIn = 400;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
