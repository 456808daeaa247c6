/// Leap recordings: any bytes are a recording or an InputError.

#include <cstddef>
#include <cstdint>

#include "prostm/core/input_error.hpp"
#include "prostm/io/hand/hand_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    prostm::hands_from_leap_json({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const prostm::InputError&) {
  }
  return 0;
}
