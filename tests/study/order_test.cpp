#include "prostm/study/protocol/order.hpp"

#include <boost/math/distributions/chi_squared.hpp>
#include <map>
#include <set>

#include "study/study_support.hpp"

namespace prostm {
namespace {

Protocol protocol_of(int methods, MethodsOf of, int seed = 3) {
  std::string tables;
  for (int i = 0; i < methods; ++i) tables += "[method.m" + std::to_string(i) + "]\n";
  Protocol p = test::study_protocol("", tables);
  p.study.methods = of;
  p.study.seed = seed;
  return p;
}

TEST(Order, AWilliamsSquareBalancesPositionAndPredecessor) {
  for (int n = 1; n <= 9; ++n) {
    const auto rows = williams_rows(n);
    ASSERT_EQ(rows.size(), static_cast<std::size_t>(n % 2 == 0 || n == 1 ? n : 2 * n));
    std::map<std::pair<int, int>, int> at_place, after;
    for (const auto& row : rows) {
      EXPECT_EQ(std::set<int>(row.begin(), row.end()).size(), static_cast<std::size_t>(n));
      for (int i = 0; i < n; ++i) {
        ++at_place[{i, row[static_cast<std::size_t>(i)]}];
        if (i > 0)
          ++after[{row[static_cast<std::size_t>(i - 1)], row[static_cast<std::size_t>(i)]}];
      }
    }
    const int times = static_cast<int>(rows.size()) / n;
    EXPECT_EQ(at_place.size(), static_cast<std::size_t>(n * n));
    for (const auto& [key, count] : at_place) EXPECT_EQ(count, times) << n;
    EXPECT_EQ(after.size(), static_cast<std::size_t>(n * (n - 1)));
    for (const auto& [key, count] : after) EXPECT_EQ(count, times) << n;
  }
}

TEST(Order, GivesEachMethodToEquallyManyInEveryBlock) {
  for (int methods = 1; methods <= 5; ++methods) {
    const Protocol p = protocol_of(methods, MethodsOf::Between);
    for (int block = 0; block < 20; ++block) {
      std::set<int> seen;
      for (int i = 1; i <= methods; ++i) {
        const auto order = method_order(p, block * methods + i);
        ASSERT_EQ(order.size(), 1U);
        seen.insert(order.front());
      }
      EXPECT_EQ(seen.size(), static_cast<std::size_t>(methods));
    }
  }
}

TEST(Order, WithinParticipantsEveryRowOfTheSquareIsUsedOncePerBlock) {
  for (int methods = 2; methods <= 5; ++methods) {
    const Protocol p = protocol_of(methods, MethodsOf::Within);
    const auto rows = williams_rows(methods);
    const std::set<std::vector<int>> all(rows.begin(), rows.end());
    for (int block = 0; block < 5; ++block) {
      std::set<std::vector<int>> seen;
      for (std::size_t i = 1; i <= rows.size(); ++i)
        seen.insert(method_order(p, block * static_cast<int>(rows.size()) + static_cast<int>(i)));
      EXPECT_EQ(seen, all);
    }
  }
}

TEST(Order, TrialsHaveEachSceneAsOftenAsRequestedWithEachMethodInTurn) {
  Protocol p = protocol_of(3, MethodsOf::Within);
  p.trials.repeats = 5;
  for (int participant = 1; participant <= 200; ++participant) {
    const auto trials = trial_order(p, participant);
    ASSERT_EQ(trials.size(), 30U);
    const auto methods = method_order(p, participant);
    for (std::size_t block = 0; block < 3; ++block) {
      std::map<int, int> scenes;
      for (std::size_t i = 0; i < 10; ++i) {
        const Trial& t = trials[10 * block + i];
        EXPECT_EQ(t.method, methods[block]);
        ++scenes[t.scene];
      }
      EXPECT_EQ(scenes[0], 5);
      EXPECT_EQ(scenes[1], 5);
    }
  }
}

TEST(Order, DependsOnTheSeed) {
  const Protocol p = protocol_of(2, MethodsOf::Between), q = protocol_of(2, MethodsOf::Between, 4);
  int same = 0;
  for (int participant = 1; participant <= 100; ++participant) {
    EXPECT_EQ(trial_order(p, participant), trial_order(p, participant));
    same += trial_order(p, participant) == trial_order(q, participant) ? 1 : 0;
  }
  EXPECT_LE(same, 1);
  // a file that was begun must have the same order in every later version
  const auto first = trial_order(p, 1);
  std::string text;
  for (const Trial& t : first) text += std::to_string(t.scene) + std::to_string(t.question) + " ";
  EXPECT_EQ(text, "00 10 00 11 11 01 01 10 10 01 01 11 10 10 01 00 ");
}

TEST(Order, DrawsBalancedQuestionsEquallyOften) {
  Protocol p = protocol_of(1, MethodsOf::Between);
  p.trials.questions = Questions::Balanced;
  p.trials.repeats = 5;
  int more[2] = {};
  for (int participant = 1; participant <= 400; ++participant) {
    int count[2][2] = {};
    for (const Trial& t : trial_order(p, participant)) ++count[t.scene][t.question];
    for (const auto& of_scene : count) {
      EXPECT_EQ(of_scene[0] + of_scene[1], 5);
      EXPECT_LE(std::abs(of_scene[0] - of_scene[1]), 1);
      ++more[of_scene[1] > of_scene[0] ? 1 : 0];
    }
  }
  EXPECT_NEAR(more[0], 400, 60);
}

/// χ² of counts that should be equal, as a probability.
double chance_of(const std::map<int, int>& counts, int kinds) {
  double total = 0.0, statistic = 0.0;
  for (const auto& [kind, count] : counts) total += count;
  const double expected = total / kinds;
  for (int kind = 0; kind < kinds; ++kind) {
    const auto found = counts.find(kind);
    const double count = found == counts.end() ? 0.0 : found->second;
    statistic += (count - expected) * (count - expected) / expected;
  }
  return boost::math::cdf(boost::math::complement(boost::math::chi_squared(kinds - 1), statistic));
}

TEST(Order, RandomTrialsAreUnbiased) {
  const Protocol p = protocol_of(2, MethodsOf::Between);
  std::map<int, int> at_place[16], questions, pairs;
  for (int participant = 1; participant <= 2000; ++participant) {
    const auto trials = trial_order(p, participant);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      ++at_place[i][trials[i].scene];
      ++questions[2 * trials[i].scene + trials[i].question];
    }
    ++pairs[4 * trials[0].scene + 2 * trials[1].scene + trials[2].scene];
  }
  for (const auto& counts : at_place) EXPECT_GT(chance_of(counts, 2), 1e-4);
  EXPECT_GT(chance_of(questions, 4), 1e-4);
  // the first three without replacement: 0.1 for three alike, 0.1333 for each other order
  EXPECT_NEAR(pairs[0] / 2000.0, 0.1, 0.03);
  EXPECT_NEAR(pairs[2] / 2000.0, 0.4 / 3.0, 0.03);
}

}  // namespace
}  // namespace prostm
