/// prostm-field/1: any text is a valid field that survives a round trip, or an InputError.
#include <cstdint>
#include <cstdlib>

#include "prostm/core/input_error.hpp"
#include "prostm/io/field/field_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  try {
    const TargetField field =
        field_from_json({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    validate(field);
    const TargetField back = field_from_json(field_to_json(field), "back.json");
    if (back.pressure != field.pressure || back.skin != field.skin || back.weight != field.weight)
      std::abort();
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
