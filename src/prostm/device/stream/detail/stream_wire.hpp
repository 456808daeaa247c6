#pragma once
/// Messages to receivers in prostm-stream/1, as specified in docs/devices/stream.md. Private to
/// device.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "prostm/device/stream/stream_request.hpp"
#include "prostm/emit/focus_sample.hpp"

namespace prostm::stream {

inline constexpr std::size_t kFocusBytes = 16;
inline constexpr std::size_t kBlockHeadBytes = 32;
inline constexpr std::size_t kLoopHeadBytes = 24;
inline constexpr std::size_t kDatagramBytes = 1200;
inline constexpr int kMostBlockSamples = 400;
inline constexpr std::size_t kLongestMessage =
    kHeaderBytes + kBlockHeadBytes + kFocusBytes * kMostFoci * kMostBlockSamples;

enum class PlayState : std::uint8_t { Stopped = 0, Silent = 1, Playing = 2 };

/// Header fields that differ between messages.
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

/// Number of the block's samples that the wishes select.
std::size_t wished_samples(const BlockView& block, const Wishes& wishes);

/// Number of samples that fit into a message of this size [bytes].
std::size_t samples_in(std::size_t bytes, std::size_t foci);

// Each writes a message into `out` and returns its size in bytes. @pre it fits.
std::size_t put_hello(std::span<std::uint8_t> out, const Envelope& envelope, const Hello& hello);
/// @param begin, count range within the selected samples.
/// @param skipped samples skipped for this receiver so far. @param gap whether samples were skipped
/// right before this message.
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
