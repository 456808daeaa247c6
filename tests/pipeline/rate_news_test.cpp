#include "prostm/pipeline/realtime/rate_news.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace prostm {
namespace {

/// Returns the messages of a run that makes these numbers of steps in each second.
std::vector<std::string> told(const std::vector<int>& steps_of_each_second, double step_time = 7e-3,
                              double plan_time = 4e-3) {
  RateNews news;
  std::vector<std::string> all;
  WorldFrame contact;
  PlanFrame plan;
  contact.world_time = step_time;
  plan.plan_time = plan_time;
  for (std::size_t second = 0; second < steps_of_each_second.size(); ++second) {
    for (int step = 0; step < steps_of_each_second[second]; ++step) {
      contact.due =
          static_cast<double>(second) + static_cast<double>(step) / steps_of_each_second[second];
      if (++contact.step % 2 != 0) continue;
      ++plan.id;
      if (const auto sentence = news.look(contact, plan, {})) all.push_back(*sentence);
    }
  }
  return all;
}

TEST(RateNews, IsEmptyWhileRatesAreMet) {
  EXPECT_TRUE(told(std::vector<int>(30, 50)).empty());
  // a short delay
  EXPECT_TRUE(told({50, 50, 50, 46, 50, 50, 50, 50, 50, 50, 50, 50}).empty());
}

TEST(RateNews, ReportsMissedRatesWithAdviceOnce) {
  using testing::ElementsAre;
  using testing::HasSubstr;
  EXPECT_THAT(told(std::vector<int>(30, 40), 24e-3),
              ElementsAre(testing::AllOf(HasSubstr("smoke 40.0 of 50 Hz, plans 20.0 of 25 Hz"),
                                         HasSubstr("Use --grid 48, which keeps"))));
  EXPECT_THAT(told(std::vector<int>(30, 40), 7e-3, 39e-3),
              ElementsAre(HasSubstr("Use --preset fast.")));
  EXPECT_THAT(told(std::vector<int>(30, 40)), ElementsAre(HasSubstr("Close other programs")));
}

// seconds in which the machine is slow, and seconds in which it is slower
TEST(RateNews, SuggestsOneOptionPerRun) {
  RateNews news;
  std::vector<std::string> all;
  WorldFrame contact;
  PlanFrame plan;
  PipelineSettings settings;
  const auto run_for = [&](double seconds, int rate, double step_time) {
    contact.world_time = step_time;
    const double begin = contact.due;
    while (contact.due < begin + seconds) {
      contact.due += 1.0 / rate;
      if (++contact.step % 2 != 0) continue;
      ++plan.id;
      if (const auto sentence = news.look(contact, plan, settings)) all.push_back(*sentence);
    }
  };
  for (const double step_time : {24e-3, 90e-3, 24e-3}) {
    run_for(12.0, 40, step_time);
    EXPECT_EQ(news.advice().cells, 48);
    run_for(12.0, 50, 9e-3);
    EXPECT_EQ(news.advice().kind, AdviceKind::None);
  }
  ASSERT_EQ(all.size(), 6U);
  for (const std::size_t i : {0U, 2U, 4U}) EXPECT_THAT(all[i], testing::HasSubstr("se --grid 48"));
  // the advice has been followed
  run_for(12.0, 40, 24e-3);
  settings.fluid.cells = 48;
  run_for(12.0, 40, 24e-3);
  EXPECT_THAT(all.back(), testing::HasSubstr("Use --grid 32"));
}

TEST(RateNews, ReportsThatRatesAreMetAgain) {
  std::vector<int> seconds(12, 40);
  seconds.insert(seconds.end(), 12, 50);
  const auto all = told(seconds);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[1], "The rates are held again.");
}

// AM plans at every step, PRO-STM at every second one
TEST(RateNews, AnotherMethodHasOtherRates) {
  RateNews news;
  PipelineSettings settings;
  WorldFrame contact;
  PlanFrame plan;
  for (int step = 1; step <= 2000; ++step) {
    settings.method = step <= 1000 ? Method::Am : Method::ProStm;
    contact.step = step;
    contact.due = 0.02 * step;
    if (step % settings.steps_per_plan() != 0) continue;
    ++plan.id;
    EXPECT_FALSE(news.look(contact, plan, settings)) << step;
  }
}

}  // namespace
}  // namespace prostm
