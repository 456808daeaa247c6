#pragma once
/// Segments and modulation of AUTD3 units, through a session.

#include <span>
#include <vector>

#include "prostm/device/autd3/detail/autd3_session.hpp"
#include "prostm/device/safety/detail/dead_man.hpp"

namespace prostm::autd3 {

/// Writes segments, and keeps them audible by modulations that end by themselves (write_dead_man).
/// Everything returns false if the session failed. Nothing but configure() allocates.
class Output {
 public:
  using Clock = Session::Clock;

  explicit Output(Session& session) : session_(session) {}

  /// @param divider periods of 40 kHz per sample. @param samples of a segment at most.
  void configure(int slots, int divider, int samples, double sound_speed);
  /// Words of a unit's segment, to be filled before write().
  std::vector<SlotWord>& words(std::size_t unit) { return words_[unit]; }

  /// Clears the units and mutes them; `turns` sees what they answer from then on.
  bool begin(TurnClock* turns);
  /// Frames of a segment of so many samples.
  int frames(int samples) const { return foci_frames(shape_.slots, samples); }
  /// Sends one of them; Session::confirm() is still to be called.
  /// @param words of each unit, for the whole segment.
  bool send(int segment, Transition transition, int samples, int index,
            const std::vector<std::vector<SlotWord>>& words);
  /// Writes a segment out of words().
  /// @param prepare called before a frame, while the one before it is under way, with the number of
  /// samples that are needed from the segment's begin.
  template <class Prepare>
  bool write(int segment, Transition transition, int samples, Prepare&& prepare);
  /// Lets output be heard from `next` until `end`; returns before that. It begins with a ramp where
  /// it is not heard yet. If it is too late for that, silence goes on. A modulation begins when it
  /// arrives: if that is not known well enough, it is told again, so nothing is heard after `end`.
  /// If it is too late for that too, the session fails.
  bool sound(Clock::time_point next, Clock::time_point end);
  /// Whether there is time left for that.
  bool sound_is_in_time(Clock::time_point next, Clock::time_point end) const;
  /// Lets it fall silent by a ramp, and waits for that.
  bool mute();
  /// Moment at which output begins to fall silent by itself.
  Clock::time_point heard_until() const { return heard_until_; }
  bool is_heard() const { return Clock::now() < heard_until_; }
  /// Falls silent, makes the units forget what they play, and says goodbye.
  void finish();

  /// A modulation so long at most [s].
  double longest() const;

 private:
  SoundingTime times_of(Clock::time_point now, Clock::time_point next, Clock::time_point end) const;
  bool send_modulation(const SoundingTime& time,
                       Clock::time_point latest = Clock::time_point::max());
  double modulation_sample() const;  // [s]

  Session& session_;
  FociSegment shape_;
  int modulation_divider_ = kMostModulation;
  int modulation_ = 0;  // segment
  std::vector<std::vector<SlotWord>> words_;
  Clock::time_point heard_from_{}, heard_until_{};
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
