/// Messages of a live Leap service: any bytes give plausible hands, or a message about the problem.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "prostm/track/live/leap_frame.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  prostm::HandFrame frame;
  prostm::HandFaults faults;
  const auto kind =
      prostm::leap_message({reinterpret_cast<const char*>(data), size}, frame, faults);
  if ((kind == prostm::LeapMessage::Refused) != (faults.frames() == 1)) std::abort();
  if (kind != prostm::LeapMessage::Frame) return 0;
  for (const prostm::Hand& hand : frame.hands) {
    for (const prostm::Vec3& p : hand.position) {
      if (!p.allFinite() || p.norm() > 2.0) std::abort();
    }
    for (const prostm::Quat& q : hand.orientation) {
      if (!(q.norm() > 0.999 && q.norm() < 1.001)) std::abort();
    }
  }
  return 0;
}
