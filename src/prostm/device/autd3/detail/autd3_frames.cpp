#include "prostm/device/autd3/detail/autd3_frames.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace prostm::autd3 {
namespace {

constexpr std::size_t kHead = 4;
constexpr int kFirstFoci = 74, kNextFoci = 77;  // slots in a frame
constexpr std::uint16_t kEndless = 0xFFFF, kOnce = 0;

enum Tag : std::uint8_t {
  kNop = 0x00,
  kClear = 0x01,
  kSynchronise = 0x02,
  kFirmware = 0x03,
  kModulation = 0x10,
  kSilencer = 0x21,
  kFoci = 0x42,
  kSwapFoci = 0x44,
  kReadState = 0x61,
  kGpio = 0xF1
};
enum Flag : std::uint8_t { kBegin = 1, kEnd = 2, kTransition = 4, kSegment1 = 8, kStrict = 4 };

/// Writes numbers one after the other into a zeroed frame.
class Writer {
 public:
  explicit Writer(Frame& frame) : at_(frame.data() + kHead) { frame.fill(0); }
  Writer& u8(int value) {
    *at_++ = static_cast<std::uint8_t>(value);
    return *this;
  }
  Writer& u16(int value) { return u8(value & 0xFF).u8(value >> 8 & 0xFF); }
  Writer& u64(std::uint64_t value) {
    for (int byte = 0; byte < 8; ++byte) u8(static_cast<int>(value >> (8 * byte) & 0xFF));
    return *this;
  }
  Writer& zeros(int count) {
    at_ += count;
    return *this;
  }

 private:
  std::uint8_t* at_;
};

struct Samples {
  int first, count;
};

int most_samples(int slots, int index) {
  return (index == 0 ? kFirstFoci : kNextFoci) / slots;
}

/// Returns the samples of a segment that one of its frames holds.
Samples samples_of(const FociSegment& segment, int index) {
  const int before =
      index == 0 ? 0
                 : most_samples(segment.slots, 0) + (index - 1) * most_samples(segment.slots, 1);
  return {before, std::min(segment.samples - before, most_samples(segment.slots, index))};
}

}  // namespace

void nop(Frame& frame) {
  Writer(frame).u8(kNop);
}

void clear_and_synchronise(Frame& frame) {
  Writer(frame).u8(kClear).u8(0).u8(kSynchronise).u8(0);
  frame[2] = 2;  // the second command begins two bytes after the first
}

void read_state(Frame& frame) {
  Writer(frame).u8(kReadState).u8(1);
}

void firmware(Frame& frame, Info info) {
  Writer(frame).u8(kFirmware).u8(static_cast<int>(info));
}

void gpio(Frame& frame, std::uint8_t inputs) {
  Writer(frame).u8(kGpio).u8(inputs);
}

void silencer(Frame& frame, int steps) {
  Writer(frame).u8(kSilencer).u8(kStrict).u16(steps).u16(steps);
}

void modulation(Frame& frame, std::span<const std::uint8_t> samples, int segment, int divider) {
  const int flags = kBegin | kEnd | kTransition | (segment == 1 ? kSegment1 : 0);
  Writer out(frame);
  out.u8(kModulation).u8(flags).u8(static_cast<int>(samples.size()));
  out.u8(static_cast<int>(Transition::Gpio)).u16(divider).u16(kOnce).u64(0);  // GPIO 0
  for (const std::uint8_t sample : samples) out.u8(sample);
}

int foci_frames(int slots, int samples) {
  const int after = samples - most_samples(slots, 0), each = most_samples(slots, 1);
  return 1 + (after > 0 ? (after + each - 1) / each : 0);
}

int samples_in_frames(int slots, int samples, int frames) {
  if (frames <= 0) return 0;
  return std::min(samples, most_samples(slots, 0) + (frames - 1) * most_samples(slots, 1));
}

void foci(Frame& frame, const FociSegment& segment, std::span<const SlotWord> words, int index) {
  const auto [first, count] = samples_of(segment, index);
  const bool last = first + count == segment.samples,
             later = segment.transition == Transition::Later;
  const int flags =
      (index == 0 ? kBegin : 0) | (last ? kEnd : 0) | (last && !later ? kTransition : 0);
  Writer out(frame);
  out.u8(kFoci).u8(flags).u8(count).u8(segment.segment);
  if (index == 0) {
    out.u8(static_cast<int>(segment.transition)).u8(segment.slots);
    out.u16(static_cast<int>(std::lround(64.0 * segment.sound_speed)));
    out.u16(segment.divider).u16(kEndless).zeros(4).u64(0);
  }
  const auto begin = static_cast<std::size_t>(first * segment.slots);
  for (const SlotWord word : words.subspan(begin, static_cast<std::size_t>(count * segment.slots)))
    out.u64(word);
}

void alternate(Frame& frame, int segment) {
  Writer out(frame);
  out.u8(kSwapFoci).u8(segment).u8(static_cast<int>(Transition::Alternate)).zeros(5).u64(0);
}

std::string error_sentence(int error) {
  switch (error) {
    case 1:
      return "does not know a command: its firmware must be v12.1, which AUTD3 v38 needs";
    case 2:
      return "was sent a message out of turn (error 2): another program may be driving it";
    case 3:
      return "does not report the version of its firmware (error 3): it must be v12.1";
    case 4:
      return "refused a list of patterns (error 4), which prostm does not send: another program "
             "may "
             "be driving it";
    case 5:
      return "refused to switch to a block that it does not hold (error 5): another program "
             "may "
             "be driving it";
    case 6:
      return "received a block too late for its start (error 6): the link is slower than it was "
             "measured";
    case 7:
      return "refused the sampling rate, which is faster than its silencer's limit (error 7): "
             "another "
             "program may have set the silencer";
    case 8:
      return "refused this kind of transition (error 8): another program may be driving it";
    default:
      return "answered with error " + std::to_string(error) + ", which AUTD3 v38 does not have";
  }
}

}  // namespace prostm::autd3
