#pragma once
/// Two segments, one of which plays, and the rules for switching to the other.

#include <array>
#include <cstdint>

namespace standin {

/// Modes of a switch, numbered as in the firmware.
enum Mode : int {
  kSyncIdx = 0,
  kSysTime = 1,
  kGpio = 2,
  kExt = 0xF0,
  kNone = 0xFE,
  kImmediate = 0xFF
};
inline constexpr int kEndless = 0xFFFF;  // in `rep`, which otherwise is loops − 1

/// Length and rate of a segment.
struct Shape {
  std::int64_t cycle = 1;    // samples
  std::int64_t divider = 1;  // ticks of 40 kHz per sample
  int rep = kEndless;
};

/// The player of focal points, or of modulation. Time is counted in ticks of 40 kHz since the
/// system's epoch, which all segments share.
class Chain {
 public:
  explicit Chain(Shape shape) : shape_{shape, shape} {}

  /// Whether the firmware rejects this mode for a segment that is written while `current` plays.
  static bool refuses(int current, int segment, int rep, int mode);

  /// Sets the segment to switch to. Its shape applies from here on.
  void set(int segment, const Shape& shape, int mode, std::uint64_t value, std::int64_t tick);
  /// Advances to a tick.
  /// @param gpio the inputs. @param now time of the tick [ns].
  void go_to(std::int64_t tick, int gpio, std::uint64_t now);

  int segment() const { return segment_; }
  std::int64_t index() const { return index_; }
  const Shape& shape() const { return shape_[static_cast<std::size_t>(segment_)]; }

 private:
  enum class State { Waits, Finite, Endless };
  const Shape& of(int segment) const { return shape_[static_cast<std::size_t>(segment)]; }
  std::int64_t lap(int segment, std::int64_t tick) const {
    return tick / of(segment).divider / of(segment).cycle;
  }
  bool starts(std::int64_t tick, int gpio, std::uint64_t now) const;

  std::array<Shape, 2> shape_;
  State state_ = State::Endless;
  int segment_ = 0, wanted_ = 0, mode_ = kSyncIdx;
  std::uint64_t value_ = 0;
  bool alternates_ = false;
  std::int64_t set_lap_ = 0;            // of the wanted segment when it was set
  std::int64_t alternated_lap_ = 0;     // of the last alternation
  std::int64_t begin_ = 0, index_ = 0;  // first sample of a finite loop; sample that plays
};

}  // namespace standin
