#pragma once
/// Silences the samples at which focal points jump.

#include <span>
#include <vector>

#include "prostm/emit/focus_sample.hpp"

namespace prostm {

/// An emission fades a focal point out before it jumps, and in after it. Where samples are taken
/// out, the silent one may be among them; this puts it back. A focal point jumps if its step is
/// larger than `longest` and more than twice the step before, so that paths of up to six times that
/// speed sound. Allocates nothing after reset().
class JumpGuard {
 public:
  /// @param longest step that never counts as a jump [m].
  void reset(int foci, double longest);
  /// Sets intensities of a sample to 0 where needed, and of the first one.
  void apply(std::span<FocusSample> sample) noexcept;

 private:
  struct Last {
    Eigen::Vector3f p_D = Eigen::Vector3f::Zero();
    float step = 0.0F;
    bool known = false;
  };
  std::vector<Last> last_;
  float longest_ = 0.0F;
};

}  // namespace prostm
