#pragma once
/// Segments and modulation of AUTD3 units, through a session.

#include <span>
#include <vector>

#include "prostm/device/autd3/detail/autd3_session.hpp"
#include "prostm/device/safety/detail/dead_man.hpp"

namespace prostm::autd3 {

/// Writes segments, and keeps them audible by modulations that end by themselves (write_dead_man).
/// All functions that return bool return false if the session failed. Only configure() allocates.
class Output {
 public:
  using Clock = Session::Clock;

  explicit Output(Session& session) : session_(session) {}

  /// @param divider periods of 40 kHz per sample. @param samples largest number in a segment.
  void configure(int slots, int divider, int samples, double sound_speed);
  /// Words of a unit's segment; fill them before write().
  std::vector<SlotWord>& words(std::size_t unit) { return words_[unit]; }

  /// Clears the units and mutes them; from then on `turns` receives their answers.
  bool begin(TurnClock* turns);
  /// Number of frames of a segment with this many samples.
  int frames(int samples) const { return foci_frames(shape_.slots, samples); }
  /// Sends one frame of a segment; call Session::confirm() afterwards.
  /// @param words of each unit, for the whole segment.
  bool send(int segment, Transition transition, int samples, int index,
            const std::vector<std::vector<SlotWord>>& words);
  /// Writes a segment from words().
  /// @param prepare called before each frame, while the previous frame is in flight, with the
  /// number of samples needed so far, counted from the segment's beginning.
  template <class Prepare>
  bool write(int segment, Transition transition, int samples, Prepare&& prepare);
  /// Makes output audible from `next` until `end`, with a ramp up if it was silent; returns before
  /// `next`. If it is too late for that, output stays silent. A modulation begins when it arrives:
  /// if its arrival time is too uncertain, it is sent again with a larger margin, so that nothing
  /// is audible after `end`. If it is too late for that too, the session fails.
  bool sound(Clock::time_point next, Clock::time_point end);
  /// Whether there is enough time left for sound().
  bool is_in_time(Clock::time_point next, Clock::time_point end) const;
  /// Silences output by a ramp, and waits until it is silent.
  bool mute();
  bool is_audible() const { return Clock::now() < audible_until_; }
  /// Silences output, clears the units, and closes the session.
  void finish();

  /// Longest duration of a modulation [s].
  double longest() const;

 private:
  SoundingTime times_of(Clock::time_point now, Clock::time_point next, Clock::time_point end,
                        double slow_frame) const;
  bool send_modulation(const SoundingTime& time,
                       Clock::time_point latest = Clock::time_point::max());
  double modulation_sample() const;  // [s]

  Session& session_;
  FociSegment shape_;
  int modulation_divider_ = kMostModulation;
  int modulation_ = 0;  // segment
  std::vector<std::vector<SlotWord>> words_;
  Clock::time_point audible_from_{}, audible_until_{};
};

template <class Prepare>
bool Output::write(int segment, Transition transition, int samples, Prepare&& prepare) {
  const int count = frames(samples);
  prepare(samples_in_frames(shape_.slots, samples, 1));
  for (int index = 0; index < count; ++index) {
    if (!send(segment, transition, samples, index, words_)) return false;
    if (index + 1 < count) prepare(samples_in_frames(shape_.slots, samples, index + 2));
    if (!session_.confirm()) return false;
  }
  return true;
}

}  // namespace prostm::autd3
