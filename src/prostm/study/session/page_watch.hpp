#pragma once
/// Follows what the participant's page lacks, over time and within trials.

#include <array>

#include "prostm/study/session/participant_page.hpp"
#include "prostm/study/session/response_file.hpp"

namespace prostm {

class PageWatch {
 public:
  /// @return true where the page has changed and stayed so for a second: line() is to be written.
  bool look(const PageTask& task, const ParticipantPage& page, double time);

  const PageNeeds& missing() const { return missing_; }  ///< now
  /// Needs that were missing when line() was last due. It changes less often than missing().
  const PageNeeds& told() const { return told_missing_; }
  /// Whether a page is open, and what is missing, for the response file.
  ResponseLine line() const;

  void begin_presentation();
  void present(double passed);  ///< a presentation goes on [s]
  void interrupt() { ++interrupted_; }
  void end_trial() { interrupted_ = 0; }
  /// For a trial's line: whether a page was open when the presentation began, how long each need
  /// was missing during it [s], and how many presentations of the trial were interrupted before.
  ResponseLine of_trial() const;

 private:
  bool open_ = false, told_open_ = false, open_at_onset_ = false;
  PageNeeds missing_, told_missing_;
  double since_ = 0.0;  // as it is now [s]
  std::array<double, kNames<PageNeed>.size()> lost_{};
  int interrupted_ = 0;
};

}  // namespace prostm
