/// Answer tables as written by spreadsheets and experiment software.
#include <array>
#include <string>

#include "prostm/study/analysis/scores.hpp"
#include "prostm/study/session/spelling.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;

std::vector<Answer> read(const std::string& text, const std::string& columns = {}) {
  return answers_from_csv(text, "a.csv", columns);
}

std::string refusal(const std::string& text, const std::string& columns = {}) {
  return test::input_error([&] { read(text, columns); });
}

/// The same two answers, with any separator, line end and spelling.
std::string table(const std::string& separator, const std::string& end, const std::string& yes,
                  const std::string& no, const std::string& level) {
  std::string out;
  const auto row = [&](const std::array<std::string, 5>& cells) {
    for (const std::string& cell : cells) out += (&cell == &cells.front() ? "" : separator) + cell;
    out += end;
  };
  row({"participant", "method", "scene", "correct", "level"});
  row({"P\u00E4r", "am", "x", yes, level});
  row({"2", "pro-stm", "x", no, level});
  return out;
}

const std::string kPaer = "P\u00E4r";

void expect_answers(const std::vector<Answer>& answers, double level) {
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].participant, kPaer);
  EXPECT_TRUE(answers[0].correct);
  EXPECT_EQ(answers[0].level, level);
  EXPECT_EQ(answers[1].method, "pro-stm");
  EXPECT_FALSE(answers[1].correct);
}

TEST(AnswerTable, ReadsSeparatorsLineEndsAndSpellings) {
  const std::array<std::array<std::string, 2>, 8> words = {{{"1", "0"},
                                                            {"True", "False"},
                                                            {"YES", "no"},
                                                            {"correct", "Incorrect"},
                                                            {"right", "wrong"},
                                                            {"WAHR", "FALSCH"},
                                                            {"VRAI", "FAUX"},
                                                            {"1.0", "0.0"}}};
  for (const std::string separator : {",", ";", "\t", "|", ", ", " ; "}) {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
      for (const auto& [yes, no] : words)
        expect_answers(read(table(separator, end, yes, no, "0.25")), 0.25);
    }
  }
  expect_answers(read(table(";", "\n", "1", "0", "0,25")), 0.25);
  expect_answers(read(table("\t", "\n", "1", "0", "0,25")), 0.25);
  expect_answers(read(table(",", "\n", "1", "0", "\"2,5\"")), 2.5);
  expect_answers(read("sep=;\r\n" + table(";", "\r\n", "1", "0", "1,250")), 1.25);
  EXPECT_THAT(refusal(table("\t", "\n", "1", "0", "1,250")),
              HasSubstr("may be decimal or separate thousands"));
  EXPECT_THAT(refusal("participant;method;scene;correct;level\n1;am;x;1;0,5\n1;am;x;1;1.250\n"),
              HasSubstr("line 3: level is \"1.250\": it has another decimal mark"));
  EXPECT_THAT(refusal(table(",", "\n", "1", "0", "0,25")), HasSubstr("decimal commas need"));
}

std::string utf16(const std::string& latin, bool big_endian) {
  std::string out;
  for (std::size_t i = 0; i < latin.size(); ++i) {
    auto byte = static_cast<unsigned char>(latin[i]);
    if (byte == 0xC3) byte = static_cast<unsigned char>(0x40 + latin[++i]);  // lead byte in UTF-8
    out += big_endian ? '\0' : static_cast<char>(byte);
    out += big_endian ? static_cast<char>(byte) : '\0';
  }
  return out;
}

TEST(AnswerTable, ReadsEncodings) {
  const std::string text = table(";", "\r\n", "1", "0", "0,25");
  expect_answers(read("\xEF\xBB\xBF" + text), 0.25);
  expect_answers(read("\xFF\xFE" + utf16(text, false)), 0.25);
  expect_answers(read("\xFE\xFF" + utf16(text, true)), 0.25);
  expect_answers(read(utf16(text, false)), 0.25);
  expect_answers(read(utf16(text, true)), 0.25);
  const std::size_t umlaut = text.find("\xC3\xA4");
  const std::string windows = text.substr(0, umlaut) + '\xE4' + text.substr(umlaut + 2);
  std::vector<std::string> notes;
  expect_answers(answers_from_csv(windows, "a.csv", {}, &notes), 0.25);
  EXPECT_THAT(notes, Contains(HasSubstr("is not UTF-8 and is read as Windows-1252")));
  EXPECT_EQ(read("participant,method,scene,correct\n\x80,am,x,1\n").front().participant, "\u20AC");
  EXPECT_THAT(refusal("\xFF\xFE" + utf16(text, false) + "x"), HasSubstr("cut off"));
  EXPECT_THAT(refusal("PK\x03\x04..."), HasSubstr("save it as CSV"));
}

TEST(AnswerTable, MapsColumnsOfPsychoPy) {
  const std::string text =
      "condition,img,trials.thisN,key_resp.keys,key_resp.corr,key_resp.rt,participant,date,\n"
      ",,,,,,07,2024,\n"
      "am,x,0,left,1,0.51,07,2024,\n"
      "am,x,1,None,0,,07,2024,\n"
      "stm,x,2,right,0,0.62,07,2024,\n";
  const std::string columns =
      "method=condition,scene=img,correct=key_resp.corr,response=key_resp.keys,"
      "response_s=key_resp.rt";
  std::vector<std::string> notes;
  const auto answers = answers_from_csv(text, "a.csv", columns, &notes);
  ASSERT_EQ(answers.size(), 3U);
  EXPECT_EQ(answers[0].participant, "07");
  EXPECT_EQ(answers[0].response_s, 0.51);
  EXPECT_FALSE(answers[1].answered) << "no key was pressed; PsychoPy counts that as wrong";
  EXPECT_TRUE(answers[2].answered);
  EXPECT_THAT(notes, Contains(HasSubstr("1 of 4 rows have no method and scene")));
  EXPECT_THAT(refusal(text), AllOf(HasSubstr("no column \"method\""),
                                   HasSubstr("--columns method=condition,scene=COLUMN,"
                                             "correct=key_resp.corr")));
  EXPECT_THAT(refusal(text, "correct=key_rsp.corr"), HasSubstr("did you mean \"key_resp.corr\""));
  EXPECT_THAT(refusal(text, "corect=key_resp.corr"), HasSubstr("did you mean \"correct\""));
  EXPECT_THAT(refusal(text, "correct"), HasSubstr("give NAME=COLUMN"));
  EXPECT_EQ(read(text, "method:=am,scene=img,correct=key_resp.corr")[2].method, "am");
}

TEST(AnswerTable, ReadsRowsOfJsPsych) {
  const std::string text =
      "\"rt\",\"response\",\"trial_type\",\"Subject\",\"method\",\"scene\",\"correct\"\n"
      "\"900\",\"0\",\"html-button-response\",\"s1\",\"\",\"\",\"\"\n"
      "\"512\",\"f\",\"html-keyboard-response\",\"s1\",\"am\",\"x\",\"true\"\n"
      "\"null\",\"null\",\"html-keyboard-response\",\"s1\",\"am\",\"x\",\"false\"\n";
  const auto answers = read(text, "participant=subject");
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_TRUE(answers[0].answered);
  EXPECT_FALSE(answers[1].answered);
}

// write.table() of R writes row names without a header.
TEST(AnswerTable, ReadsRowNamesOfR) {
  const std::string text =
      "\"participant\" \"method\" \"scene\" \"correct\"\n\"1\" \"a\" \"am\" \"x\" TRUE\n"
      "\"17\" \"a\" \"am\" \"x\" NA\n";
  std::string tabs = text;
  std::replace(tabs.begin(), tabs.end(), ' ', '\t');
  const auto answers = read(tabs);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].participant, "a");
  EXPECT_TRUE(answers[0].correct);
  EXPECT_FALSE(answers[1].answered);
}

TEST(AnswerTable, HeadersMatchWithoutCaseAndBlanks) {
  EXPECT_EQ(read(" Participant , METHOD,Scene ,Correct\n1,am,x,1\n").size(), 1U);
  EXPECT_THAT(refusal("Correct,participant,method,scene,CORRECT\n1,1,am,x,1\n"),
              HasSubstr("appears twice"));
}

// Columns of other programs may have the same names and a different meaning.
TEST(AnswerTable, IgnoresQuestionsOfOtherPrograms) {
  std::vector<std::string> notes;
  const auto answers = answers_from_csv(
      "participant,method,scene,correct,question,answer\n1,am,x,1,Was it strong?,f\n", "a.csv", {},
      &notes);
  EXPECT_TRUE(answers.front().question.empty());
  EXPECT_THAT(notes, Contains(HasSubstr("names no scene")));
}

TEST(AnswerTable, AcceptsRepeatedTrialNumbersAndFindsCopies) {
  const std::string header = "participant,method,scene,correct,trial,rt\n";
  std::vector<std::string> notes;
  EXPECT_EQ(
      answers_from_csv(header + "1,am,x,1,1,0.5\n1,am,x,1,1,0.6\n", "a.csv", {}, &notes).size(),
      2U);
  EXPECT_THAT(notes, Contains(HasSubstr("trial numbers repeat")));
  EXPECT_THAT(refusal(header + "1,am,x,1,1,0.5\n1,am,x,1,1,0.5\n"), HasSubstr("trial 1 twice"));
}

using Cells = std::vector<std::pair<std::string, std::string>>;

// A tidy table has all that a person's table has, and is read as the same answers.
TEST(AnswerTable, KeepsOtherColumns) {
  const std::string text =
      "Age,participant,method,,scene,note,correct,note,Correct Answer\n"
      "31,1,am,a,x,\" b, \"\"c\"\"\",true,;|,f\n"
      ",2,am,,x,,no,d,\n";
  const auto answers = read(text);
  ASSERT_EQ(answers.size(), 2U);
  EXPECT_EQ(answers[0].other, (Cells{{"Age", "31"},
                                     {"column_4", "a"},
                                     {"note", " b, \"c\""},
                                     {"note_2", ";|"},
                                     {"Correct Answer", "f"}}));
  EXPECT_EQ(answers[1].other.back().second, "");
  const std::string tidy = tidy_csv(answers);
  EXPECT_EQ(tidy.substr(0, tidy.find("\r\n")),
            "participant,method,scene,correct,Age,column_4,note,note_2,Correct Answer");
  EXPECT_EQ(read(tidy), answers);
  // empty cells at line ends, without a name, are no column
  EXPECT_TRUE(read("participant,method,scene,correct,\n1,am,x,1,\n").front().other.empty());
}

// A column with one of our names that is not read, or not wholly, gets "_given".
TEST(AnswerTable, OtherColumnsDoNotTakeOurNames) {
  const auto other_of = [](const std::string& text, const std::string& columns = {}) {
    const auto answers = read(text, columns);
    EXPECT_EQ(read(tidy_csv(answers)), answers) << text;
    return answers.front().other;
  };
  const std::string header = "participant,method,scene,correct";
  EXPECT_EQ(other_of(header + ",key.corr\n1,am,x,maybe,1\n", "correct=key.corr"),
            (Cells{{"correct_given", "maybe"}}));
  EXPECT_EQ(other_of(header + ",question,Answer\n1,am,x,1,Strong?,f\n"),
            (Cells{{"question_given", "Strong?"}, {"Answer_given", "f"}}));
  EXPECT_EQ(other_of(header + ",response,response_given\n1,am,x,1,left,z\n1,am,x,0,None,\n"),
            (Cells{{"response_given_2", "left"}, {"response_given", "z"}}));
  EXPECT_EQ(other_of(header + ",trial,response_s\n1,am,x,1,1,0.5\n1,am,x,1,1,0.6 s\n"),
            (Cells{{"trial_given", "1"}, {"response_s_given", "0.5"}}));
  EXPECT_EQ(other_of(header + ",kind,level\n1,am,x,0,adjusted,1.5\n"),
            (Cells{{"correct_given", "0"}}));
  EXPECT_TRUE(other_of(header + ",response,trial,response_s\n1,am,x,1,,1,0.5\n").empty());
}

TEST(AnswerTable, TablesWithDifferentColumnsAreJoined) {
  std::vector<Answer> answers = read("participant,method,scene,correct,age,hand\n1,am,x,1,31,l\n");
  for (const Answer& a : read("hand,participant,method,scene,correct,age\nr,2,am,x,1,\n"))
    answers.push_back(a);
  answers.push_back({.participant = "3", .method = "am", .scene = "x", .correct = true});
  EXPECT_EQ(tidy_csv(answers),
            "participant,method,scene,correct,age,hand\r\n1,am,x,1,31,l\r\n"
            "2,am,x,1,,r\r\n3,am,x,1,,\r\n");
}

TEST(Spelling, KeysAreEqualForNamesThatDifferOnlyInSpelling) {
  using study::spelling_key;
  const std::array<std::array<const char*, 2>, 14> alike = {{{"01", "1"},
                                                             {"P007", "p7"},
                                                             {"1.0", "1"},
                                                             {"1,00", "01"},
                                                             {" a ", "a"},
                                                             {"a\u00A0b", "a b"},
                                                             {"a\u200B", "a"},
                                                             {"pro_stm", "Pro-STM"},
                                                             {"a  b", "a b"},
                                                             {"\u00C4rger", "a\u0308rger"},
                                                             {"\uFF21\uFF11", "a1"},
                                                             {"\u0416", "\u0436"},
                                                             {"\u0160", "\u0161"},
                                                             {"000", "0"}}};
  for (const auto& [a, b] : alike) EXPECT_EQ(spelling_key(a), spelling_key(b)) << a << ", " << b;
  const std::array<std::array<const char*, 2>, 8> others = {{{"1", "10"},
                                                             {"0.5", "0.05"},
                                                             {"1.1", "1.10"},
                                                             {"1-1", "11"},
                                                             {"-1", "1"},
                                                             {"e", "\u00E9"},
                                                             {"P1", "Q1"},
                                                             {"1.5", "15"}}};
  for (const auto& [a, b] : others) EXPECT_NE(spelling_key(a), spelling_key(b)) << a << ", " << b;
}

}  // namespace
}  // namespace prostm
