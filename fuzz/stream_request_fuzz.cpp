/// A receiver's messages of prostm-stream/1: any bytes are requests within their bounds, or
/// refused.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "prostm/device/stream/stream_request.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm::stream;
  std::span<const std::uint8_t> bytes(data, size);
  // a connection's messages, one after the other
  while (!bytes.empty()) {
    const Reading reading = read_request(bytes);
    if (reading.used > bytes.size() || reading.used > kLongestRequest) std::abort();
    if (reading.wrong != Reason::None && (reading.used != 0 || *sentence_of(reading.wrong) == '\0'))
      std::abort();
    if (reading.used == 0 && reading.wrong == Reason::None && bytes.size() >= kLongestRequest)
      std::abort();
    if (reading.used == 0) return 0;
    const Wishes& wishes = reading.request.wishes;
    if (wishes.foci > kMostFoci || wishes.stride < 1 || wishes.stride > kMostStride) std::abort();
    bytes = bytes.subspan(reading.used);
  }
  return 0;
}
