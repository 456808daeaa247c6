#pragma once
/// A unit's output: when it emits, how its focal points move, and whether its phases
/// match the focal points.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "unit.hpp"

namespace standin {

/// A played sample as written to a log: 88 bytes, little-endian.
struct Played {
  double time = 0.0;  // start, on the monotonic clock [s]
  std::int32_t index = 0;
  std::uint8_t segment = 0, slots = 0, loudest = 0, intensity = 0;  // loudest modulation
  std::int64_t divider = 0;
  std::array<std::uint64_t, 8> words{};
};
static_assert(sizeof(Played) == 88);

class Ear {
 public:
  /// Records the output at a tick. @param time of the tick [s].
  void hear(const Playing& playing, std::int64_t tick, double time);
  void keep_log(bool yes) { logs_ = yes; }
  const std::vector<Played>& log() const { return log_; }

  std::int64_t samples = 0;  // with output
  double last_sound = 0.0;   // when a transducer was last driven [s]
  bool sounds = false;
  std::int64_t silences = 0;     // number of silences after sound
  double longest_silence = 0.0;  // between sounds [s]
  double largest_step = 0.0;     // of a focal point above 1 % from sample to sample [m]
  double largest_speed = 0.0;    // a step over the sampling period [m/s]
  double phase_error = 0.0;      // for transducers whose sum is ≥ 0.5 of the slots [1/256 turn]
  int largest_key = 0;           // largest intensity · modulation / 255, of 255

 private:
  struct Focus {
    std::array<double, 3> place{};  // [m], in the unit's frame
    double level = 0.0;             // fraction of full intensity, before modulation
  };
  struct Sample {
    std::vector<Focus> foci;
    double period = 0.0;
    int loudest = 0;
  };
  void end_sample();
  void begin_sample(const Playing& playing, std::int64_t tick, double time);
  void check_phases(const Playing& playing);

  Sample before_, now_;
  Played played_;
  std::int64_t sample_ = -1;
  int segment_ = -1, words_of_ = 0;
  std::int64_t heard_ = 0;
  bool logs_ = false;
  std::vector<Played> log_;
};

}  // namespace standin
