#pragma once
/// A study, as the server shows it to the experimenter and to the participant, and leads the run
/// through it.

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

/// The day's clock, and a clock that never jumps, with no hand and nothing in force.
StudySight study_time();

/// The experimenter is in the main room. The participant is the guest, who gets only what the
/// protocol shows: nothing that they are sent depends on what is presented, the picture during
/// training excepted. In a blind study nothing that the experimenter is sent does either.
class StudyView : public ViewSource {
 public:
  /// @param session is used by the server's thread from now on. All must outlive this.
  /// @param rehearsal that stands in for people, if any does.
  /// @param markers that are written down with the session; null: none.
  StudyView(LiveLink& link, ViewHello hello, StudySession& session,
            std::optional<Rehearsal> rehearsal = {}, MarkerSender* markers = nullptr);

  /// The oldest sentence for the experimenter that was not read yet; false without one. The
  /// program's thread.
  bool next_news(std::string& sentence) { return news_for_terminal_.pop(sentence); }
  /// Somebody has closed a session that is over, or a rehearsal is done. Any thread.
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
  nlohmann::ordered_json experimenter() const;
  nlohmann::ordered_json participant() const;

  LiveLink& link_;
  PipelineView run_;
  StudySession& session_;
  std::optional<Rehearsal> rehearsal_;
  MarkerSender* markers_;
  bool sounds_ = false;                // not muted for the study
  std::optional<StudyPlayed> played_;  // emission of the newest plan
  std::uint32_t presentations_ = 0;
  struct OpenPage {
    Room room = Room::Main;
    std::optional<PageReport> report;  // the newest
    double reported = 0.0;             // when it came [s]
  };
  std::map<std::uint32_t, OpenPage> pages_;
  SpscRing<std::string> news_for_terminal_{64};
  ViewFrame frame_;  // the newest
  ViewNews news_;
  StudyWanted asked_;                             // of the run, last
  std::shared_ptr<const LiveSettings> settings_;  // for it; nothing before the first
  std::string problem_;                           // with them
  std::string told_[std::size(kRooms)];
  std::atomic<bool> closed_{false};
};

}  // namespace prostm
