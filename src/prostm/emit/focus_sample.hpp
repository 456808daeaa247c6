#pragma once
/// Input of a device: at each of its sample times, a position and an intensity per focal point.

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace prostm {

struct FocusSample {
  Eigen::Vector3f p_D = Eigen::Vector3f::Zero();  ///< [m]
  float intensity = 0.0F;                         ///< 0..1, linear in acoustic pressure amplitude
};

/// An endless source of samples. `fill` is called by the device, on its own thread, with
/// consecutive samples.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  /// Focal points per sample.
  virtual int foci() const = 0;
  /// Fills samples first … first+n−1, sample-major (out[s·foci + f]), out.size() = n·foci.
  /// Allocates, locks and throws nothing.
  virtual void fill(std::int64_t first, std::span<FocusSample> out) noexcept = 0;
};

}  // namespace prostm
