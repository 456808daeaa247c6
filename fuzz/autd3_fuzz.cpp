/// Replies of a server of AUTD3 units, and files of units' places: any bytes are read within
/// their bounds, or refused.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "prostm/core/input_error.hpp"
#include "prostm/device/autd3/autd3_array.hpp"
#include "prostm/device/autd3/autd3_reply.hpp"

namespace {

/// Reads a reply as it arrives, as many bytes at a time as the reader requests.
void read_all(std::span<const std::uint8_t> bytes, prostm::autd3::Request request,
              std::size_t units) {
  using prostm::autd3::Reply;
  std::size_t have = 0;
  for (;;) {
    const Reply reply = prostm::autd3::read_reply(bytes.first(have), request, units);
    if (reply.bytes > prostm::autd3::kMostReply) std::abort();
    if (reply.kind != Reply::Kind::Incomplete) {
      if (reply.bytes > have) std::abort();
      const auto* begin = reinterpret_cast<const char*>(bytes.data());
      if (!reply.words.empty() &&
          (reply.words.data() < begin || reply.words.data() + reply.words.size() > begin + have)) {
        std::abort();
      }
      return;
    }
    if (reply.bytes <= have) std::abort();
    if (reply.bytes > bytes.size()) return;
    have = reply.bytes;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prostm;
  const std::span<const std::uint8_t> bytes(data, size);
  using autd3::Request;
  for (const Request request : {Request::Geometry, Request::Send, Request::Read, Request::Hello})
    for (const std::size_t units : {std::size_t{1}, std::size_t{3}, autd3::kMostUnits})
      read_all(bytes, request, units);
  autd3::request_bytes(bytes, 2);
  try {
    const std::vector<Pose> units =
        autd3_units_from_json({reinterpret_cast<const char*>(data), size}, "fuzz.json");
    if (units.empty() || units.size() > autd3::kMostUnits) std::abort();
    for (const Pose& X_DU : units)
      if (!(std::abs(X_DU.linear().determinant() - 1.0) < 1e-9)) std::abort();
  } catch (const InputError&) {
    // the required answer to bad input
  }
  return 0;
}
