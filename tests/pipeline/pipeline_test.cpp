#include "prostm/pipeline/pipeline.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "pipeline/simulated.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/runner.hpp"

namespace prostm {
namespace {

#ifdef PROSTM_SANITIZED
constexpr double kSeconds = 2.0;
#else
constexpr double kSeconds = 8.0;
#endif

PipelineSettings small_settings(bool realtime, Method method = Method::ProStm) {
  PipelineSettings s;
  s.method = method;
  s.fluid.cells = 32;
  s.scripted_hand.period = 6.0;
  s.devices.of<SimulatedArraySettings>().realtime = realtime;
  s.devices.of<SimulatedArraySettings>().history = 10.0;
  return s;
}

std::unique_ptr<HandSource> scripted(const PipelineSettings& s) {
  return make_scripted_hand(s.scripted_hand, s.track);
}

/// A source that never has a hand.
class NoHand final : public HandSource {
 public:
  void sample(double time, HandFrame& out) override {
    out.time = time;
    out.hands.clear();
  }
};

/// Keeps every plan that it receives.
class Keeper final : public RunObserver {
 public:
  explicit Keeper(int stop_after = 1 << 30) : stop_after_(stop_after) {}
  bool on_plan(const WorldFrame& contact, const PlanFrame& plan) override {
    steps.push_back(contact.step);
    plans.push_back(plan.plan);
    return static_cast<int>(plans.size()) < stop_after_;
  }
  bool on_progress(double) override { return static_cast<int>(plans.size()) < stop_after_; }
  std::vector<std::int64_t> steps;
  std::vector<Plan> plans;

 private:
  int stop_after_;
};

void expect_same(const Plan& a, const Plan& b) {
  ASSERT_EQ(a.foci.size(), b.foci.size());
  for (std::size_t i = 0; i < a.foci.size(); ++i) {
    ASSERT_EQ(a.foci[i].position, b.foci[i].position);
    ASSERT_EQ(a.foci[i].pressure, b.foci[i].pressure);
  }
  ASSERT_EQ(a.paths.size(), b.paths.size());
  for (std::size_t i = 0; i < a.paths.size(); ++i) {
    ASSERT_EQ(a.paths[i].points.size(), b.paths[i].points.size());
    for (std::size_t k = 0; k < a.paths[i].points.size(); ++k) {
      ASSERT_EQ(a.paths[i].points[k], b.paths[i].points[k]);
      ASSERT_EQ(a.paths[i].pressure[k], b.paths[i].pressure[k]);
    }
  }
}

Keeper run_keeping(Method method, RunMode mode, RunSummary& summary,
                   std::vector<FocusSample>& played) {
  const PipelineSettings settings = small_settings(false, method);
  Pipeline pipeline(settings, scripted(settings));
  Keeper keeper;
  summary = run(pipeline, settings, {kSeconds, mode}, keeper);
  const std::int64_t n = pipeline.device().samples();
  played = test::simulated(pipeline).read_back(0, n);
  return keeper;
}

/// Tests for both methods.
class EachMethod : public testing::TestWithParam<Method> {};

INSTANTIATE_TEST_SUITE_P(Pipeline, EachMethod, testing::Values(Method::ProStm, Method::Am),
                         [](const auto& method) {
                           return std::string(method.param == Method::Am ? "am" : "pro_stm");
                         });

TEST_P(EachMethod, ThreadedRunEqualsSteppedRunBitForBit) {
  RunSummary stepped, threaded;
  std::vector<FocusSample> a, b;
  const Keeper first = run_keeping(GetParam(), RunMode::Stepped, stepped, a);
  const Keeper second = run_keeping(GetParam(), RunMode::AsFastAsPossible, threaded, b);
  const int steps_per_plan = small_settings(false, GetParam()).steps_per_plan();
  EXPECT_EQ(steps_per_plan, GetParam() == Method::Am ? 1 : 2);
  ASSERT_EQ(first.plans.size(), second.plans.size());
  EXPECT_EQ(first.steps, second.steps);
  for (std::size_t k = 0; k < first.steps.size(); ++k)
    EXPECT_EQ(first.steps[k], steps_per_plan * static_cast<std::int64_t>(k + 1));
  for (std::size_t k = 0; k < first.plans.size(); ++k) expect_same(first.plans[k], second.plans[k]);
  EXPECT_GT(stepped.plans, 10);
  EXPECT_EQ(stepped.device.blocks, threaded.device.blocks);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].p_D, b[i].p_D);
    ASSERT_EQ(a[i].intensity, b[i].intensity);
  }
}

TEST(Pipeline, TwoInOneProcessDoNotDisturbEachOther) {
  const PipelineSettings settings = small_settings(false);
  Pipeline alone(settings, scripted(settings)), first(settings, scripted(settings)),
      second(settings, scripted(settings));
  for (int i = 0; i < 120; ++i) {
    alone.step(0.02);
  }
  for (int i = 0; i < 120; ++i) {
    first.step(0.02);
    second.step(0.02);
  }
  expect_same(alone.plan().plan, first.plan().plan);
  expect_same(first.plan().plan, second.plan().plan);
}

TEST(Pipeline, WithoutAHandNothingIsPlayed) {
  const PipelineSettings settings = small_settings(false);
  Pipeline pipeline(settings, std::make_unique<NoHand>());
  for (int i = 0; i < 100; ++i) pipeline.step(0.02);
  EXPECT_EQ(pipeline.plan().status, PlanStatus::EmptyTarget);
  EXPECT_EQ(pipeline.device().stats().blocks, 2000);
  for (const FocusSample& s : test::simulated(pipeline).read_back(0, pipeline.device().samples()))
    EXPECT_EQ(s.intensity, 0.0F);
}

TEST_P(EachMethod, TheFociFollowTheSkinAndFadeWhenTheHandLeaves) {
  const PipelineSettings settings = small_settings(false, GetParam());
  Pipeline pipeline(settings, scripted(settings));
  bool sounded = false, left = false;
  double silent_since = 0.0;
  std::int64_t seen = 0;
  // a step plays plans from the hands of the three steps before it, and from a fourth while a focal
  // point moves to another path
  std::vector<Eigen::AlignedBox3d> recent;
  while (pipeline.time() < 7.0) {
    pipeline.step(0.02);
    const bool hand = !pipeline.contact().hands.hands.empty();
    if (hand) {
      const HandShape shape(pipeline.contact().hands.hands[0]);
      const Vec3 margin = Vec3::Constant(2.0 * pipeline.world_stage().world().grid().cell + 0.02);
      recent.emplace_back(shape.lower() - margin, shape.upper() + margin);
      if (recent.size() > 5) recent.erase(recent.begin());
    }
    const std::int64_t n = pipeline.device().samples();
    float loudest = 0.0F;
    for (const FocusSample& s : test::simulated(pipeline).read_back(seen, n - seen)) {
      loudest = std::max(loudest, s.intensity);
      if (s.intensity <= 0.01F || !hand) continue;
      EXPECT_TRUE(std::any_of(
          recent.begin(), recent.end(),
          [&](const Eigen::AlignedBox3d& box) { return box.contains(s.p_D.cast<double>()); }))
          << pipeline.time() << " s: " << s.p_D.transpose();
    }
    seen = n;
    sounded = sounded || loudest > 0.1F;
    silent_since = hand ? 0.0 : silent_since + 0.02;
    if (silent_since > 0.12) {  // one plan update, then a fade of at most 50 ms
      left = left || sounded;
      EXPECT_EQ(loudest, 0.0F);
    }
  }
  EXPECT_TRUE(sounded);
  EXPECT_TRUE(left);
}

TEST(Pipeline, StopsAtTheObserversRequest) {
  for (const RunMode mode : {RunMode::Stepped, RunMode::AsFastAsPossible}) {
    const PipelineSettings settings = small_settings(false);
    Pipeline pipeline(settings, scripted(settings));
    Keeper keeper(5);
    const RunSummary summary = run(pipeline, settings, {60.0, mode}, keeper);
    EXPECT_TRUE(summary.stopped);
    EXPECT_LT(summary.seconds, 20.0);
  }
}

TEST(Pipeline, RealTimeRunAccountsForEveryStep) {
  const PipelineSettings settings = small_settings(true);
  Pipeline pipeline(settings, scripted(settings));
  Keeper keeper;
  const RunSummary s = run(pipeline, settings, {1.0, RunMode::RealTime}, keeper);
  EXPECT_EQ(s.world_steps + s.skipped_world_steps, 50);
  EXPECT_EQ(s.plans + s.empty_updates + s.skipped_updates, s.world_steps / 2);
  EXPECT_GE(s.device.blocks + s.device.missed_blocks, 900);
  EXPECT_LE(s.device.queue_blocks, 10);
  EXPECT_FALSE(s.stopped);
}

TEST(Pipeline, UsesTheArraysWidthIfConfigured) {
  PipelineSettings settings = small_settings(false);
  EXPECT_TRUE(plan_settings(settings, settings.emission_rate()).widths.empty());
  settings.array_width = true;
  const FocusWidths widths = plan_settings(settings, settings.emission_rate()).widths;
  EXPECT_NEAR(widths.at(0.2, 0.0, 0.0), 4.3e-3, 0.1e-3);
  EXPECT_GT(widths.at(0.3, 0.0, 0.0), 1.3 * widths.at(0.2, 0.0, 0.0));

  // and the plans differ
  const auto first_plan = [](const PipelineSettings& s) {
    Pipeline pipeline(s, make_scripted_hand(s.scripted_hand, s.track));
    for (int step = 0; step < 400; ++step) {
      if (pipeline.step(1.0 / s.world_rate) && pipeline.plan().status == PlanStatus::Planned) break;
    }
    return pipeline.plan().plan;
  };
  const Plan narrow = first_plan(settings);
  settings.array_width = false;
  const Plan wide = first_plan(settings);
  ASSERT_FALSE(narrow.paths.empty());
  ASSERT_FALSE(wide.paths.empty());
  EXPECT_NE(narrow.paths[0].points, wide.paths[0].points);
}

TEST(Pipeline, RejectsBadSettings) {
  PipelineSettings s = small_settings(false);
  s.scene = "five-plumes";
  EXPECT_THROW(Pipeline(s, scripted(s)), std::invalid_argument);
  s = small_settings(false);
  s.X_DT.linear() *= 2.0;
  EXPECT_THROW(Pipeline(s, scripted(s)), std::invalid_argument);
  s = small_settings(false);
  s.world_rate = 0.0;
  EXPECT_THROW(Pipeline(s, scripted(s)), std::invalid_argument);
  s = small_settings(false);
  s.world_steps_per_plan = -1;
  EXPECT_THROW(Pipeline(s, scripted(s)), std::invalid_argument);
  s = small_settings(false, Method::Am);
  s.am.foci = 9;
  EXPECT_THROW(Pipeline(s, scripted(s)), std::invalid_argument);
  s = small_settings(false, Method::Am);
  s.emit.am_frequency = 500.0;
  EXPECT_THROW(Pipeline(s, scripted(s)), std::invalid_argument);
}

}  // namespace
}  // namespace prostm
