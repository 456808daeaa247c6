/// prostm-array/1: any text is an array that survives a round trip, or an InputError.
#include <cstdint>
#include <cstdlib>

#include "prostm/core/input_error.hpp"
#include "prostm/io/array_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  try {
    const TransducerArray array =
        array_from_json({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    validate(array);
    const TransducerArray back = array_from_json(array_to_json(array), "back.json");
    if (back.position.size() != array.position.size()) std::abort();
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
