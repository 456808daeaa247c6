#include "prostm/device/autd3/autd3_reply.hpp"

namespace prostm::autd3 {
namespace {

constexpr std::size_t kStatus = 1, kLength = 4;  // bytes
constexpr std::uint8_t kAccepted = 0, kRefused = 0xFF;
constexpr std::size_t kHelloBytes = 1 + 2 + 11;

std::size_t number_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < kLength; ++i)
    number |= static_cast<std::size_t>(bytes[at + i]) << (8 * i);
  return number;
}

}  // namespace

std::size_t request_bytes(std::span<const std::uint8_t> begin, std::size_t units) noexcept {
  if (begin.empty()) return 0;
  switch (static_cast<Request>(begin.front())) {
    case Request::Hello:
      return kHelloBytes;
    case Request::Geometry:
      return begin.size() < 1 + kLength ? 0 : 1 + kLength + kPlaceBytes * number_at(begin, 1);
    case Request::Send:
      return 1 + kFrameBytes * units;
    case Request::Read:
    case Request::Close:
      return 1;
  }
  return 0;
}

Reply read_reply(std::span<const std::uint8_t> bytes, Request request, std::size_t units) noexcept {
  using Kind = Reply::Kind;
  if (bytes.empty()) return {Kind::Incomplete, kStatus};
  if (bytes.front() == kAccepted) {
    const std::size_t size = kStatus + (request == Request::Read ? kAnswerBytes * units : 0);
    return {bytes.size() < size ? Kind::Incomplete : Kind::Accepted, size};
  }
  if (bytes.front() != kRefused) return {Kind::Strange, kStatus};
  const std::size_t head = kStatus + kLength;
  if (bytes.size() < head) return {Kind::Incomplete, head};
  const std::size_t length = number_at(bytes, kStatus);
  if (length > kMostWords) return {Kind::Strange, head};
  if (bytes.size() < head + length) return {Kind::Incomplete, head + length};
  const auto* words = reinterpret_cast<const char*>(bytes.data() + head);
  return {Kind::Refused, head + length, {words, length}};
}

}  // namespace prostm::autd3
