/// Neutral hand recordings: any bytes are a recording or an InputError.

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "prostm/core/input_error.hpp"
#include "prostm/io/hand/hand_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // most inputs would fail at the header, so the first test supplies it
  std::string text = R"({"format":"hand-frames","version":1,"units":"m"})";
  text += '\n';
  text.append(reinterpret_cast<const char*>(data), size);
  try {
    prostm::hands_from_jsonl(text, "fuzz");
  } catch (const prostm::InputError&) {
  }
  try {
    prostm::hands_from_jsonl({reinterpret_cast<const char*>(data), size}, "fuzz");
  } catch (const prostm::InputError&) {
  }
  return 0;
}
