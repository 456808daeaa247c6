#pragma once
/// Sends markers at the moments that they tell of.

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/device/device.hpp"
#include "prostm/device/safety/sound_watch.hpp"
#include "prostm/study/live/marker_target.hpp"
#include "prostm/study/session/marker.hpp"

namespace prostm {

/// The part that is the same in all markers of a run.
struct MarkerRun {
  int participant = 0;
  int run = 1;  ///< with this participant, from 1
};

/// On a thread of its own it takes the changes of the output, asks the device when their samples
/// leave the array, waits until then, and sends. What cannot be sent is said once, and goes on: all
/// markers are handed to the study, which writes them down.
class MarkerSender {
 public:
  /// Starts the thread. All but `run` must outlive stop().
  MarkerSender(std::vector<OpenTarget> targets, const Protocol& protocol, const MarkerRun& run,
               const Device& device, SoundWatch& sound);
  ~MarkerSender() { stop(); }
  MarkerSender(const MarkerSender&) = delete;
  MarkerSender& operator=(const MarkerSender&) = delete;

  /// Sends what the device has played, and ends the thread.
  void stop();

  // ---- the study's thread ----
  /// Names what sounds next, and how its newest plan is played. Call it before the mute is lifted.
  void present(const Presentation& now, const std::optional<StudyPlayed>& played);
  /// How the newest plan of what sounds is played. It stays so where no plan follows.
  void tell(const StudyPlayed& played);
  /// The oldest marker that was not handed over yet; false without one.
  bool next(Marker& out) { return markers_.pop(out); }
  /// Returns the line that the response file gets.
  ResponseLine line(const Marker& marker) const;

  // ---- the program's thread ----
  /// The oldest sentence about a target that was not told yet; false without one.
  bool next_news(std::string& sentence) { return news_.pop(sentence); }

 private:
  struct Target {
    OpenTarget to;
    bool failed = false;  // the thread's
  };

  /// How a presentation is played, by its number.
  struct Emission {
    std::uint32_t presentation = 0;
    std::optional<StudyPlayed> played;
  };

  void work(const std::stop_token& stop);
  std::optional<StudyPlayed> emission_of(const Presentation& presentation);
  Marker marker_of(const SoundChange& change);
  std::optional<double> play_time(const SoundChange& change) const;
  void wait(const SoundChange& change, Marker& marker) const;
  void send(Marker& marker);

  const Protocol& protocol_;
  const MarkerRun run_;
  const Device& device_;
  SoundWatch& sound_;

  // the thread's
  std::vector<Target> targets_;
  std::int64_t sent_ = 0;  // markers
  Presentation last_;
  int part_ = 0;

  std::mutex lock_;
  Emission emission_;  // of the newest presentation, under the lock

  SpscRing<Marker> markers_{1024};
  SpscRing<std::string> news_{64};
  std::jthread thread_;
};

}  // namespace prostm
