#pragma once
/// Sends markers at the time of the events that they mark.

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

/// The part common to all markers of a run.
struct MarkerRun {
  int participant = 0;
  int run = 1;  ///< number of this participant's run, from 1
};

/// A thread takes each change of the output, asks the device when its sample leaves the array,
/// waits until then, and sends the marker. A failed send is reported once; sending continues. All
/// markers are also passed to the study, which records them.
class MarkerSender {
 public:
  /// Starts the thread. All arguments but `run` must remain valid until stop().
  MarkerSender(std::vector<OpenTarget> targets, const Protocol& protocol, const MarkerRun& run,
               const Device& device, SoundWatch& sound);
  ~MarkerSender() { stop(); }
  MarkerSender(const MarkerSender&) = delete;
  MarkerSender& operator=(const MarkerSender&) = delete;

  /// Sends the remaining markers, and ends the thread.
  void stop();

  // ---- the study's thread ----
  /// Sets the next presentation and the emission of its newest plan. Call it before unmuting.
  void present(const Presentation& now, const std::optional<StudyPlayed>& played);
  /// Sets the emission of the newest plan of the current presentation; it holds until the next
  /// plan.
  void tell(const StudyPlayed& played);
  /// Takes the oldest marker not yet passed to the study; false if all were.
  bool next(Marker& out) { return markers_.pop(out); }
  /// Returns the marker's line for the response file.
  ResponseLine line(const Marker& marker) const;

  // ---- the program's thread ----
  /// Takes the oldest pending message about a target; false if no message is pending.
  bool next_news(std::string& sentence) { return news_.pop(sentence); }

 private:
  struct Target {
    OpenTarget to;
    bool failed = false;  // used by the thread only
  };

  /// The emission of a presentation, by its number.
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
  std::int64_t sent_ = 0;  // number of markers
  Presentation last_;
  int part_ = 0;

  std::mutex lock_;
  Emission emission_;  // of the newest presentation; guarded by lock_

  SpscRing<Marker> markers_{1024};
  SpscRing<std::string> news_{64};
  std::jthread thread_;
};

}  // namespace prostm
