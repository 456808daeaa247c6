#include "prostm/study/session/page_watch.hpp"

#include "prostm/study/session/detail/session_lines.hpp"
#include "prostm/study/task/line_keys.hpp"

namespace prostm {
namespace {

constexpr double kStays =
    1.0;  // a recorded change has lasted this long, e.g. past the noise's fade-in [s]

}  // namespace

bool PageWatch::look(const PageTask& task, const ParticipantPage& page, double time) {
  const PageNeeds now = prostm::missing(task, page);
  if (now != missing_ || page.open != open_) since_ = time;
  missing_ = now;
  open_ = page.open;
  if ((open_ == told_open_ && missing_ == told_missing_) || time - since_ < kStays) return false;
  told_open_ = open_;
  told_missing_ = missing_;
  return true;
}

ResponseLine PageWatch::line() const {
  return {{line::kKind, line::kPage}, {"open", told_open_}, {"missing", names_of(told_missing_)}};
}

void PageWatch::begin_presentation() {
  open_at_onset_ = open_;
  lost_.fill(0.0);
}

void PageWatch::present(double passed) {
  for (std::size_t i = 0; i < lost_.size(); ++i)
    if (missing_[i]) lost_[i] += passed;
}

ResponseLine PageWatch::of_trial() const {
  ResponseLine lost = ResponseLine::object();
  for (std::size_t i = 0; i < lost_.size(); ++i)
    if (lost_[i] > 0.0) lost[std::string(kNames<PageNeed>[i])] = study::rounded(lost_[i], 3);
  return {{"open", open_at_onset_}, {"missing_s", lost}, {"interrupted", interrupted_}};
}

}  // namespace prostm
