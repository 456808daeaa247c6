#include "prostm/study/session/roster.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prostm/core/file/file.hpp"
#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/session/session.hpp"
#include "prostm/study/session/spelling.hpp"
#include "prostm/study/session/study_status.hpp"
#include "study/study_support.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Do = StudyAct::Do;

const std::string kShort =
    "participants = 4\n[training]\nseconds = 0\n[trials]\nrepeats = 1\nrest = 0.1\nsettle = 0.5\n";

/// Writes the file of a participant who gives this many answers, and then leaves if `leaves`.
std::vector<Trial> write_participant(const Protocol& protocol, const std::string& path, int number,
                                     int answers, bool leaves,
                                     const std::optional<Replacement>& replaces = {}) {
  StudySight sight = test::sight_at(100.0);
  ResponseFile file(path);
  StudySession session(protocol, number, file, test::kFacts, sight, replaces);
  std::vector<Trial> trials;
  for (int i = 0; i < answers; ++i) {
    trials.push_back(session.trial());
    session.take({.what = Do::Next}, sight);
    while (session.phase() != StudyPhase::Presenting) {
      sight.time += 0.1;
      sight.utc += 0.1;
      session.look(sight);
    }
    session.take({.what = Do::Answer, .yes = true}, sight);
  }
  if (leaves) session.take({.what = Do::Withdraw}, sight);
  return trials;
}

TEST(Roster, IdsThatDifferOnlyInSpellingAreTheSame) {
  for (const char* id : {"7", "07", "007", " 7", "7 ", "\t7\r\n"})
    EXPECT_EQ(study::spelling_key(id), "7");
  EXPECT_EQ(study::spelling_key("P07"), study::spelling_key(" p07 "));
  EXPECT_NE(study::spelling_key("70"), study::spelling_key("7"));
  EXPECT_EQ(study::spelling_key("000"), "0");
  EXPECT_EQ(study::spelling_key("  "), "");
  EXPECT_EQ(study::spelling_key(""), "");
}

TEST(Roster, AReplacementHasTheOrderOfTheReplacedWhomTheAnalysisOmits) {
  for (const char* methods : {"methods = \"between\"\n", "methods = \"within\"\n"}) {
    const test::TemporaryFolder folder;
    const Protocol p = test::study_protocol(methods + kShort);
    const std::vector<std::string> files = {folder.file("1.jsonl"), folder.file("2.jsonl"),
                                            folder.file("9.jsonl"), folder.file("10.jsonl")};
    write_participant(p, files[0], 1, 2, false);
    const auto before = write_participant(p, files[1], 2, 2, true);
    const auto after = write_participant(p, files[2], 9, 2, true, Replacement{"2", 2});
    const auto last = write_participant(p, files[3], 10, 2, false, Replacement{"9", 2});
    EXPECT_EQ(before, after);
    EXPECT_EQ(before, last);
    const auto roster = read_roster(files);
    ASSERT_EQ(roster.size(), 4U);
    EXPECT_EQ(replacement_of(roster, roster[1])->participant, "9");
    EXPECT_EQ(roster[3].order, 2);
    EXPECT_EQ(replacement_of(roster, roster[0]), nullptr);
    std::vector<std::string> notes;
    for (const Answer& answer : read_answers(files, notes))
      EXPECT_TRUE(answer.participant == "1" || answer.participant == "10") << answer.participant;
    EXPECT_THAT(notes, testing::Contains(HasSubstr("Participant 2 was replaced by 9")));
    // participants who are not replaced in these files stay
    const std::vector<std::string> some = {files[0], files[1]};
    EXPECT_EQ(read_answers(some, notes).size(), 4U);
  }
}

TEST(Roster, AReplacementResumesAfterACrashWithTheSameOrder) {
  const test::TemporaryFolder folder;
  const Protocol p = test::study_protocol(kShort + "questions = \"random\"\n");
  const std::string path = folder.file("9.jsonl");
  write_participant(p, path, 9, 1, false, Replacement{"2", 2});
  write_participant(p, path, 9, 1, false, Replacement{"2", 2});
  EXPECT_EQ(read_roster(std::vector{path})[0].attendance, Attendance::Complete);
}

TEST(StudyStatus, CountsWhoFillsThePlacesOfEachGroup) {
  const test::TemporaryFolder folder;
  const Protocol p = test::study_protocol("methods = \"between\"\n" + kShort);
  const std::vector<std::string> files = {folder.file("1.jsonl"), folder.file("2.jsonl"),
                                          folder.file("3.jsonl"), folder.file("9.jsonl")};
  write_participant(p, files[0], 1, 2, false);
  write_participant(p, files[1], 2, 1, true);
  write_participant(p, files[2], 3, 1, false);
  write_participant(p, files[3], 9, 2, false, Replacement{"2", 2});
  const auto studies = study_status(read_roster(files));
  ASSERT_EQ(studies.size(), 1U);
  EXPECT_EQ(studies[0].planned, 4);
  GroupStatus sum;
  for (const GroupStatus& g : studies[0].groups) {
    EXPECT_EQ(g.planned, 2);
    EXPECT_EQ(g.planned, g.complete + g.under_way + g.left + static_cast<int>(g.open.size()));
    sum.complete += g.complete;
    sum.under_way += g.under_way;
    sum.left += g.left;
    sum.open.insert(sum.open.end(), g.open.begin(), g.open.end());
  }
  EXPECT_EQ(sum.complete, 2);
  EXPECT_EQ(sum.under_way, 1);
  EXPECT_EQ(sum.left, 0) << "2 was replaced";
  EXPECT_THAT(sum.open, ElementsAre(4));
  EXPECT_EQ(methods_of(studies[0].participants[3]), methods_of(studies[0].participants[1]));
}

TEST(StudyStatus, SeparatesProtocolsAndRejectsAParticipantTwice) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files = {folder.file("1.jsonl"), folder.file("2.jsonl")};
  write_participant(test::study_protocol(kShort), files[0], 1, 1, false);
  write_participant(test::study_protocol("blind = false\n" + kShort), files[1], 1, 1, false);
  EXPECT_EQ(study_status(read_roster(files)).size(), 2U);
  auto roster = read_roster(files);
  roster[1].protocol = roster[0].protocol;
  EXPECT_THAT(test::input_error([&] { study_status(roster); }), HasSubstr("participant 1 is in"));
}

}  // namespace
}  // namespace prostm
