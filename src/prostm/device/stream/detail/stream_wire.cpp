#include "prostm/device/stream/detail/stream_wire.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace prostm::stream {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic = {'P', 'S', 'T', 'M'};
constexpr std::uint8_t kVersion = 1;
constexpr std::uint8_t kMetre = 1, kPressureAmplitude = 1;  // units of positions, of intensities
constexpr std::uint32_t kSilenceAfter_us = 20'000, kRamp_us = 5'000;
constexpr std::uint16_t kExpiry_ms = 1'000;

/// Writes a message from front to back.
class Writer {
 public:
  Writer(std::span<std::uint8_t> out, Kind kind, const Envelope& envelope) : out_(out) {
    for (const std::uint8_t byte : kMagic) put(byte);
    put(kVersion);
    put(static_cast<std::uint8_t>(kind));
    put(std::uint16_t{0});  // size of the body, set by done()
    put(envelope.session);
    put(envelope.sequence);
  }

  template <class T>
  requires std::is_integral_v<T>
  void put(T value) {
    auto rest = static_cast<std::uint64_t>(static_cast<std::make_unsigned_t<T>>(value));
    for (std::size_t i = 0; i < sizeof(T); ++i, rest >>= 8U)
      out_[size_++] = static_cast<std::uint8_t>(rest & 0xFFU);
  }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
  void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
  void put(std::string_view text) {
    for (const char c : text) put(static_cast<std::uint8_t>(c));
  }
  void pad_to(std::size_t size) {
    while (size_ < size) out_[size_++] = 0;
  }
  std::size_t done() {
    const std::size_t body = size_ - kHeaderBytes;
    out_[6] = static_cast<std::uint8_t>(body & 0xFFU);
    out_[7] = static_cast<std::uint8_t>(body >> 8U);
    return size_;
  }

 private:
  std::span<std::uint8_t> out_;
  std::size_t size_ = 0;
};

/// Returns the position of the first selected sample in the block; it may be beyond the block's
/// end.
std::size_t first_wished(const BlockView& block, const Wishes& wishes) {
  const std::int64_t over = block.first % wishes.stride;
  return static_cast<std::size_t>(over == 0 ? 0 : wishes.stride - over);
}

/// Writes samples begin, begin + stride, … of the block.
void put_samples(Writer& w, const BlockView& block, const Wishes& wishes, std::size_t begin,
                 std::size_t stride, std::size_t count) {
  const auto all = static_cast<std::size_t>(block.foci);
  const std::size_t foci = wishes.foci_of(block.foci);
  for (std::size_t k = 0; k < count; ++k) {
    const auto sample = block.samples.subspan((begin + k * stride) * all, foci);
    // the root mean square has the same power as the intensities that it replaces, so it keeps
    // their limits
    float power = 0.0F;
    if (wishes.shared) {
      for (const FocusSample& f : sample) power += f.intensity * f.intensity;
    }
    const float shared = std::min(1.0F, std::sqrt(power / static_cast<float>(foci)));
    for (const FocusSample& f : sample) {
      w.put(f.p_D.x());
      w.put(f.p_D.y());
      w.put(f.p_D.z());
      w.put(wishes.shared ? shared : f.intensity);
    }
  }
}

std::int64_t time_of(const BlockView& block, std::size_t sample) {
  return block.play_ns + std::llround(static_cast<double>(sample) * 1e9 / block.sample_rate);
}

}  // namespace

std::size_t wished_samples(const BlockView& block, const Wishes& wishes) {
  const std::size_t first = first_wished(block, wishes), n = block.count();
  return first < n ? (n - first - 1) / wishes.stride + 1 : 0;
}

std::size_t samples_in(std::size_t bytes, std::size_t foci) {
  return (bytes - kHeaderBytes - kBlockHeadBytes) / (kFocusBytes * foci);
}

std::size_t put_hello(std::span<std::uint8_t> out, const Envelope& envelope, const Hello& hello) {
  Writer w(out, Kind::Hello, envelope);
  w.put(hello.token);
  w.put(static_cast<std::uint8_t>(hello.subscribed ? 1 : 0));
  w.put(static_cast<std::uint8_t>(hello.wishes.loops ? 2 : 1));
  w.put(static_cast<std::uint8_t>(hello.max_foci));
  w.put(hello.wishes.foci);
  w.put(hello.wishes.stride);
  w.put(static_cast<std::uint8_t>(hello.wishes.shared ? 1 : 0));
  w.put(kMetre);
  w.put(kPressureAmplitude);
  w.put(std::uint8_t{0});
  w.put(static_cast<std::uint16_t>(hello.block_samples));
  w.put(hello.sample_rate);
  w.put(hello.now_ns);
  w.put(hello.next_sample);
  w.put(hello.next_play_ns);
  w.put(hello.lead_ns);
  w.put(kSilenceAfter_us);
  w.put(kRamp_us);
  w.put(kExpiry_ms);
  w.pad_to(kHeaderBytes + kSubscribeBytes);
  return w.done();
}

std::size_t put_block(std::span<std::uint8_t> out, const Envelope& envelope, const BlockView& block,
                      const Wishes& wishes, std::size_t begin, std::size_t count,
                      std::int64_t skipped, bool gap) {
  const std::size_t at = first_wished(block, wishes) + begin * wishes.stride;
  Writer w(out, Kind::Block, envelope);
  w.put(block.first + static_cast<std::int64_t>(at));
  w.put(time_of(block, at));
  w.put(static_cast<std::uint16_t>(count));
  w.put(wishes.stride);
  w.put(static_cast<std::uint8_t>(wishes.foci_of(block.foci)));
  w.put(static_cast<std::uint8_t>((wishes.shared ? 1U : 0U) | (gap ? 2U : 0U)));
  w.put(std::uint16_t{0});
  w.put(skipped);
  put_samples(w, block, wishes, at, wishes.stride, count);
  return w.done();
}

std::size_t put_state(std::span<std::uint8_t> out, const Envelope& envelope, PlayState state,
                      Reason reason, std::int64_t sample) {
  Writer w(out, Kind::State, envelope);
  w.put(static_cast<std::uint16_t>(reason));
  w.put(static_cast<std::uint8_t>(state));
  w.put(std::uint8_t{0});
  w.put(std::uint32_t{0});
  w.put(sample);
  w.put(std::string_view(sentence_of(reason)));
  return w.done();
}

std::size_t put_heartbeat(std::span<std::uint8_t> out, const Envelope& envelope,
                          std::int64_t now_ns, std::int64_t next_sample, PlayState state) {
  Writer w(out, Kind::Heartbeat, envelope);
  w.put(now_ns);
  w.put(next_sample);
  w.put(static_cast<std::uint8_t>(state));
  w.pad_to(kHeaderBytes + 24);
  return w.done();
}

std::size_t put_time(std::span<std::uint8_t> out, const Envelope& envelope, std::int64_t asked_ns,
                     std::int64_t received_ns, std::int64_t sent_ns) {
  Writer w(out, Kind::Time, envelope);
  w.put(asked_ns);
  w.put(received_ns);
  w.put(sent_ns);
  return w.done();
}

std::size_t put_loop(std::span<std::uint8_t> out, const Envelope& envelope, std::uint32_t id,
                     const BlockView& loop, const Wishes& wishes, std::size_t begin,
                     std::size_t count) {
  Writer w(out, Kind::Loop, envelope);
  w.put(id);
  w.put(static_cast<std::uint32_t>(loop.count()));
  w.put(static_cast<std::uint32_t>(begin));
  w.put(static_cast<std::uint16_t>(count));
  w.put(static_cast<std::uint8_t>(wishes.foci_of(loop.foci)));
  w.put(static_cast<std::uint8_t>(wishes.shared ? 1 : 0));
  w.put(loop.sample_rate);
  put_samples(w, loop, wishes, begin, 1, count);
  return w.done();
}

std::size_t put_loop_start(std::span<std::uint8_t> out, const Envelope& envelope, std::uint32_t id,
                           std::int64_t sample, std::int64_t play_ns) {
  Writer w(out, Kind::LoopStart, envelope);
  w.put(id);
  w.put(std::uint32_t{0});
  w.put(sample);
  w.put(play_ns);
  return w.done();
}

std::size_t put_end(std::span<std::uint8_t> out, const Envelope& envelope, Kind kind,
                    Reason reason) {
  Writer w(out, kind, envelope);
  w.put(static_cast<std::uint16_t>(reason));
  w.put(std::uint16_t{0});
  w.put(std::string_view(sentence_of(reason)));
  return w.done();
}

}  // namespace prostm::stream
