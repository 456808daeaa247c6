/// A participant's file: any text gives whole lines, whose answers have names, or an InputError.
/// The rest after the last whole line is returned.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "prostm/core/input_error.hpp"
#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/session/response_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  const std::string_view text{reinterpret_cast<const char*>(data), size};
  try {
    std::string cut_off;
    responses_from_text(text, "fuzz.jsonl", &cut_off);
    if (!text.ends_with(cut_off) || cut_off.find('\n') != std::string::npos) std::abort();
    std::vector<std::string> notes;
    answers_from_responses(text, "fuzz.jsonl", notes);
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
