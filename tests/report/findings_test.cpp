#include "prostm/report/findings.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "prostm/report/verdict.hpp"

namespace prostm::report {
namespace {

using enum Agreement;

bool has(const std::string& text, const std::string& piece) {
  return text.find(piece) != text.npos;
}

TEST(Verdict, ANumberWithinTheIntervalAgrees) {
  const Verdict verdict = compare("It is", 6.5, {5.0, 8.0}, {1, " m/s"});
  EXPECT_EQ(verdict.agreement, Agrees);
  EXPECT_EQ(verdict.text, "It is 6.5 m/s; published: 5.0 to 8.0 m/s.");
}

TEST(Verdict, ANumberOutsideDiffersByItsDistance) {
  const Verdict high = compare("It is", 9.0, {5.0, 8.0}, {1, " m/s"});
  EXPECT_EQ(high.agreement, Differs);
  EXPECT_EQ(high.text, "It is 9.0 m/s; published: 5.0 to 8.0 m/s, so it is 1.0 m/s too high.");
  const Verdict low = compare("It is", 2.25, {5.0, 8.0}, {2, " m/s"});
  EXPECT_EQ(low.agreement, Differs);
  EXPECT_TRUE(has(low.text, "2.75 m/s too low."));
}

TEST(Verdict, IsJudgedAsTheNumbersAreShown) {
  EXPECT_EQ(compare("It is", 8.04, {5.0, 8.0}, {1, ""}).agreement, Agrees);
  EXPECT_EQ(compare("It is", 8.06, {5.0, 8.0}, {1, ""}).agreement, Differs);
}

TEST(Verdict, HasOneSidedIntervalsAndSingleValues) {
  const Published above{1.0}, below{.high = 10.0}, exact{61.0, 61.0};
  EXPECT_TRUE(has(compare("It is", 2.0, above, {1, ""}).text, "published: above 1.0."));
  EXPECT_EQ(compare("It is", 0.5, above, {1, ""}).agreement, Differs);
  EXPECT_TRUE(has(compare("It is", 2.0, below, {1, " mm"}).text, "published: below 10.0 mm."));
  EXPECT_EQ(compare("It is", 11.0, below, {1, " mm"}).agreement, Differs);
  EXPECT_TRUE(has(compare("It is", 60.9, exact, {0, " %"}).text, "It is 61 %; published: 61 %."));
}

TEST(Verdict, TheLeastConvenientComesFirst) {
  nlohmann::ordered_json blocks = nlohmann::ordered_json::array();
  add_verdicts(blocks, {{Agrees, "a"}, {NotComparable, "b"}, {Differs, "c"}});
  EXPECT_EQ(blocks[0]["verdict"]["text"], "c");
  EXPECT_EQ(blocks[1]["verdict"]["agreement"], "not comparable");
  EXPECT_EQ(blocks[2]["verdict"]["text"], "a");
}

TEST(Findings, TheReversalFollowsFromTheScores) {
  const Finding reverse = reversal({86.5, 74.6}, {61.0, 76.0});
  EXPECT_EQ(reverse.agreement, Differs);
  EXPECT_EQ(reverse.text,
            "Models of the skin do the paper's study better with AM (86.5 %) than with PRO-STM "
            "(74.6 %). People did it better with PRO-STM (76.0 %) than with AM (61.0 %): the "
            "reverse.");
  const Finding same = reversal({70.0, 74.6}, {61.0, 76.0});
  EXPECT_EQ(same.agreement, Agrees);
  EXPECT_TRUE(has(same.text, "the same order"));
}

TEST(Findings, SquaresAgreeIfMostSkinsDo) {
  EXPECT_EQ(squares(0, 9).agreement, Differs);
  EXPECT_TRUE(has(squares(0, 9).text, "nowhere, on 0 of 9 skins"));
  EXPECT_EQ(squares(4, 9).agreement, Differs);
  EXPECT_EQ(squares(5, 9).agreement, Agrees);
}

TEST(Findings, CirclesAreJudgedByTheOneThatFitsWorst) {
  EXPECT_EQ(circles({6.0, 7.0}, {5.0, 8.0}).agreement, Agrees);
  EXPECT_TRUE(has(circles({6.0, 12.8, 9.0}, {5.0, 8.0}).text,
                  "at 12.8 m/s; published: 5.0 to 8.0 "
                  "m/s, so it is 4.8 m/s too high."));
  EXPECT_TRUE(has(circles({4.0, 8.5}, {5.0, 8.0}).text, "1.0 m/s too low."));
}

TEST(Findings, QualityIsJudgedByItsNumbers) {
  const Quality strong{0.3, 0.1, 8.0}, weak{0.9, 0.85, -5.0};
  EXPECT_EQ(one_circle("s", strong, weak).agreement, Differs);
  EXPECT_TRUE(has(one_circle("s", strong, weak).text, "13.0 dB stronger"));
  EXPECT_EQ(one_circle("s", weak, strong).agreement, Agrees);
  EXPECT_TRUE(has(one_circle("s", weak, strong).text, "13.0 dB weaker"));

  EXPECT_TRUE(has(felt_strength("s", -17.0, "about 5 dB below").text, "(s): about 5 dB below."));
  EXPECT_EQ(felt_strength("s", -17.0, "").agreement, Differs);
  EXPECT_EQ(felt_strength("s", 1.0, "").agreement, Agrees);

  EXPECT_EQ(promised_shape("s", weak).agreement, Differs);
  EXPECT_EQ(promised_shape("s", {0.8, 0.85, 0.0}).agreement, Agrees);

  EXPECT_EQ(felt_shapes("s", {0, 0.91, 0}, {0, 0.83, 0}, {0, 0.82, 0}).agreement, Agrees);
  EXPECT_EQ(felt_shapes("s", {0, 0.81, 0}, {0, 0.80, 0}, {0, 0.82, 0}).agreement, Differs);

  EXPECT_EQ(shapes_by_eq1("s", 0.97, 0.6).agreement, Agrees);
  EXPECT_EQ(shapes_by_eq1("s", 0.5, 0.6).agreement, Differs);
}

TEST(Findings, SkippedWorkComesWithTheLatency) {
  EXPECT_EQ(latency({21.0, 40.0, 150, 0, 0}).agreement, Agrees);
  const Finding late = latency({21.0, 40.0, 132, 18, 0});
  EXPECT_EQ(late.agreement, Differs);
  EXPECT_TRUE(has(late.text, "18 of 150 steps"));
  EXPECT_EQ(latency({21.0, 40.0, 150, 0, 1}).agreement, Differs);
  EXPECT_TRUE(has(plan_times("s", 8.7, 14.6).text, "8.7 ms"));
  EXPECT_EQ(plan_times("s", 8.7, 14.6).agreement, NotComparable);
}

TEST(Findings, TheReversalIsFirstThenTheInconvenientOnes) {
  const std::vector<Part> parts = {{"models", {{"title", "Models"}}},
                                   {"skin", {{"title", "Skin"}}}};
  const Part part = findings_part({{"skin", Agrees, "a"},
                                   {"models", Agrees, "r"},
                                   {"skin", NotComparable, "n"},
                                   {"skin", Differs, "d"}},
                                  {"note"}, parts);
  const auto& blocks = part.document["timing"];
  std::string order;
  for (std::size_t i = 0; i < 4; ++i) order += blocks[i]["finding"]["text"].get<std::string>();
  EXPECT_EQ(order, "rdna");
  EXPECT_EQ(blocks[0]["finding"]["link"], "Models");
  EXPECT_EQ(blocks[4]["text"], "note");
  EXPECT_THROW(findings_part({{"none", Agrees, "a"}}, {}, parts), std::invalid_argument);
}

}  // namespace
}  // namespace prostm::report
