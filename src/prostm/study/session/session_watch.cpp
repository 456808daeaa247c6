/// Monitoring within a session: the participant's page, staircases at an end of their range, and
/// the strength of scenes.

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "prostm/study/session/detail/session_lines.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/task/line_keys.hpp"

namespace prostm {

PageTask StudySession::page_task() const {
  const bool plays = phase_ == StudyPhase::Training || phase_ == StudyPhase::Settling ||
                     phase_ == StudyPhase::Presenting;
  PageTask task;
  task.open = protocol_.trials.noise || protocol_.trials.answers == AnswersFrom::Participant;
  if (protocol_.trials.noise) task.noise = plays ? PageNoise::Playing : PageNoise::Silent;
  task.picture = wanted_.picture;
  return task;
}

/// Records unmet needs of the page, and restarts a trial during which one was unmet.
void StudySession::watch_page(const StudySight& sight) {
  if (phase_ == StudyPhase::Done || phase_ == StudyPhase::Withdrawn) return;
  if (page_.look(page_task(), sight.page, sight.time)) {
    const ResponseLine line = page_.line();
    const char* fine = line["open"] == true ? "The participant's page is open and reports."
                                            : "The participant's page is closed.";
    news_.push_back(page_.told().any() ? page_problem() : fine);
    write(line, sight);
  }
  const PageNeeds lost = page_.missing() & ~passed_over_;
  if (phase_ != StudyPhase::Presenting || lost.none() || intervals_.is_over()) return;
  page_.interrupt();
  enter(StudyPhase::Settling, sight.time);
  write({{line::kKind, line::kInterrupted},
         {line::kTrial, trials_done() + 1},
         {"missing", names_of(lost)}},
        sight);
}

/// Records that the track of the last answer has just reached an end of its range.
void StudySession::note_bound(const StudySight& sight) {
  if (course_.lanes().empty()) return;
  const int number = last_trial_->track;
  const AtBound bound = course_.lanes()[static_cast<std::size_t>(number) - 1].track.at_bound();
  if (bound.answers != task().traits().answers_at_bound) return;
  news_.push_back(at_bound());
  write({{line::kKind, line::kBound},
         {line::kTrial, trials_done()},
         {line::kTrack, number},
         {line::kBound, bound.low ? "low" : "high"},
         {"answers", bound.answers}},
        sight);
}

std::string StudySession::at_bound() const {
  const auto answers = [](const Course::Lane& lane) { return lane.track.at_bound().answers; };
  const auto& lanes = course_.lanes();
  const auto most = std::max_element(lanes.begin(), lanes.end(), [&](const auto& a, const auto& b) {
    return answers(a) < answers(b);
  });
  if (most == lanes.end() || answers(*most) < task().traits().answers_at_bound) return {};
  return study::bound_sentence(protocol_, *most);
}

bool StudySession::next_news(std::string& sentence) {
  if (news_.empty()) return false;
  sentence = news_.front();
  news_.erase(news_.begin());
  return true;
}

void StudySession::add_strength(const Trial& trial, double target, double rendered) {
  const auto place = static_cast<std::size_t>(trial.method) * protocol_.scenes.size() +
                     static_cast<std::size_t>(trial.scene);
  strengths_[place].target += target;
  strengths_[place].rendered += rendered;
  ++strengths_[place].looks;
}

double StudySession::strength_difference() const {
  if (task().traits().has_levels) return 0.0;  // levels differ on purpose
  const std::size_t scenes = protocol_.scenes.size();
  double worst = 0.0;
  for (std::size_t method = 0; method < protocol_.methods.size(); ++method) {
    double least = std::numeric_limits<double>::infinity(), most = 0.0;
    for (std::size_t scene = 0; scene < scenes; ++scene) {
      const Strength& s = strengths_[method * scenes + scene];
      if (s.looks == 0) continue;
      least = std::min(least, s.rendered / s.looks);
      most = std::max(most, s.rendered / s.looks);
    }
    if (most > 0.0) worst = std::max(worst, (most - least) / most);
  }
  return worst;
}

std::string StudySession::strengths() const {
  const double difference = strength_difference();
  if (difference <= protocol_.trials.strength) return {};
  return fmt::format(
      "Scenes of one method differ in strength by {:.0f} % (the protocol allows {:.0f} %): "
      "strength may be a cue.",
      100.0 * difference, 100.0 * protocol_.trials.strength);
}

}  // namespace prostm
