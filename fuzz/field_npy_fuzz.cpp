/// NPY fields: any bytes are a valid field or an InputError.
#include <cstdint>

#include "prostm/core/input_error.hpp"
#include "prostm/io/field/field_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  try {
    validate(field_from_npy({reinterpret_cast<const char*>(data), size}, "fuzz.npy", 5.0));
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
