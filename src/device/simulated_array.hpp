#pragma once
/// An array that exists in memory: it keeps real time, can be read back, and can be told to fail.

#include <memory>
#include <vector>

#include "acoustics/array.hpp"
#include "core/settings.hpp"
#include "device/device.hpp"

namespace prostm {

struct SimulatedArraySettings {
  double sample_rate = 40e3;       ///< [Hz]
  int block_samples = 40;          ///< a block is 1 ms
  int max_foci = 8;
  int queue_blocks = 8;            ///< 1..10
  double history = 4.0;            ///< kept for reading back [s]
  bool realtime = true;            ///< false: no thread and no clock, pull() is called by hand

  void visit(SettingsVisitor& v);
};

/// Faults for tests and demonstrations.
struct SimulatedFaults {
  double delay = 0.0;              ///< every block is asked for this much too late [s]
  bool refuse = false;             ///< start and load_segment are refused
  std::int64_t vanish_after = -1;  ///< vanishes after this many blocks; −1 = never
};

class SimulatedArray final : public Device {
 public:
  /// @throws std::invalid_argument with a sentence that names the setting, its value and its bound.
  SimulatedArray(const SimulatedArraySettings& settings, const TransducerArray& array, const Medium& medium);
  ~SimulatedArray() override;

  const DeviceInfo& info() const override;
  DeviceStatus status() const override;
  std::string problem() const override;
  DeviceStatus start(SampleSource& source) override;
  void stop() override;
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override;
  DeviceStats stats() const override;
  double play_time(std::int64_t sample) const override;

  void set_faults(const SimulatedFaults& faults);
  /// Pulls n blocks now. @pre settings.realtime is false, started.
  void pull(int n);

  /// Samples first … first+n−1 as they were played, sample-major with `foci` a sample (0 intensity where
  /// nothing played). What is older than `history` or not yet played is an error. @throws std::out_of_range.
  std::vector<FocusSample> read_back(std::int64_t first, std::int64_t n) const;
  int foci() const;                 ///< per sample, of the running source or segment
  std::int64_t samples() const;     ///< played so far

  /// Complex drive of each transducer for one sample: the naive superposition of one focus per focal point, with
  /// amplitudes from intensities, scaled down by a common factor when any exceeds 1.
  void drives(std::span<const FocusSample> foci, std::vector<std::complex<double>>& out) const;
  /// rms acoustic pressure at points for such drives [Pa].
  std::vector<double> field(std::span<const std::complex<double>> drives, std::span<const Vec3> points) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
