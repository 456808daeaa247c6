#pragma once
/// From a stimulus to the vibration of the skin, (X2) to (X5) of docs/design/psychophysics.md.

#include <complex>
#include <functional>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/experiments/stimuli.hpp"
#include "prostm/psychophysics/presented_stimulus.hpp"

namespace prostm {

/// Returns an array whose amplitude is the measured one. @pre it has one
TransducerArray at_measured_amplitude(TransducerArray array);

/// The steady vibration of a patch of skin under a periodic pressure.
struct Vibration {
  SkinPatch patch;
  double period = 0.0;  ///< [s]
  int harmonics = 0;
  std::vector<std::complex<double>> displacement;  ///< W_n, harmonics × cells [m]
  std::vector<std::complex<double>> pressure;      ///< P_n, harmonics × cells [Pa]
  std::vector<double> mean, largest;               ///< pressure of each cell over time [Pa]

  double frequency(int n) const { return n / period; }
};

/// Returns the vibration of a computed response to a loop.
Vibration vibration_of(const SkinMotion& motion, const PressureLoop& loop);

/// One moment of a stimulus: a vibration, for a time.
using OnMoment = std::function<void(const Vibration& vibration, double duration)>;

/// Presents stimuli with the array at full drive, and computes what they do to the skin.
class Presenter {
 public:
  Presenter(const SkinSettings& skin, TransducerArray array);
  ~Presenter();

  /// Calls `on_moment` for each moment of a stimulus. @param height of the skin above the array
  /// [m]. Nothing for AmPoints without points.
  void present(const PresentedStimulus& stimulus, double height, const OnMoment& on_moment);

 private:
  using Lap = experiments::Lap;
  const experiments::StmField& stm_field(const experiments::Palm& palm);
  void vibrate(const experiments::Palm& palm, double period, int samples,
               const std::vector<double>& pressure, double duration, const OnMoment& on_moment);
  void present_am(const AmPoints& am, double height, double duration, const OnMoment& on_moment);
  void present_stm(const StmLoop& loop, double height, const OnMoment& on_moment);
  void present_disk(const Disk& disk, const OnMoment& on_moment);
  void present_course(const SlowPath& course, double height, const OnMoment& on_moment);
  void present_sweep(const Sweep& sweep, double height, const OnMoment& on_moment);

  SkinModel skin_;
  TransducerArray array_;
  std::map<std::tuple<int, int, double>, std::unique_ptr<experiments::StmField>> fields_;
  std::map<std::tuple<double, int, int, int>, std::unique_ptr<SkinResponse>> responses_;
};

}  // namespace prostm
