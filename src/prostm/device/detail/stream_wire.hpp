#pragma once
/// The messages of prostm-stream/1, as docs/stream.md has them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "prostm/emit/focus_sample.hpp"

namespace prostm::stream {

inline constexpr std::size_t kHeaderBytes = 16;
inline constexpr std::size_t kFocusBytes = 16;
inline constexpr std::size_t kBlockHeadBytes = 32;
inline constexpr std::size_t kLoopHeadBytes = 24;
inline constexpr std::size_t kSubscribeBytes = 72;  // HELLO has as many, so UDP magnifies nothing
inline constexpr std::size_t kLongestRequest = kHeaderBytes + kSubscribeBytes;
inline constexpr std::size_t kDatagramBytes = 1200;
inline constexpr int kMostStride = 1000;
inline constexpr int kMostFoci = 8;
inline constexpr int kMostBlockSamples = 400;
inline constexpr std::size_t kLongestMessage =
    kHeaderBytes + kBlockHeadBytes + kFocusBytes * kMostFoci * kMostBlockSamples;

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

enum class PlayState : std::uint8_t { Stopped = 0, Silent = 1, Playing = 2 };

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

/// Parts of the header that are each message's own.
struct Envelope {
  std::uint32_t session = 0;
  std::uint32_t sequence = 0;
};

struct Hello {
  bool subscribed = false;
  std::uint32_t token = 0;
  Wishes wishes;
  double sample_rate = 0.0;  ///< [Hz]
  int block_samples = 0, max_foci = 0;
  std::int64_t now_ns = 0, next_sample = 0, next_play_ns = 0, lead_ns = 0;
};

/// A block as the device filled it.
struct BlockView {
  std::int64_t first = 0;    ///< index of its first sample
  std::int64_t play_ns = 0;  ///< play time of that sample
  double sample_rate = 0.0;  ///< [Hz]
  int foci = 1;
  std::span<const FocusSample> samples;  ///< sample-major

  std::size_t count() const { return samples.size() / static_cast<std::size_t>(foci); }
};

/// Number of the block's samples that the wishes ask for.
std::size_t wished_samples(const BlockView& block, const Wishes& wishes);

/// Wished samples that fit in a message of so many bytes.
std::size_t samples_in(std::size_t bytes, std::size_t foci);

// Each writes a message into `out` and returns its size in bytes. @pre it fits.
std::size_t put_hello(std::span<std::uint8_t> out, const Envelope& envelope, const Hello& hello);
/// @param begin, count the part of the wished samples.
/// @param skipped samples that were left out for this receiver up to now. @param gap whether some
/// were left out right before this message.
std::size_t put_block(std::span<std::uint8_t> out, const Envelope& envelope, const BlockView& block,
                      const Wishes& wishes, std::size_t begin, std::size_t count,
                      std::int64_t skipped, bool gap);
std::size_t put_state(std::span<std::uint8_t> out, const Envelope& envelope, PlayState state,
                      Reason reason, std::int64_t sample);
std::size_t put_heartbeat(std::span<std::uint8_t> out, const Envelope& envelope,
                          std::int64_t now_ns, std::int64_t next_sample, PlayState state);
std::size_t put_time(std::span<std::uint8_t> out, const Envelope& envelope, std::int64_t asked_ns,
                     std::int64_t received_ns, std::int64_t sent_ns);
std::size_t put_loop(std::span<std::uint8_t> out, const Envelope& envelope, std::uint32_t id,
                     const BlockView& loop, const Wishes& wishes, std::size_t begin,
                     std::size_t count);
std::size_t put_loop_start(std::span<std::uint8_t> out, const Envelope& envelope, std::uint32_t id,
                           std::int64_t sample, std::int64_t play_ns);
/// @param kind End or Error.
std::size_t put_end(std::span<std::uint8_t> out, const Envelope& envelope, Kind kind,
                    Reason reason);

}  // namespace prostm::stream
