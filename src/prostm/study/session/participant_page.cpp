#include "prostm/study/session/participant_page.hpp"

namespace prostm {
namespace {

PageNeeds only(PageNeed need) {
  PageNeeds needs;
  needs.set(static_cast<std::size_t>(need));
  return needs;
}

constexpr std::array<const char*, kNames<PageNeed>.size()> kSentences = {
    "The participant's page is not open: open it on the participant's screen (/participant).",
    "The participant's page does not report its state: reload it.",
    "The participant's page is hidden: bring its tab or window to the front.",
    "The masking noise does not play: press \"Switch the noise on\" on the participant's page.",
    "The participant's page does not draw the simulation: reload it, or end the training."};

}  // namespace

PageNeeds missing(const PageTask& task, const ParticipantPage& page) {
  if (!page.open) return task.open ? only(PageNeed::Open) : PageNeeds();
  if (!page.report) return only(PageNeed::Report);
  PageNeeds needs;
  if (!page.report->visible) needs |= only(PageNeed::Visible);
  if (page.report->noise < task.noise) needs |= only(PageNeed::Noise);
  if (task.picture && !page.report->picture) needs |= only(PageNeed::Picture);
  return needs;
}

std::vector<std::string_view> names_of(const PageNeeds& needs) {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < needs.size(); ++i)
    if (needs[i]) names.push_back(kNames<PageNeed>[i]);
  return names;
}

std::string sentence(const PageNeeds& missing) {
  for (std::size_t i = 0; i < missing.size(); ++i)
    if (missing[i]) return kSentences[i];
  return {};
}

}  // namespace prostm
