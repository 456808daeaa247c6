#pragma once
/// The messages of receivers to prostm-stream/1, as docs/devices/stream.md has them.

#include <cstddef>
#include <cstdint>
#include <span>

namespace prostm::stream {

inline constexpr std::size_t kHeaderBytes = 16;
inline constexpr std::size_t kSubscribeBytes = 72;  // HELLO has as many, so UDP magnifies nothing
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

/// Says a reason in a sentence.
const char* sentence_of(Reason reason);

/// Parts of SUBSCRIBE that say what is to be sent.
struct Wishes {
  bool loops = false;        ///< closed loops; else samples
  std::uint8_t foci = 0;     ///< the first so many focal points; 0: all
  std::uint16_t stride = 1;  ///< each sample whose index is a multiple of it; 1..kMostStride
  bool shared = false;       ///< one intensity for all focal points of a sample

  bool operator==(const Wishes&) const = default;

  /// Focal points sent of a sample that has so many.
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
  std::size_t used = 0;         ///< bytes of the message; 0: it is not complete yet, or wrong
  Reason wrong = Reason::None;  ///< None: nothing is
  Request request;
};

/// Reads the message at the beginning of some bytes, which may be any bytes.
Reading read_request(std::span<const std::uint8_t> bytes);

/// Whether the bytes begin with the magic word, as far as they go.
bool has_magic(std::span<const std::uint8_t> bytes);

}  // namespace prostm::stream
