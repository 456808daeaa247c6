/// prostm-pose/1: any text is a pose that survives a round trip, or an InputError.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "prostm/core/input_error.hpp"
#include "prostm/io/hand/pose_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  try {
    const Calibration pose =
        pose_from_json({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    const Calibration back = pose_from_json(pose_to_json(pose), "back.json");
    if (!((back.X_DT.matrix() - pose.X_DT.matrix()).norm() < 1e-9)) std::abort();
    if (!(std::abs(pose.X_DT.linear().determinant() - 1.0) < 1e-9)) std::abort();
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
