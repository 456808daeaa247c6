#include "prostm/device/device.hpp"

#include <numbers>

#include "prostm/emit/emitter.hpp"

namespace prostm {

double DeviceInfo::max_focus_speed() const {
  return kMaxFocusSpeed - std::numbers::sqrt3 * place_unit * sample_rate;
}

}  // namespace prostm
