/// Trials wait for the participant's page, and are presented again if it fails.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "prostm/core/file/file.hpp"
#include "prostm/study/session/session.hpp"
#include "study/study_support.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using Do = StudyAct::Do;

const ParticipantPage kFull{true, PageReport{true, PageNoise::Playing, true}};
const std::string kNoise = "[training]\nseconds = 0\n[trials]\nnoise = true\n";

/// A session in a run that obeys at once, with a participant's page.
struct Sitting {
  Sitting(const std::string& protocol_text, const ParticipantPage& page)
      : protocol(test::study_protocol(protocol_text)),
        file(folder.file("1.jsonl")),
        session(protocol, 1, file, test::kFacts, sight) {
    sight.page = page;
    pass();
  }

  void pass(double seconds = 0.05) {
    sight.time += seconds;
    sight.utc += seconds;
    session.look(sight);
  }
  void act(Do what) { ASSERT_EQ(session.take({.what = what}, sight), ""); }
  bool until(StudyPhase phase) {
    for (int i = 0; i < 400 && session.phase() != phase; ++i) pass();
    return session.phase() == phase;
  }
  std::vector<ResponseLine> lines(const std::string& kind) const {
    std::vector<ResponseLine> found;
    for (const ResponseLine& line : file.lines())
      if (line["kind"] == kind) found.push_back(line);
    return found;
  }

  test::TemporaryFolder folder;
  Protocol protocol;
  StudySight sight = test::sight_at(100.0);
  ResponseFile file;
  StudySession session;
};

ParticipantPage page_with(const std::function<void(ParticipantPage&)>& change) {
  ParticipantPage page = kFull;
  change(page);
  return page;
}

/// Reports of pages that lack something, and a word of the message to the experimenter.
std::vector<std::pair<ParticipantPage, std::string>> lacking_pages() {
  return {{ParticipantPage{}, "not open"},
          {page_with([](auto& p) { p.report.reset(); }), "does not report"},
          {page_with([](auto& p) { p.report->visible = false; }), "hidden"},
          {page_with([](auto& p) { p.report->noise = PageNoise::Off; }), "noise"},
          {page_with([](auto& p) { p.report->noise = PageNoise::Silent; }), "noise"}};
}

TEST(PageSession, HoldsATrialWhileThePageLacksARequirement) {
  for (const auto& [page, word] : lacking_pages()) {
    Sitting s(kNoise, page);
    s.act(Do::Next);
    EXPECT_FALSE(s.until(StudyPhase::Presenting)) << word;
    EXPECT_THAT(s.session.page_problem(), HasSubstr(word));
    std::string news;
    ASSERT_TRUE(s.session.next_news(news));
    EXPECT_THAT(news, HasSubstr(word));
    EXPECT_FALSE(s.lines("page").front()["missing"].empty());
    s.sight.page = kFull;
    ASSERT_TRUE(s.until(StudyPhase::Presenting)) << word;
    s.pass(1.0);
    EXPECT_EQ(s.session.page_problem(), "");
    EXPECT_TRUE(s.lines("page").back()["missing"].empty());
  }
}

TEST(PageSession, PresentsATrialAgainIfThePageLackedSomething) {
  for (const auto& [page, word] : lacking_pages()) {
    Sitting s(kNoise, kFull);
    s.act(Do::Next);
    ASSERT_TRUE(s.until(StudyPhase::Presenting));
    const Trial trial = s.session.trial();
    s.pass(0.4);
    s.sight.page = page;
    s.pass();
    EXPECT_EQ(s.session.phase(), StudyPhase::Settling) << word;
    EXPECT_FALSE(s.session.wanted().sound) << word;
    EXPECT_FALSE(s.until(StudyPhase::Presenting)) << word;
    s.sight.page = kFull;
    ASSERT_TRUE(s.until(StudyPhase::Presenting));
    EXPECT_EQ(s.session.trial(), trial);
    s.act(Do::Answer);
    ASSERT_TRUE(s.until(StudyPhase::Presenting));
    s.act(Do::Answer);
    const auto interrupted = s.lines("interrupted"), trials = s.lines("trial");
    ASSERT_EQ(interrupted.size(), 1U);
    EXPECT_EQ(interrupted[0]["trial"], 1);
    EXPECT_FALSE(interrupted[0]["missing"].empty());
    ASSERT_EQ(trials.size(), 2U);
    const ResponseLine whole = {
        {"open", true}, {"missing_s", ResponseLine::object()}, {"interrupted", 0}};
    EXPECT_EQ(trials[0]["page"]["interrupted"], 1);
    EXPECT_EQ(trials[0]["page"]["missing_s"], ResponseLine::object());
    EXPECT_EQ(trials[1]["page"], whole);
  }
}

TEST(PageSession, RecordsWhatATrialLackedThatWasPresentedAnyway) {
  Sitting s(kNoise, page_with([](auto& p) { p.report->noise = PageNoise::Off; }));
  s.act(Do::Next);
  EXPECT_FALSE(s.until(StudyPhase::Presenting));
  s.act(Do::Anyway);
  ASSERT_TRUE(s.until(StudyPhase::Presenting));
  s.pass(0.5);
  s.pass(0.5);
  EXPECT_EQ(s.session.phase(), StudyPhase::Presenting);
  s.act(Do::Answer);
  const ResponseLine trial = s.lines("trial").front();
  EXPECT_EQ(trial["anyway"], true);
  EXPECT_NEAR(trial["page"]["missing_s"]["noise"].get<double>(), 1.0, 0.06);
  EXPECT_FALSE(s.until(StudyPhase::Presenting)) << "overridden once only";
  s.act(Do::Anyway);
  ASSERT_TRUE(s.until(StudyPhase::Presenting));
  s.sight.page.report->visible = false;
  s.pass();
  EXPECT_EQ(s.session.phase(), StudyPhase::Settling) << "this was not overridden";
}

TEST(PageSession, NeedsNoPageIfTheProtocolDoesNotUseIt) {
  Sitting s("[training]\nseconds = 0\n", ParticipantPage{});
  s.act(Do::Next);
  ASSERT_TRUE(s.until(StudyPhase::Presenting));
  s.act(Do::Answer);
  EXPECT_EQ(s.lines("trial").front()["page"]["open"], false);
  EXPECT_EQ(s.session.page_problem(), "");
  // an open page shows the questions, so it must be visible
  s.sight.page = page_with([](auto& p) { p.report->visible = false; });
  EXPECT_FALSE(s.until(StudyPhase::Presenting));
  s.sight.page = page_with([](auto& p) { p.report->noise = PageNoise::Off; });
  EXPECT_TRUE(s.until(StudyPhase::Presenting));
}

TEST(PageSession, NeedsAPageOnWhichParticipantsAnswer) {
  Sitting s("[training]\nseconds = 0\n[trials]\nanswers = \"participant\"\n", ParticipantPage{});
  s.act(Do::Next);
  EXPECT_FALSE(s.until(StudyPhase::Presenting));
  s.sight.page = kFull;
  EXPECT_TRUE(s.until(StudyPhase::Presenting));
}

TEST(PageSession, TrainsOnlyWhileThePageMeetsItsRequirements) {
  Sitting s("[training]\nseconds = 20\n[trials]\nnoise = true\n", kFull);
  ASSERT_EQ(s.session.phase(), StudyPhase::Training);
  s.pass(1.0);
  EXPECT_TRUE(s.session.wanted().sound);
  s.sight.page = page_with([](auto& p) { p.report->picture = false; });
  const double left = s.session.training_left();
  s.pass(5.0);
  s.pass(5.0);
  EXPECT_FALSE(s.session.wanted().sound);
  EXPECT_EQ(s.session.training_left(), left);
  EXPECT_THAT(s.session.page_problem(), HasSubstr("draw"));
  s.act(Do::EndTraining);
  EXPECT_EQ(s.lines("training").front()["page_missing"], (ResponseLine{"picture"}));
}

TEST(PageSession, OmitsConditionsShorterThanASecondFromItsRecord) {
  Sitting s(kNoise, kFull);
  s.act(Do::Next);
  for (int i = 0; i < 40; ++i) {
    s.sight.page.report->noise = i % 2 == 0 ? PageNoise::Silent : PageNoise::Playing;
    s.pass(0.5);
  }
  EXPECT_TRUE(s.lines("page").size() <= 1U) << "the page was opened";
}

}  // namespace
}  // namespace prostm
