/// A page's text message: any bytes are a message within its bounds, or give an error message.
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "prostm/viewer/page_message.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  PageMessage message;
  std::string problem;
  if (!read_page_message({reinterpret_cast<const char*>(data), size}, message, problem)) {
    if (problem.empty()) std::abort();
    return 0;
  }
  if (const auto* hand = std::get_if<HandMessage>(&message)) {
    for (const double x : hand->palm)
      if (!(std::abs(x) <= 0.5)) std::abort();
    if (!(hand->closure >= 0.0 && hand->closure <= 1.0)) std::abort();
  } else if (const auto* rate = std::get_if<RateMessage>(&message)) {
    if (!(rate->rate >= kMinPageRate && rate->rate <= kMaxPageRate)) std::abort();
  } else if (const auto* set = std::get_if<SetMessage>(&message)) {
    const auto* value = std::get_if<double>(&set->value);
    if (value != nullptr && !std::isfinite(*value)) std::abort();
  }
  return 0;
}
