#pragma once
/// A unit of AUTD3, v12.1: how its firmware handles a frame, and the output of its transducers.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "chain.hpp"

namespace standin {

inline constexpr int kFrameBytes = 626, kPayloadBytes = 622;

/// Output at an instant.
struct Playing {
  int segment = 0;
  std::int64_t index = 0;
  int foci = 0;                          // per sample; 0: a gain
  std::array<std::uint64_t, 8> words{};  // of the current sample
  int intensity = 0;                     // of a gain's strongest transducer, if there is no sample
  int modulation = 0;
  int sound_speed = 0;  // 1/64 m/s
  std::int64_t divider = 1;
};

/// Errors of the firmware are answered and counted. Faults that the firmware would not detect, but
/// that a correct client never makes, are counted as problems and described.
class Unit {
 public:
  Unit();

  /// Handles a frame that arrives at a tick (of 40 kHz) and a time [ns].
  void take(std::span<const std::uint8_t> frame, std::int64_t tick, std::uint64_t now);
  /// Advances to a tick.
  void go_to(std::int64_t tick, std::uint64_t now);
  std::array<std::uint8_t, 2> answer() const;
  Playing playing() const;

  void set_hot(bool hot) { hot_ = hot; }
  void set_version(int major) { version_ = major; }
  void ignore_modulation(bool yes) { ignores_modulation_ = yes; }
  /// Answers the next frames with this error, a given number of times.
  void refuse(int error, int times) { refusal_ = error, refusals_ = times; }
  const std::array<std::int64_t, 16>& errors() const { return errors_; }
  std::int64_t problems() const { return problems_; }
  const std::string& first_problem() const { return first_problem_; }
  std::int64_t commands(int tag) const { return commands_[static_cast<std::size_t>(tag)]; }

 private:
  class Bytes;
  int handle(std::span<const std::uint8_t> payload);
  int clear();
  int firmware(Bytes& in);
  int modulation(Bytes& in);
  int silencer(Bytes& in);
  int foci(Bytes& in);
  int gain(Bytes& in);
  int swap_foci(Bytes& in);
  bool breaks_silencer(std::int64_t foci_divider, std::int64_t modulation_divider) const;
  int update(Chain& chain, int segment, const Shape& shape, int mode, std::uint64_t value);
  void problem(const std::string& what);
  void must(bool holds, const char* what) {
    if (!holds) problem(what);
  }

  struct Segment {
    std::vector<std::uint64_t> words;  // as stored: earlier data remain behind `written`
    std::size_t written = 0;
    Shape shape;
    int foci = 0, sound_speed = 0, gain = 0;
  };
  struct Modulation {
    std::vector<std::uint8_t> levels;
    Shape shape;
  };

  std::array<Segment, 2> foci_;
  std::array<Modulation, 2> modulation_;
  Chain foci_chain_, modulation_chain_;
  int foci_segment_ = 0, modulation_segment_ = 0;  // that the CPU considers current
  int writes_foci_ = -1, writes_modulation_ = -1;  // segment being written; −1: none
  int foci_mode_ = 0, modulation_mode_ = 0;
  std::uint64_t foci_value_ = 0, modulation_value_ = 0;

  bool strict_ = true;
  int least_intensity_ = 10, least_phase_ = 40;  // dividers
  int gpio_ = 0;
  bool reads_state_ = false, told_version_ = false, reads_state_before_ = false;
  int data_ = 0, error_ = 0, last_id_ = -1;
  bool hot_ = false, ignores_modulation_ = false;
  int version_ = 0xA5, refusal_ = 0, refusals_ = 0;
  std::int64_t tick_ = 0;
  std::uint64_t now_ = 0;

  std::array<std::int64_t, 16> errors_{};
  std::array<std::int64_t, 256> commands_{};
  std::int64_t problems_ = 0;
  std::string first_problem_;
};

}  // namespace standin
