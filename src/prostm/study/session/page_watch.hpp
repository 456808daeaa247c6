#pragma once
/// Tracks the unmet needs of the participant's page, over time and within trials.

#include <array>

#include "prostm/study/session/participant_page.hpp"
#include "prostm/study/session/response_file.hpp"

namespace prostm {

class PageWatch {
 public:
  /// Updates the state. @return true if the page changed and has stayed so for a second: write
  /// line() then.
  bool look(const PageTask& task, const ParticipantPage& page, double time);

  const PageNeeds& missing() const { return missing_; }  ///< current unmet needs
  /// Needs that were missing when line() was last due; changes less often than missing().
  const PageNeeds& told() const { return told_missing_; }
  /// Whether a page is open, and what is missing, for the response file.
  ResponseLine line() const;

  void begin_presentation();
  void present(double passed);  ///< adds time to the current presentation [s]
  void interrupt() { ++interrupted_; }
  void end_trial() { interrupted_ = 0; }
  /// The page's part of a trial's line: whether a page was open when the presentation began, how
  /// long each need was missing during it [s], and the number of earlier presentations that were
  /// interrupted.
  ResponseLine of_trial() const;

 private:
  bool open_ = false, told_open_ = false, open_at_onset_ = false;
  PageNeeds missing_, told_missing_;
  double since_ = 0.0;  // time of the last change [s]
  std::array<double, kNames<PageNeed>.size()> lost_{};
  int interrupted_ = 0;
};

}  // namespace prostm
