#include "prostm/study/analysis/analysis.hpp"

#include <array>
#include <cmath>

#include "prostm/core/random.hpp"
#include "support/input_errors.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using testing::HasSubstr;
using testing::Not;

/// Adds `all` answers of one participant, of which the first `right` are right.
void add(std::vector<Answer>& out, const std::string& who, const std::string& method,
         const std::string& scene, int right, int all) {
  for (int i = 0; i < all; ++i)
    out.push_back({.participant = who, .method = method, .scene = scene, .correct = i < right});
}

TEST(Analysis, MatchesThePapersScores) {
  PROSTM_NEEDS_SHARED("data/paper/fig4.json");
  const test::WithoutTraps in_boost;
  std::vector<std::string> notes;
  const std::vector<std::string> files = {test::shared_file("data/paper/fig4.json")};
  const Analysis analysis = analyse(read_answers(files, notes));
  ASSERT_EQ(analysis.scenes.size(), 3U);
  EXPECT_EQ(analysis.groups, Groups::Between);
  EXPECT_EQ(analysis.participants.size(), 16U);
  const std::array<std::array<double, 2>, 3> z = {{{2.553, .0107}, {2.084, .037}, {1.526, .127}}};
  for (std::size_t i = 0; i < z.size(); ++i) {
    const Comparison& of = analysis.scenes[i].comparisons.front();
    EXPECT_NEAR(of.pooled_z.statistic, z[i][0], 5e-4);
    EXPECT_NEAR(of.pooled_z.p, z[i][1], 5e-4);
  }
  EXPECT_NEAR(analysis.scenes[0].comparisons[0].permutation->p, 0.171, 5e-4);
  EXPECT_NEAR(analysis.scenes[0].comparisons[0].effect->value, 0.76, 0.005);
  const std::string words = in_words(analysis);
  EXPECT_THAT(words,
              HasSubstr("Over participants, the test that generalises to other people, it is not "
                        "significant (permutation p = 0.171"));
  EXPECT_THAT(words, HasSubstr("In four-plumes alone (62.5 % with am, 75.0 % with pro-stm) the "
                               "difference is not significant over answers"));
  EXPECT_THAT(
      words,
      HasSubstr("They are not independent: participants differ 4.7 times as much with pro-stm"));
  EXPECT_THAT(words, HasSubstr("pro-stm minus am is 14.8 percentage points"));
}

TEST(Analysis, WithinParticipantsScoresArePaired) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers;
  Random random(2);
  for (int person = 0; person < 10; ++person) {
    const std::string who = std::to_string(person);
    const int easy = random.below(5);  // people differ more than methods do
    add(answers, who, "am", "x", 2 + 2 * easy, 16);
    add(answers, who, "pro-stm", "x", 3 + 2 * easy + random.below(2), 16);
  }
  const Analysis analysis = analyse(answers);
  EXPECT_EQ(analysis.groups, Groups::Within);
  ASSERT_EQ(analysis.scenes.size(), 1U);
  const Comparison& of = analysis.scenes[0].comparisons.at(0);
  EXPECT_EQ(of.permutation->splits, 1024);
  EXPECT_NEAR(of.permutation->p, 2.0 / 1024.0, 1e-12);  // all ten did better
  EXPECT_GT(of.pooled_z.p, 0.01);
  EXPECT_THAT(in_words(analysis), HasSubstr("it is significant (permutation p = 0.002; paired t"));
  EXPECT_THAT(in_words(analysis), Not(HasSubstr("show neither")));
}

TEST(Analysis, OneMethodIsComparedWithGuessing) {
  std::vector<Answer> answers;
  add(answers, "a", "pro-stm", "x", 15, 16);
  add(answers, "b", "pro-stm", "x", 13, 16);
  const Analysis analysis = analyse(answers);
  EXPECT_TRUE(analysis.scenes[0].comparisons.empty());
  EXPECT_THAT(in_words(analysis),
              HasSubstr("28 of 32 answers were right (87.5 %), which is above"));
  AnalysisSettings third;
  third.chance = 0.85;
  EXPECT_THAT(in_words(analyse(answers, third)), HasSubstr("compatible with guessing (85 %"));
}

TEST(Analysis, SensitivityComesFromQuestions) {
  std::vector<Answer> answers;
  for (const char* who : {"a", "b"}) {
    for (int i = 0; i < 16; ++i) {
      const bool is_asked = i % 2 == 0, says_yes = is_asked ? i < 14 : i < 6;
      answers.push_back({.participant = who,
                         .method = "am",
                         .scene = "x",
                         .correct = is_asked == says_yes,
                         .question = is_asked ? "x" : "y",
                         .yes = says_yes});
    }
  }
  const auto found = analyse(answers).scenes[0].methods[0].sensitivity;
  const Sensitivity expected = sensitivity({14, 16}, {6, 16});
  ASSERT_TRUE(found);
  EXPECT_DOUBLE_EQ(found->d_prime, expected.d_prime);
  EXPECT_DOUBLE_EQ(found->bias, expected.bias);
}

// A pilot on oneself: results about one person are kept, those about people are left out.
TEST(Analysis, OfOneParticipantIsAboutThatPersonOnly) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers;
  for (const char* scene : {"x", "y"}) {
    add(answers, "1", "am", scene, 18, 30);
    add(answers, "1", "pro-stm", scene, 27, 30);
  }
  const Analysis analysis = analyse(answers);
  const Comparison& of = analysis.scenes[0].comparisons.at(0);
  EXPECT_NEAR(of.pooled_z.statistic, 18.0 / std::sqrt(60 * 60 * 0.75 * 0.25 * 2 / 60), 1e-9);
  EXPECT_FALSE(of.permutation || of.t || of.effect || of.difference || of.holm_p);
  EXPECT_FALSE(analysis.scenes[0].methods[0].dispersion);
  const std::string words = in_words(analysis);
  EXPECT_THAT(words, HasSubstr("All answers are of one participant"));
  EXPECT_THAT(words, HasSubstr("With am 36 of 60 answers were right"));
  EXPECT_THAT(words, HasSubstr("In x alone"));
  EXPECT_THAT(words, Not(HasSubstr("Over participants")));
  EXPECT_THAT(words, Not(HasSubstr("Bayes factor")));
}

TEST(Analysis, OneParticipantPerMethodCannotSeparateMethodsFromPeople) {
  std::vector<Answer> answers;
  add(answers, "1", "am", "x", 18, 30);
  add(answers, "2", "pro-stm", "x", 27, 30);
  const Analysis analysis = analyse(answers);
  EXPECT_FALSE(analysis.scenes[0].comparisons.at(0).permutation);
  EXPECT_THAT(in_words(analysis), HasSubstr("methods and between people cannot be separated"));
}

TEST(Analysis, TrialsWithoutAnAnswerAreCountedAndLeftOut) {
  const test::WithoutTraps in_boost;
  std::vector<Answer> answers;
  for (const char* who : {"a", "b", "c"}) {
    add(answers, who, "am", "x", 6, 8);
    add(answers, who, "pro-stm", "x", 7, 8);
  }
  const Analysis whole = analyse(answers);
  EXPECT_TRUE(whole.missing.empty());
  for (const char* who : {"a", "b"}) {
    answers.push_back({.participant = who, .method = "am", .scene = "x", .answered = false});
    answers.push_back({.participant = who, .method = "am", .scene = "x", .answered = false});
  }
  const Analysis analysis = analyse(answers);
  ASSERT_EQ(analysis.missing.size(), 2U);
  EXPECT_EQ(analysis.missing[0].method, "am");
  EXPECT_EQ(analysis.missing[0].missing, 4);
  EXPECT_EQ(analysis.missing[0].trials, 28);
  EXPECT_EQ(analysis.missing[0].participants, 2);
  EXPECT_DOUBLE_EQ(analysis.missing[0].if_answered.low, 18.0 / 28.0);
  EXPECT_DOUBLE_EQ(analysis.missing[0].if_answered.high, 22.0 / 28.0);
  EXPECT_EQ(analysis.missing[1].missing, 0);
  EXPECT_EQ(analysis.scenes[0].methods[0].correct.trials, 24);
  EXPECT_THAT(in_words(analysis),
              HasSubstr("with am in x 4 of 28 trials (14.3 %, of 2 participants"));
  // participants without an answer in a scene are left out, and named
  answers.push_back({.participant = "d", .method = "am", .scene = "x", .answered = false});
  answers.push_back({.participant = "d", .method = "pro-stm", .scene = "x", .correct = true});
  const Analysis without = analyse(answers);
  EXPECT_EQ(without.left_out, std::vector<std::string>{"d"});
  EXPECT_EQ(without.participants.size(), 3U);
  EXPECT_THAT(in_words(without),
              HasSubstr("Participants left out because they answered no trial of some scene: d"));
}

TEST(Analysis, RejectsScoresThatCannotBeCompared) {
  const test::WithoutTraps in_boost;
  const auto refusal = [](const std::vector<Answer>& answers) {
    return test::input_error([&] { analyse(answers); });
  };
  std::vector<Answer> answers;
  EXPECT_THAT(refusal(answers), HasSubstr("no answer"));
  add(answers, "a", "am", "x", 3, 4);
  add(answers, "b", "am", "x", 3, 4);
  add(answers, "b", "am", "y", 3, 4);
  EXPECT_THAT(refusal(answers), HasSubstr("\"a\" has answers with method \"am\", but none"));
  add(answers, "a", "am", "y", 3, 4);
  EXPECT_NO_THROW(analyse(answers));
  add(answers, "b", "pro-stm", "x", 3, 4);
  EXPECT_THAT(refusal(answers), HasSubstr("each must have all of them, or each only one"));
  AnalysisSettings settings;
  settings.level = 2.0;
  EXPECT_THROW(analyse(answers, settings), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
