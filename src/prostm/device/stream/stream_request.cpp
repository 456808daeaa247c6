#include "prostm/device/stream/stream_request.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

namespace prostm::stream {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic = {'P', 'S', 'T', 'M'};
constexpr std::uint8_t kVersion = 1;

/// Reads a little-endian number, on any machine.
template <class T>
requires std::is_integral_v<T> T get(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::make_unsigned_t<T> value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;)
    value = static_cast<std::make_unsigned_t<T>>((std::uint64_t{value} << 8U) | bytes[at + i]);
  return static_cast<T>(value);
}

Reading wrong(Reason reason) {
  Reading reading;
  reading.wrong = reason;
  return reading;
}

/// Size of the body of a receiver's message; 0 for other kinds of messages.
std::size_t body_of(std::uint8_t kind) {
  switch (static_cast<Kind>(kind)) {
    case Kind::Subscribe:
      return kSubscribeBytes;
    case Kind::TimeRequest:
    case Kind::Bye:
      return 8;
    default:
      return 0;
  }
}

Reading read_subscribe(std::span<const std::uint8_t> body, Reading reading) {
  Wishes& wishes = reading.request.wishes;
  const std::uint8_t want = body[4], flags = body[8];
  wishes.foci = body[5];
  wishes.stride = get<std::uint16_t>(body, 6);
  wishes.loops = want == 2;
  wishes.shared = (flags & 1U) != 0;
  const bool reserved = std::any_of(body.begin() + 9, body.end(), [](auto b) { return b != 0; });
  if (want < 1 || want > 2 || wishes.foci > kMostFoci || wishes.stride < 1 ||
      wishes.stride > kMostStride || flags > 1 || reserved)
    return wrong(Reason::Value);
  return reading;
}

}  // namespace

const char* sentence_of(Reason reason) {
  switch (reason) {
    case Reason::None:
      return "";
    case Reason::NotStarted:
      return "prostm plays nothing now; samples come when it starts.";
    case Reason::ZeroSamples:
      return "All intensities are zero: there is no hand, nothing to render, or the output is "
             "mute.";
    case Reason::Late:
      return "prostm was late: from this sample on all play times are later.";
    case Reason::NoLoop:
      return "There is no loop: prostm plays a stream; subscribe to samples.";
    case Reason::ProstmEnds:
      return "prostm ends.";
    case Reason::Asked:
      return "The receiver sent BYE.";
    case Reason::NothingHeard:
      return "Nothing was heard from the receiver for 1 s; it must renew every 0.25 s.";
    case Reason::Foreign:
      return "This is prostm-stream/1: a message must begin with the four bytes PSTM.";
    case Reason::Version:
      return "This is prostm-stream/1, and the request has another version: it must be 1.";
    case Reason::UnknownKind:
      return "The request's kind is unknown: it must be 1 (SUBSCRIBE), 2 (TIME_REQUEST) or 3 "
             "(BYE).";
    case Reason::Length:
      return "The request's length is wrong: the body must have 72 bytes in SUBSCRIBE, 8 in "
             "others.";
    case Reason::Value:
      return "A field of SUBSCRIBE is wrong: want must be 1 or 2, foci 0 to 8, stride 1 to 1000, "
             "flags 0 or 1, the rest 0.";
    case Reason::Full:
      return "Eight receivers are subscribed already, the maximum; stop one of them.";
    case Reason::LoopOverUdp:
      return "Loops must arrive whole, so they are sent over TCP alone; subscribe over TCP.";
    case Reason::NotSubscribed:
      return "No SUBSCRIBE came before this, or within 1 s; it must be the first message.";
  }
  return "";
}

bool has_magic(std::span<const std::uint8_t> bytes) {
  const std::size_t n = std::min(bytes.size(), kMagic.size());
  return std::equal(kMagic.begin(), kMagic.begin() + static_cast<std::ptrdiff_t>(n), bytes.begin());
}

Reading read_request(std::span<const std::uint8_t> bytes) {
  if (!has_magic(bytes)) return wrong(Reason::Foreign);
  if (bytes.size() > 4 && bytes[4] != kVersion) return wrong(Reason::Version);
  if (bytes.size() > 5 && body_of(bytes[5]) == 0) return wrong(Reason::UnknownKind);
  if (bytes.size() < 8) return {};
  const std::size_t size = body_of(bytes[5]);
  if (get<std::uint16_t>(bytes, 6) != size) return wrong(Reason::Length);
  if (bytes.size() < kHeaderBytes + size) return {};

  Reading reading;
  reading.used = kHeaderBytes + size;
  reading.request.kind = static_cast<Kind>(bytes[5]);
  const auto body = bytes.subspan(kHeaderBytes, size);
  if (reading.request.kind == Kind::TimeRequest) {
    reading.request.time_ns = get<std::int64_t>(body, 0);
    return reading;
  }
  reading.request.token = get<std::uint32_t>(body, 0);
  return reading.request.kind == Kind::Subscribe ? read_subscribe(body, reading) : reading;
}

}  // namespace prostm::stream
