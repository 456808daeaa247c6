#include "prostm/study/analysis/scores.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>

#include "prostm/core/file/file.hpp"
#include "prostm/core/random.hpp"
#include "prostm/study/session/response_file.hpp"
#include "support/input_errors.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

std::vector<Answer> read(const std::string& text) {
  return answers_from_csv(text, "a.csv");
}

std::string refusal(const std::string& text) {
  return test::input_error([&] { read(text); });
}

const std::string kHeader = "participant,method,scene,correct\n";

TEST(Scores, ReadColumnsInAnyOrderAmongOthers) {
  const auto answers = read(
      "\xEF\xBB\xBFnote,correct,scene,method,participant,question,answer\r\n"
      "\"a, \"\"b\"\"\r\nc\",1,four-plumes,am,P1,one-plume,0\r\n"
      "\r\n"
      ",0,one-plume,pro-stm,P2,one-plume,0");
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].participant, "P1");
  EXPECT_EQ(answers[0].method, "am");
  EXPECT_EQ(answers[0].scene, "four-plumes");
  EXPECT_TRUE(answers[0].correct);
  EXPECT_EQ(answers[0].question, "one-plume");
  EXPECT_FALSE(answers[0].yes);
  EXPECT_EQ(answers[1].participant, "P2");
  EXPECT_FALSE(answers[1].correct);
}

TEST(Scores, MayOmitQuestions) {
  const auto answers = read(kHeader + "1,am,x,1\n1,am,x,0\n");
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].question, "");
}

TEST(Scores, ErrorsAreReportedWithTheirLine) {
  EXPECT_THAT(refusal("participant,method,correct\n1,am,1\n"), HasSubstr("no column \"scene\""));
  EXPECT_THAT(refusal("scene,scene,participant,method,correct\n"), HasSubstr("twice"));
  EXPECT_THAT(refusal(kHeader), HasSubstr("no answer"));
  EXPECT_THAT(refusal("\n\n"), HasSubstr("no header"));
  EXPECT_THAT(refusal(kHeader + "1,am,x,1\n1,am,x\n"), HasSubstr("line 3: has 3 columns"));
  EXPECT_THAT(refusal(kHeader + "1,am,x,maybe\n"), HasSubstr("line 2: correct is \"maybe\""));
  EXPECT_THAT(refusal(kHeader + ",am,x,1\n"), HasSubstr("participant is empty"));
  EXPECT_THAT(refusal(kHeader + "1,am,\"x,1\n"), HasSubstr("cut off"));
  EXPECT_THAT(refusal(kHeader + "1,am,x\"y,1\n"), HasSubstr("a quote stands inside"));
  EXPECT_THAT(refusal(kHeader + "1,am,\"x\"y,1\n"), HasSubstr("after its closing quote"));
  EXPECT_THAT(refusal(kHeader + "\"1\n2\",am,x,1\n"),
              HasSubstr("participant contains a line break"));
  EXPECT_THAT(refusal(kHeader + std::string("1,a\0m,x,1\n", 10)), HasSubstr("control character"));
}

// A person who corrects a score by hand may forget the answer, or copy a line.
TEST(Scores, HandEditedOnesAreRejected) {
  const std::string header = "participant,trial,method,scene,question,answer,correct\n";
  EXPECT_EQ(read(header + "1,1,am,x,x,1,1\n1,2,am,x,y,1,0\n2,1,am,x,y,0,1\n").size(), 3U);
  EXPECT_THAT(refusal(header + "1,1,am,x,x,1,1\n1,2,am,x,y,1,1\n"),
              HasSubstr("line 3: correct is 1, but the answer 1"));
  EXPECT_THAT(refusal(header + "1,1,am,x,x,1,1\n1,1,am,x,x,1,1\n"), HasSubstr("has trial 1 twice"));
}

TEST(Scores, HaveALevelInEachRowOrNone) {
  const std::string header = "participant,method,scene,correct,level\n";
  const auto answers = read(header + "1,am,x,1,0.25\n1,am,x,0,-2e-3\n1,am,x,0,-0\n");
  EXPECT_EQ(answers[0].level, 0.25);
  EXPECT_EQ(answers[1].level, -2e-3);
  EXPECT_EQ(answers[2].level, 0.0);
  EXPECT_FALSE(read(kHeader + "1,am,x,1\n")[0].level);
  for (const char* wrong :
       {"", " ", "x", "1,500", "1.5,5", "0.5 mm", "nan", "inf", "1e999", "1e10", "1e-12"}) {
    const std::string quoted = std::string("\"") + wrong + '"';
    EXPECT_THAT(refusal(header + "1,am,x,1,0.25\n1,am,x,0," + quoted + '\n'),
                HasSubstr("line 3: level is "));
  }
}

TEST(Scores, RoundTripThroughATidyTable) {
  Random random(11);
  constexpr std::array kNames = {"am", "a, b", "\"", "\"x\"", "a|b", "é;", "-1", "a\"\",b"};
  const auto name = [&] {
    return kNames.at(static_cast<std::size_t>(random.below(kNames.size())));
  };
  for (int table = 0; table < 300; ++table) {
    const bool trials = random.below(2) == 0, questions = random.below(2) == 0,
               levels = random.below(2) == 0;
    std::vector<Answer> answers;
    for (int i = 0; i < 20; ++i) {
      Answer a{.participant = name(), .method = name(), .scene = name()};
      a.correct = random.below(2) == 0;
      if (questions) {
        a.question = name();
        a.yes = (a.question == a.scene) == a.correct;
      }
      if (trials) a.trial = std::to_string(i);
      if (levels) a.level = std::ldexp(random.uniform() - 0.5, random.below(20));
      if (i > 0 && random.below(8) == 0) a.answered = a.correct = a.yes = false;
      if (!a.answered) a.question.clear();
      answers.push_back(a);
    }
    const std::string text = tidy_csv(answers);
    EXPECT_EQ(read(text), answers) << text;
    const int columns = 4 + (trials ? 1 : 0) + (questions ? 2 : 0) + (levels ? 1 : 0);
    const std::string header = text.substr(0, text.find("\r\n"));
    EXPECT_EQ(std::count(header.begin(), header.end(), ','), columns - 1);
  }
}

TEST(Scores, TheFileNameMustStateTheKind) {
  const auto refused = [](const std::vector<std::string>& files) {
    std::vector<std::string> notes;
    return test::input_error([&] { read_answers(files, notes); });
  };
  EXPECT_THAT(refused({"scores.xlsx"}), HasSubstr("save spreadsheets as CSV"));
  EXPECT_THAT(refused({"/nowhere/scores.csv"}), HasSubstr("/nowhere/scores.csv"));
  EXPECT_THAT(refused({"a.jsonl", "b.json"}), HasSubstr("a.jsonl"));
}

TEST(Scores, OfThePaperAreRead) {
  const std::string scores = R"({"fig4": {"trials_per_participant": 4,
      "AM_correct": [2, 3], "AM_1plume": [1, 1], "AM_4plume": [1, 2],
      "STM_correct": [4], "STM_1plume": [2], "STM_4plume": [2]}})";
  const auto answers = answers_from_paper(scores, "p.json");
  ASSERT_EQ(answers.size(), 12U);
  int right = 0;
  for (const Answer& a : answers) right += a.correct && a.method == "am" ? 1 : 0;
  EXPECT_EQ(right, 5);
  EXPECT_EQ(answers.back().participant, "pro-stm-1");
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = scores;
    text.replace(text.find(from), from.size(), to);
    return test::input_error([&] { answers_from_paper(text, "p.json"); });
  };
  EXPECT_THAT(refused("[2, 3]", "[2, 4]"), HasSubstr("sum of both scenes, 3"));
  EXPECT_THAT(refused("[1, 2]", "[1]"), HasSubstr("one number for each participant"));
  EXPECT_THAT(refused("[1, 2]", "[1, 3]"), HasSubstr("3"));
  EXPECT_THAT(refused("\"trials_per_participant\": 4", "\"trials_per_participant\": 5"),
              HasSubstr("even"));
  EXPECT_THAT(refused("STM_4plume", "STM_5plume"), HasSubstr("STM_4plume"));
}

/// A participant's file with a few trials.
void write_responses(const std::string& path, const std::string& participant, int trials) {
  ResponseFile file(path);
  file.append({{"kind", "begin"},
               {"format", kResponseFormat},
               {"participant", participant},
               {"trials", 2},
               {"run", {{"rehearsal", false}}}});
  for (int i = 1; i <= trials; ++i) {
    file.append({{"kind", "go"}});
    file.append({{"kind", "trial"},
                 {"trial", i},
                 {"method", "am"},
                 {"scene", "one-plume"},
                 {"question", "four-plumes"},
                 {"answer", 0},
                 {"correct", 1}});
  }
}

TEST(Scores, OfParticipantsFilesAreReadTogether) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files = {folder.file("1.jsonl"), folder.file("2.jsonl")};
  write_responses(files[0], "1", 2);
  write_responses(files[1], "2", 1);
  std::vector<std::string> notes;
  const auto answers = read_answers(files, notes);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[1], (Answer{"1", "am", "one-plume", true, "four-plumes", false, "2"}));
  EXPECT_EQ(answers[2].participant, "2");
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_THAT(notes[0], HasSubstr("Participant 2 gave 1 of 2 answers"));
  const std::vector<std::string> twice = {files[0], files[1], files[0]};
  EXPECT_THAT(test::input_error([&] { read_answers(twice, notes); }),
              HasSubstr("have the same content"));
}

TEST(Scores, OfTrialsWithLevelsHaveTheKindOfTheirTask) {
  const test::TemporaryFolder folder;
  std::vector<std::string> notes;
  const auto read = [&](const std::string& name, const nlohmann::ordered_json& protocol) {
    const std::string path = folder.file(name);
    {
      ResponseFile file(path);
      file.append({{"kind", "begin"},
                   {"format", kResponseFormat},
                   {"participant", name},
                   {"protocol", protocol},
                   {"trials", 60},
                   {"run", {{"rehearsal", false}}}});
      file.append({{"kind", "trial"},
                   {"trial", 1},
                   {"method", "stm"},
                   {"scene", "one-plume"},
                   {"level", 1.5},
                   {"answer", 2},
                   {"felt", 1},
                   {"correct", 0}});
      file.append({{"kind", "end"}});
    }
    const std::vector<std::string> files = {path};
    return read_answers(files, notes).front();
  };
  const Answer right =
      read("a.jsonl", {{"trials", {{"task", "forced-choice"}}}, {"level", {{"against", ""}}}});
  EXPECT_EQ(right.kind, AnswerKind::Right);
  EXPECT_FALSE(right.correct);
  EXPECT_EQ(right.level, 1.5);
  EXPECT_EQ(right.question, "");
  const Answer felt =
      read("b.jsonl", {{"trials", {{"task", "forced-choice"}}}, {"level", {{"against", "am"}}}});
  EXPECT_EQ(felt.kind, AnswerKind::Felt);
  EXPECT_TRUE(felt.correct);
  EXPECT_EQ(read("c.jsonl", {{"trials", {{"task", "judgement"}}}}).kind, AnswerKind::Felt);
  EXPECT_EQ(read("d.jsonl", {{"trials", {{"task", "adjustment"}}}}).kind, AnswerKind::Adjusted);
  EXPECT_TRUE(notes.empty()) << "60 trials were the limit; a staircase may end earlier";
  const std::vector<std::string> mixed = {folder.file("a.jsonl"), folder.file("c.jsonl")};
  EXPECT_THAT(test::input_error([&] { read_answers(mixed, notes); }), HasSubstr("different tasks"));
  // as a table, too
  for (const Answer& a : {right, felt})
    EXPECT_EQ(answers_from_csv(tidy_csv(std::span(&a, 1)), "t.csv").front(), a);
}

TEST(Scores, AParticipantsFileNeedsItsFirstLineAndCompleteTrials) {
  const test::TemporaryFolder folder;
  std::vector<std::string> notes;
  const auto refused = [&](const std::string& name) {
    const std::vector<std::string> files = {folder.file(name)};
    return test::input_error([&] { read_answers(files, notes); });
  };
  ResponseFile(folder.file("a.jsonl")).append({{"kind", "trial"}});
  EXPECT_THAT(refused("a.jsonl"),
              HasSubstr("line 1 is not the first line of a participant's file"));
  write_responses(folder.file("b.jsonl"), "1", 1);
  ResponseFile(folder.file("b.jsonl")).append({{"kind", "trial"}, {"method", "am"}});
  EXPECT_THAT(refused("b.jsonl"), HasSubstr("b.jsonl, line 4: "));
  write_responses(folder.file("d.jsonl"), "1", 1);
  ResponseFile(folder.file("d.jsonl"))
      .append({{"kind", "correction"}, {"trial", 2}, {"answer", 0}, {"correct", 0}});
  EXPECT_THAT(refused("d.jsonl"), HasSubstr("line 4 corrects a trial that is not the last"));
  write_responses(folder.file("c.jsonl"), "1", 0);
  EXPECT_THAT(refused("c.jsonl"), HasSubstr("has no answer"));
}

/// A trial of a forced choice, as a session writes it.
const ResponseLine kForcedChoice = {
    {"kind", "trial"},
    {"trial", 1},
    {"method", "stm"},
    {"scene", "x"},
    {"track", 2},
    {"level", 1.5},
    {"reference", 1.0},
    {"interval", 2},
    {"answer", 1},
    {"felt", 0},
    {"correct", 0},
    {"response_s", 1.25},
    {"stimulus", "00000001"},
    {"gate", {{"pass", false}}},
    {"anyway", true},
    {"target_mn", 2.5},
    {"rendered_mn", 2.25},
    {"played", {{"speed_m_s", 7.0}, {"period_ms", 20.0}, {"changed_paths", 0}}},
    {"hand_gone_s", 0.0},
    {"utc", "2026-01-01T00:00:00.000Z"},
    {"time_s", 12.5}};

TEST(Scores, TidyTablesHaveTheFactsOfEachTrial) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files = {folder.file("1.jsonl")};
  {
    ResponseFile file(files[0]);
    file.append(
        {{"kind", "begin"},
         {"format", kResponseFormat},
         {"participant", "1"},
         {"protocol", {{"trials", {{"task", "forced-choice"}}}, {"level", {{"against", ""}}}}},
         {"trials", 2},
         {"run", {{"rehearsal", false}}}});
    file.append(kForcedChoice);
    file.append({{"kind", "correction"}, {"trial", 1}, {"answer", 2}, {"felt", 1}, {"correct", 1}});
    ResponseLine without_plan = kForcedChoice;
    without_plan["trial"] = 2;
    without_plan["played"] = nullptr;
    file.append(without_plan);
    file.append({{"kind", "end"}});
  }
  std::vector<std::string> notes;
  const auto answers = read_answers(files, notes);
  const std::string tidy = tidy_csv(answers);
  EXPECT_THAT(tidy, testing::StartsWith(
                        "participant,method,scene,trial,correct,level,response_s,"
                        "stimulus_checksum,gate,protocol_checksum,answer_given,track,reference,"
                        "interval,anyway,target_mn,rendered_mn,hand_gone_s,played_speed_m_s,"
                        "played_period_ms,played_changed_paths,utc,time_s\r\n"
                        "1,stm,x,1,1,1.5,1.25,00000001,anyway,"));
  EXPECT_THAT(tidy, HasSubstr(",2,2,1.0,2,1,2.5,2.25,0.0,7.0,20.0,0,2026-01-01T00:00:00.000Z,"
                              "12.5\r\n1,stm,x,2,0,"));
  EXPECT_THAT(tidy, HasSubstr(",1,2,1.0,2,1,2.5,2.25,0.0,,,,2026-01-01T00:00:00.000Z,12.5\r\n"));
  EXPECT_EQ(answers_from_csv(tidy, "tidy.csv"), answers);
}

// Two labs both start with participant 1.
TEST(Scores, TwoPeopleWithOneNumberAreSeparatedOnRequest) {
  const test::TemporaryFolder folder;
  std::vector<std::string> notes, files;
  for (const char* lab : {"lab-a", "lab-b"}) {
    std::filesystem::create_directories(folder.file(lab) + "/answers");
    files.push_back(folder.file(lab) + "/answers/participant-1.jsonl");
    write_responses(files.back(), "1", lab[4] == 'a' ? 1 : 2);
  }
  EXPECT_THAT(test::input_error([&] { read_answers(files, notes); }),
              AllOf(HasSubstr("participant 1 is in"), HasSubstr("--prefix folder")));
  ReadingSettings settings;
  settings.prefix = IdPrefix::Folder;
  auto answers = read_answers(files, notes, settings);
  EXPECT_EQ(answers.front().participant, "lab-a/1");
  EXPECT_EQ(answers.back().participant, "lab-b/1");
  settings.rename = {"participant:lab-b/1=2"};
  EXPECT_EQ(read_answers(files, notes, settings).back().participant, "2");
  settings.rename = {"participant:lab-c/1=2"};
  EXPECT_THAT(test::input_error([&] { read_answers(files, notes, settings); }),
              HasSubstr("no participant \"lab-c/1\"; did you mean"));
  settings.rename.clear();
  settings.prefix = IdPrefix::None;
  EXPECT_EQ(read_answers(files, notes, settings).back().participant, "1");
}

TEST(Scores, NamesThatDifferOnlyInSpellingAreTheSame) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files = {folder.file("a.csv")};
  std::vector<std::string> notes;
  const auto refused = [&](const std::string& rows) {
    write_file(files[0], kHeader + rows);
    return test::input_error([&] { read_answers(files, notes); });
  };
  EXPECT_THAT(refused("01,am,x,1\n1,stm,x,1\n"),
              AllOf(HasSubstr("participants \"01\" and \"1\""), HasSubstr("--merge-spellings")));
  EXPECT_THAT(refused("P1,am,x,1\np1,stm,x,1\n"), HasSubstr("\"P1\" and \"p1\""));
  EXPECT_THAT(refused("1,pro-stm,x,1\n2,Pro_STM,x,1\n"), HasSubstr("methods \"pro-stm\""));
  EXPECT_THAT(refused("1,am,one plume,1\n2,am,one-plume,1\n"), HasSubstr("scenes \"one plume\""));
  ReadingSettings merge;
  merge.merge_spellings = true;
  write_file(files[0], kHeader + "01,am,x,1\n1,stm,x,1\n");
  EXPECT_EQ(read_answers(files, notes, merge).back().participant, "01");
  EXPECT_THAT(notes.back(), HasSubstr("each pair is treated as one"));
  // white space at the ends is not spelling; no-break spaces of spreadsheets count as white space
  write_file(files[0], kHeader + "01,am,x,1\n01 ,stm,x,1\n\xC2\xA0" + "01,am, x,1\n");
  notes.clear();
  for (const Answer& a : read_answers(files, notes)) {
    EXPECT_EQ(a.participant, "01");
    EXPECT_EQ(a.scene, "x");
  }
  EXPECT_THAT(notes, Contains(HasSubstr("participant \"01\": written with and without")));
}

/// A participant's file with one trial of a method with the given preset.
void write_study(const std::string& path, const std::string& participant, const std::string& preset,
                 const std::string& hand = "study", bool rehearsal = false) {
  ResponseFile file(path);
  file.append({{"kind", "begin"},
               {"format", kResponseFormat},
               {"participant", participant},
               {"protocol", {{"method", {{"stm", {{"plan", {{"preset", preset}}}}}}}}},
               {"trials", 1},
               {"run", {{"prostm", "1"}, {"hand", hand}, {"rehearsal", rehearsal}}}});
  file.append({{"kind", "trial"},
               {"trial", 1},
               {"method", "stm"},
               {"scene", "x"},
               {"question", "x"},
               {"answer", 1},
               {"correct", 1},
               {"response_s", 1.5},
               {"stimulus", preset == "fast" ? "00000001" : "00000002"},
               {"gate", {{"pass", false}}},
               {"anyway", true}});
  file.append({{"kind", "end"}});
}

TEST(Scores, DifferentStimuliAreNotPooledUnderOneName) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files = {folder.file("1.jsonl"), folder.file("2.jsonl")};
  write_study(files[0], "1", "fast");
  write_study(files[1], "2", "best", "page");
  std::vector<std::string> notes;
  EXPECT_THAT(test::input_error([&] { read_answers(files, notes); }),
              AllOf(HasSubstr("method.stm.plan.preset is \"best\" (participant 2) and \"fast\" "
                              "(participant 1)"),
                    HasSubstr("--pool")));
  ReadingSettings pool;
  pool.pool = true;
  notes.clear();
  const auto answers = read_answers(files, notes, pool);
  EXPECT_THAT(notes, Contains(HasSubstr("different stimuli are combined (--pool)")));
  EXPECT_THAT(notes, Contains(HasSubstr("The hand differs: page (participant 2) and study")));
  EXPECT_THAT(notes, Contains(HasSubstr("2 trials with stm were presented although")));
  // a tidy table carries the values to compare
  const std::string table = tidy_csv(answers);
  EXPECT_THAT(
      table, HasSubstr("response_s,stimulus_checksum,gate,protocol_checksum,run_version,run_hand"));
  const std::vector<std::string> tidy = {folder.file("tidy.csv")};
  write_file(tidy[0], table);
  EXPECT_THAT(test::input_error([&] { read_answers(tidy, notes); }),
              HasSubstr("the checksum of method stm in scene x is 00000001 (participant 1)"));
  EXPECT_EQ(read_answers(tidy, notes, pool), answers);
}

TEST(Scores, RehearsalsAreNotPooledWithPeople) {
  const test::TemporaryFolder folder;
  const std::vector<std::string> files = {folder.file("1.jsonl"), folder.file("2.jsonl")};
  write_study(files[0], "1", "fast");
  write_study(files[1], "2", "fast", "study", true);
  std::vector<std::string> notes;
  EXPECT_THAT(test::input_error([&] { read_answers(files, notes); }),
              HasSubstr("rehearsal is false"));
}

}  // namespace
}  // namespace prostm
