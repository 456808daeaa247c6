/// Answers of AUTD3 units: any bytes give an answer whose parts lie within them, or none.

#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "prostm/device/autd3_sdk/autd3_sdk_reply.hpp"

namespace {

using Bytes = std::span<const std::uint8_t>;

bool within(Bytes part, Bytes all) {
  return part.empty() ||
         (part.data() >= all.data() && part.data() + part.size() <= all.data() + all.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Bytes bytes(data, size);
  const auto reply = prostm::sdk::read_reply(bytes);
  if (!reply) return 0;
  if (prostm::sdk::version_of(bytes) != prostm::sdk::kVersion || !within(reply->body, bytes))
    std::abort();
  const auto info = prostm::sdk::read_unit_info(*reply);
  const auto frame = prostm::sdk::read_frame_reply(*reply);
  if (info && frame) std::abort();
  if (frame && !within(frame->data, bytes)) std::abort();
  if (frame && prostm::sdk::error_words(frame->error).empty()) std::abort();
  if (prostm::sdk::status_words(reply->status).empty()) std::abort();
  return 0;
}
