#pragma once
/// Messages from receivers in prostm-stream/1, as specified in docs/devices/stream.md.

#include <cstddef>
#include <cstdint>
#include <span>

namespace prostm::stream {

inline constexpr std::size_t kHeaderBytes = 16;
inline constexpr std::size_t kSubscribeBytes = 72;  // same as HELLO, so UDP amplifies nothing
inline constexpr std::size_t kLongestRequest = kHeaderBytes + kSubscribeBytes;
inline constexpr int kMostStride = 1000;
inline constexpr int kMostFoci = 8;

enum class Kind : std::uint8_t {
  Subscribe = 1,
  TimeRequest = 2,
  Bye = 3,
  Hello = 16,
  Block = 17,
  State = 18,
  Heartbeat = 19,
  Time = 20,
  Loop = 21,
  LoopStart = 22,
  End = 23,
  Error = 24
};

enum class Reason : std::uint16_t {  // of STATE, END and ERROR
  None = 0,
  NotStarted = 1,     // STATE
  ZeroSamples = 2,    // STATE
  Late = 3,           // STATE
  NoLoop = 4,         // STATE
  ProstmEnds = 16,    // END
  Asked = 17,         // END
  NothingHeard = 18,  // END
  Foreign = 32,       // ERROR from here on
  Version = 33,
  UnknownKind = 34,
  Length = 35,
  Value = 36,
  Full = 37,
  LoopOverUdp = 38,
  NotSubscribed = 39
};

/// Returns a sentence for a reason.
const char* sentence_of(Reason reason);

/// Fields of SUBSCRIBE that select the data to send.
struct Wishes {
  bool loops = false;        ///< closed loops; else samples
  std::uint8_t foci = 0;     ///< send this many focal points, the first ones; 0: all
  std::uint16_t stride = 1;  ///< send samples whose index is a multiple of it; 1..kMostStride
  bool shared = false;       ///< one intensity for all focal points of a sample

  bool operator==(const Wishes&) const = default;

  /// Number of focal points sent of a sample with `all` focal points.
  std::size_t foci_of(int all) const {
    const auto n = static_cast<std::size_t>(all);
    return foci == 0 || foci > n ? n : foci;
  }
};

/// A receiver's message.
struct Request {
  Kind kind = Kind::Bye;
  std::uint32_t token = 0;
  Wishes wishes;             ///< of SUBSCRIBE
  std::int64_t time_ns = 0;  ///< of TIME_REQUEST
};

/// Result of read_request.
struct Reading {
  std::size_t used = 0;         ///< bytes of the message; 0: incomplete or invalid
  Reason wrong = Reason::None;  ///< None: the message is valid or incomplete
  Request request;
};

/// Reads the message at the beginning of the bytes, which are not trusted.
Reading read_request(std::span<const std::uint8_t> bytes);

/// Whether the bytes, possibly fewer than four, match the beginning of the magic word.
bool has_magic(std::span<const std::uint8_t> bytes);

}  // namespace prostm::stream
