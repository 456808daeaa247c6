#pragma once
/// A study as a source for the server, which shows it to the experimenter and the participant, and
/// runs it.

#include <atomic>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "prostm/core/spsc_ring.hpp"
#include "prostm/pipeline/live.hpp"
#include "prostm/study/live/marker_sender.hpp"
#include "prostm/study/session/rehearsal.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/viewer/pipeline_view.hpp"
#include "prostm/viewer/view_source.hpp"

namespace prostm {

/// The wall clock and the steady clock, with no hand and no stimulus in force.
StudySight study_time();

/// The experimenter is in the main room. The participant is the guest and gets only what the
/// protocol allows: except for the picture during training, no message to the participant depends
/// on the stimulus. In a blind study the same holds for the experimenter.
class StudyView : public ViewSource {
 public:
  /// @param session used only by the server's thread from now on. @param rehearsal answers instead
  /// of people, if given. @param markers recorded with the session; null: none. All must outlive
  /// this.
  StudyView(LiveLink& link, ViewHello hello, StudySession& session,
            std::optional<Rehearsal> rehearsal = {}, MarkerSender* markers = nullptr);

  /// Takes the oldest pending message for the experimenter; false if no message is pending. For the
  /// program's thread.
  bool next_news(std::string& sentence) { return news_for_terminal_.pop(sentence); }
  /// Whether a finished session was closed, or a rehearsal is done. Thread-safe.
  bool closed() const { return closed_.load(std::memory_order_relaxed); }

  void watch(bool) override {}
  void refresh(ViewFrame& frame, ViewNews& news) override;
  bool shows_frames(Room room) const override;
  std::string hello(std::uint32_t page, Room room) override;
  bool refresh_state(Room room, std::string& state) override;
  std::string take(std::uint32_t page, const PageMessage& message) override;
  bool next_refusal(std::uint32_t& page, std::string& sentence) override;
  void forget(std::uint32_t page) override;

 private:
  void tick();
  StudySight sight();
  ParticipantPage participants_page(double time) const;
  std::string take_report(std::uint32_t page, const PageReport& report);
  void present(const StudyWanted& wanted);
  bool is_asked(const StudyWanted& wanted) const;
  void let_sound(bool sound);
  std::string act(Room room, const StudyAct& act);
  nlohmann::ordered_json both(const char* room) const;
  std::string waits_without_stimulus() const;
  nlohmann::ordered_json experimenter() const;
  nlohmann::ordered_json participant() const;

  LiveLink& link_;
  PipelineView run_;
  StudySession& session_;
  std::optional<Rehearsal> rehearsal_;
  MarkerSender* markers_;
  bool sounds_ = false;                // whether the study's mute is off
  std::optional<StudyPlayed> played_;  // emission of the newest plan
  std::uint32_t presentations_ = 0;
  struct OpenPage {
    Room room = Room::Main;
    std::optional<PageReport> report;  // newest report
    double reported = 0.0;             // time of the report [s]
  };
  std::map<std::uint32_t, OpenPage> pages_;
  SpscRing<std::string> news_for_terminal_{64};
  ViewFrame frame_;  // newest frame
  ViewNews news_;
  StudyWanted asked_;                             // last stimulus requested of the run
  std::shared_ptr<const LiveSettings> settings_;  // settings for asked_; null before the first
  std::string problem_;                           // problem with these settings
  std::string told_[std::size(kRooms)];
  std::atomic<bool> closed_{false};
};

}  // namespace prostm
