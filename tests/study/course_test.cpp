#include "prostm/study/task/course.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "study/study_support.hpp"

namespace prostm {
namespace {

const std::string kUpDown =
    "[trials]\ntask = \"judgement\"\n[level]\nsetting = \"plan.draw_rate\"\nlow = 10\nhigh = "
    "100\nstep = 0.1\nscale = \"log\"\nreversals = 8\ntracks = 2\n";
const std::string kTwoMethods = "[method.a]\n[method.b.plan]\nspeed = 5\n";

/// The answer of a person with a threshold of 40 Hz, or 60.
bool felt(const Trial& t) {
  return *t.level > (t.scene == 0 ? 40.0 : 60.0);
}

TEST(Course, AnIdentificationTaskFollowsTheOrder) {
  const Protocol p = test::study_protocol();
  Course course(p, 3);
  const auto order = trial_order(p, 3);
  EXPECT_EQ(course.most(), order.size());
  EXPECT_FALSE(course.is_open());
  for (const Trial& trial : order) {
    ASSERT_FALSE(course.is_done());
    EXPECT_EQ(course.trial(), trial);
    EXPECT_EQ(course.starts_method(), course.done() == 0);
    course.answer(course.done() % 3 == 0);
  }
  EXPECT_TRUE(course.is_done());
}

// The same answers lead to the same trials, which lets a session resume after a crash.
TEST(Course, TheSameAnswersLeadToTheSameTrials) {
  const Protocol p = test::study_protocol("methods = \"within\"\n" + kUpDown, kTwoMethods);
  std::vector<Trial> trials;
  for (Course course(p, 2); !course.is_done(); course.answer(felt(course.trial())))
    trials.push_back(course.trial());
  ASSERT_GT(trials.size(), 8U * 8U);
  for (std::size_t killed = 0; killed <= trials.size(); killed += 7) {
    Course again(p, 2);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      ASSERT_EQ(again.trial(), trials[i]);
      ASSERT_EQ(again.done(), i);
      again.answer(felt(trials[i]));
      if (again.done() != killed) continue;
      const Course copy = again;
      again = copy;
    }
    EXPECT_TRUE(again.is_done());
  }
  Course other(p, 3);
  EXPECT_NE(other.trial(), trials[0]) << "another participant has another order";
}

TEST(Course, AlternatesTracksAndRunsMethodsOneAfterTheOther) {
  const Protocol p = test::study_protocol("methods = \"within\"\n" + kUpDown, kTwoMethods);
  const auto methods = method_order(p, 1);
  std::map<int, int> count;  // trials of each track
  std::map<int, std::map<int, int>> first_of_round;
  std::vector<int> seen;
  Course course(p, 1);
  EXPECT_TRUE(course.is_open());
  EXPECT_EQ(course.most(), 8U * 60U);
  for (int before = -1; !course.is_done(); course.answer(felt(course.trial()))) {
    const Trial& t = course.trial();
    EXPECT_EQ(course.starts_method(), t.method != before);
    if (t.method != before) seen.push_back(t.method);
    before = t.method;
    EXPECT_EQ(t.level, std::clamp(*t.level, 10.0, 100.0));
    ++count[t.track];
    // no track is ahead of another one that still has trials left
    const int first = t.method == methods[0] ? 1 : 5;
    for (int track = first; track < first + 4; ++track)
      EXPECT_LE(count[t.track] - 1, count[track]) << "unless the other one is done";
    if (count[t.track] > 8) break;
  }
  EXPECT_EQ(seen.front(), methods[0]);
}

TEST(Course, FindsTheThreshold) {
  const Protocol p = test::study_protocol("methods = \"within\"\n" + kUpDown, kTwoMethods);
  Course course(p, 1);
  std::map<int, int> scene_of;
  std::set<int> methods;
  int changes = 0, before = -1;
  while (!course.is_done()) {
    const Trial t = course.trial();
    scene_of[t.track] = t.scene;
    methods.insert(t.method);
    changes += t.method != before ? 1 : 0;
    before = t.method;
    course.answer(felt(t));
  }
  EXPECT_EQ(methods.size(), 2U);
  EXPECT_EQ(changes, 2);
  ASSERT_EQ(scene_of.size(), 8U);
  for (const auto& [track, scene] : scene_of)
    EXPECT_NEAR(course.result(track), scene == 0 ? 40.0 : 60.0, scene == 0 ? 8.0 : 12.0) << track;
}

// The level's interval and the first track of a round are drawn with equal probabilities.
TEST(Course, DrawsIntervalsAndTracksFairly) {
  const Protocol p = test::study_protocol(
      "[trials]\ntask = \"forced-choice\"\n[level]\nsetting = \"plan.speed\"\nlow = 3\nhigh = "
      "8\nreference = 3\nprocedure = \"bayes\"\ntrials = 40\n",
      "[method.a]\n");
  int first = 0, all = 0, leads = 0, rounds = 0;
  for (int participant = 1; participant <= 60; ++participant) {
    Course course(p, participant);
    EXPECT_EQ(course.most(), 80U);
    EXPECT_FALSE(course.is_open());
    for (; !course.is_done(); course.answer(*course.trial().level > 5.0)) {
      const Trial& t = course.trial();
      first += t.level_first() ? 1 : 0;
      if (all++ % 2 == 0) leads += t.track == 1 ? 1 : 0, ++rounds;
    }
  }
  EXPECT_EQ(all, 60 * 80);
  EXPECT_NEAR(first, 0.5 * all, 4.0 * std::sqrt(0.25 * all));
  EXPECT_NEAR(leads, 0.5 * rounds, 4.0 * std::sqrt(0.25 * rounds));
}

TEST(Course, ACorrectedAnswerHasTheEffectOfTheRightOne) {
  const Protocol p = test::study_protocol(kUpDown, "[method.a]\n");
  Course slipped(p, 1), right(p, 1);
  while (!right.is_done()) {
    const bool answer = felt(right.trial());
    right.answer(answer);
    slipped.answer(!answer);
    if (!slipped.correct()) {
      EXPECT_TRUE(right.is_done() != slipped.is_done());
      break;
    }
    ASSERT_EQ(slipped.is_done(), right.is_done());
    if (!right.is_done()) {
      ASSERT_EQ(slipped.trial(), right.trial());
    }
  }
}

TEST(Course, AdjustmentsStartOnBothSidesAndEndAtTheAcceptedLevel) {
  const Protocol p = test::study_protocol(
      "[trials]\ntask = \"adjustment\"\nrepeats = 6\n[level]\nsetting = \"plan.speed\"\nlow = "
      "2\nhigh = 8\nreference = 7\nstep = 0.1\n",
      "[method.a]\n");
  Course course(p, 1);
  EXPECT_EQ(course.most(), 12U);
  std::map<int, int> below;
  while (!course.is_done()) {
    const Trial t = course.trial();
    below[t.track] += *t.level < 5.0 ? 1 : 0;
    course.tune(*t.level < 5.0 ? 2 : -2, false);
    EXPECT_NEAR(*course.trial().level, *t.level + (*t.level < 5.0 ? 0.2 : -0.2), 1e-4);
    course.tune(-100, true);
    EXPECT_EQ(*course.trial().level, 2.0);
    course.accept(7.0 + 0.1 * static_cast<double>(course.done() % 2));
  }
  EXPECT_EQ(below, (std::map<int, int>{{1, 3}, {2, 3}}));
  EXPECT_NEAR(course.result(1), 7.05, 0.06);
}

TEST(Course, IntegersStayIntegers) {
  const Protocol p = test::study_protocol(
      "[trials]\ntask = \"judgement\"\n[level]\nsetting = \"plan.paths\"\nlow = 1\nhigh = 4\n"
      "procedure = \"bayes\"\ntrials = 20\n",
      "[method.a]\n");
  std::set<double> levels;
  for (Course course(p, 1); !course.is_done(); course.answer(*course.trial().level > 2.0))
    levels.insert(*course.trial().level);
  for (const double level : levels) EXPECT_EQ(level, std::round(level));
  EXPECT_GE(levels.size(), 2U);
}

}  // namespace
}  // namespace prostm
