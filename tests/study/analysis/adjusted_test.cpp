#include "prostm/study/analysis/adjusted.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace prostm {
namespace {

using testing::HasSubstr;

Answer adjusted(const char* participant, double level, const char* method = "stm") {
  Answer a{participant, method, "x"};
  a.level = level;
  a.kind = AnswerKind::Adjusted;
  return a;
}

// Mean 2, standard deviation 1 of three people; Student's t for two degrees of freedom is 4.3027.
TEST(Adjusted, EachParticipantCountsOnce) {
  const Answer answers[] = {adjusted("b", 2.0),         adjusted("a", 0.5), adjusted("a", 1.5),
                            adjusted("c", 3.0),         adjusted("c", 3.0), adjusted("a", 1.0),
                            adjusted("a", 5.0, "other")};
  const auto results = adjusted_levels(answers, 0.95);
  ASSERT_EQ(results.size(), 2U);
  const AdjustedResult& of = results[0];
  ASSERT_EQ(of.participants.size(), 3U);
  EXPECT_EQ(of.participants[0].participant, "a");
  EXPECT_EQ(of.participants[0].adjustments, 3);
  EXPECT_DOUBLE_EQ(of.participants[0].mean, 1.0);
  EXPECT_DOUBLE_EQ(*of.participants[0].deviation, 0.5);
  EXPECT_FALSE(of.participants[1].deviation);
  EXPECT_DOUBLE_EQ(of.mean, 2.0);
  EXPECT_DOUBLE_EQ(*of.deviation, 1.0);
  EXPECT_NEAR(of.interval->low, 2.0 - 4.302653 / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(of.interval->high, 2.0 + 4.302653 / std::sqrt(3.0), 1e-6);
  EXPECT_EQ(results[1].method, "other");
  EXPECT_FALSE(results[1].interval);
  const std::string words = in_words(results, 0.95);
  EXPECT_THAT(words, HasSubstr("With stm in x, it felt alike at 2, the mean of 3 participants"));
  EXPECT_THAT(words, HasSubstr("says nothing about other people"));
}

}  // namespace
}  // namespace prostm
