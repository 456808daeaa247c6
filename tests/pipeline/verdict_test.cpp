/// The verdicts on runs of every kind, from synthetic summaries.

#include "prostm/pipeline/realtime/verdict.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

namespace prostm {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

/// A minute in which nothing went wrong.
RunSummary good() {
  RunSummary s;
  s.seconds = s.took = 60.0;
  s.world_steps = 3000;
  s.plans = 1200;
  s.empty_updates = 300;
  s.played_by.sample_rate = 40e3;
  s.played_by.block_samples = 40;
  s.device.blocks = 60'000;
  s.emit.samples = 9'600'000;
  s.contact_stats.joints = 39'000;
  s.contact_stats.skin_cells = 200'000;
  s.full_scale_pressure = 0.224;
  s.track.p50 = 1e-4;
  s.hand.p50 = 1e-3;
  s.world.p50 = s.world.max = 9e-3;
  s.contact.p50 = 1e-3;
  s.plan.p50 = 2e-3;
  return s;
}
Verdict judged(const std::function<void(RunSummary&)>& change,
               const std::optional<TrackerStatus>& tracker = {}) {
  RunSummary s = good();
  change(s);
  return verdict_of(s, {}, tracker);
}
std::vector<std::string> said(const std::function<void(RunSummary&)>& change) {
  return judged(change).sentences;
}

TEST(Verdict, AGoodRunTakesTwoSentences) {
  const Verdict verdict = judged([](RunSummary&) {});
  EXPECT_EQ(verdict.held, true);
  EXPECT_THAT(verdict.sentences,
              ElementsAre("The rates were held: smoke 50.0 of 50 Hz, plans 25.0 of 25 Hz, 40 "
                          "samples a millisecond.",
                          "Nothing was unusual."));
}

TEST(Verdict, SamplesAreThoseOfTheDeviceThatPlayed) {
  EXPECT_THAT(said([](RunSummary& s) { s.played_by.sample_rate = 20e3 / 3.0; }).front(),
              HasSubstr(", 6.667 samples a millisecond"));
}

TEST(Verdict, GapsAreExplainedByTheirMeasuredCauses) {
  const auto of = [](std::int64_t lost, std::int64_t slow, std::int64_t late) {
    return said([&](RunSummary& s) {
             s.played_by.block_samples = 800;
             s.device = {.blocks = 3000,
                         .missed_blocks = lost + slow + late,
                         .lost_links = lost > 0 ? 2 : 0,
                         .lost_blocks = lost,
                         .slow_blocks = slow};
           })
        .front();
  };
  EXPECT_THAT(of(140, 0, 0),
              AllOf(HasSubstr("was silent for 2800 ms in all, which is felt as gaps: its "
                              "link was lost twice (2.8 s without a link)."),
                    Not(HasSubstr("ulimit"))));
  EXPECT_THAT(of(0, 30, 0), AllOf(HasSubstr("its link was too slow for 30 of 3000 blocks"),
                                  Not(HasSubstr("woke"))));
  EXPECT_THAT(of(0, 0, 30),
              AllOf(HasSubstr("its thread woke too late for 30 of 3000 blocks (allow it "
                              "real-time priority, ulimit -r 10"),
                    Not(HasSubstr("link"))));
  // the most frequent first
  EXPECT_THAT(of(10, 40, 20), testing::MatchesRegex(".*too slow for 40.*woke too late for 20.*lost "
                                                    "twice.*"));
}

/// A minute of the study hand.
RunSummary held(std::int64_t passed) {
  RunSummary s = good();
  s.judged_updates = 1500;
  s.held_updates = 1375;
  s.held_passed_updates = passed;
  s.held_problem = GateProblem::Saddle;
  return s;
}

TEST(Verdict, StartsWithAHeldHandThatMissedTheStimulus) {
  PipelineSettings settings;
  settings.scene = "four-plumes";
  settings.fluid.cells = 48;
  const Verdict verdict = verdict_of(held(28), settings);
  EXPECT_THAT(
      verdict.sentences,
      ElementsAre("The held hand did not get the stimulus of four-plumes: 2 % of its updates "
                  "passed the gate (at least 80 %), mostly for maxima that merge. "
                  "--grid 48 is too coarse for this scene: use --grid 56.",
                  StartsWith("The rates were held")));
  settings.fluid.cells = 64;
  EXPECT_THAT(verdict_of(held(28), settings).sentences.front(),
              AllOf(StartsWith("The held hand did not get"), Not(HasSubstr("--grid"))));
  EXPECT_THAT(verdict_of(held(1099), settings).sentences.front(),
              HasSubstr("79.9 % of its updates passed the gate (at least 80.0 %)"));
  EXPECT_THAT(verdict_of(held(1374), settings).sentences.front(),
              StartsWith("The rates were held"));
}

TEST(Verdict, AHandThatWasHardlyHeldIsNotEvaluated) {
  RunSummary s = held(0);
  s.held_updates = 10;
  EXPECT_THAT(verdict_of(s, {}).sentences.front(), StartsWith("The rates were held"));
}

// advice given during the run is kept
TEST(Verdict, RepeatsTheAdviceOfTheRun) {
  RunSummary s = good();
  s.world_steps = 2000;
  s.skipped_world_steps = 1000;
  s.world.p50 = 60e-3;
  EXPECT_THAT(verdict_of(s, {}).sentences.front(), HasSubstr("Use --grid 32"));
  s.adviser.advise({24e-3, 2e-3}, {});
  EXPECT_THAT(verdict_of(s, {}).sentences.front(),
              AllOf(HasSubstr("Use --grid 48"), Not(HasSubstr("--grid 32"))));
}

TEST(Verdict, APageHandReleasedUnaskedIsReported) {
  EXPECT_THAT(said([](RunSummary& s) { s.hidden_page_hands = 2; }),
              ElementsAre(StartsWith("The rates were held"),
                          StartsWith("The page's hand was released because its page was hidden "
                                     "(2×): keep the page in front")));
  EXPECT_THAT(said([](RunSummary& s) { s.late_page_hands = 1; }).back(),
              StartsWith("The page's hand was released because no message came from its page for "
                         "0.5 s (1×)"));
}

TEST(Verdict, ASlowFluidIsReportedWithTheGridThatFits) {
  const Verdict verdict = judged([](RunSummary& s) {
    s.world_steps = 2610;
    s.skipped_world_steps = 390;
    s.plans = 1005;
    s.world.p50 = 21.4e-3;
  });
  EXPECT_EQ(verdict.held, false);
  EXPECT_THAT(
      verdict.sentences,
      ElementsAre("The rates were not held: smoke 43.5 of 50 Hz, plans 21.8 of 25 Hz. "
                  "A step takes 23.0 ms (median); the budget is 20 ms. Use --grid 48, which keeps "
                  "the stimulus of one-plume, or close other programs."));
  // no grid is coarse enough
  EXPECT_THAT(said([](RunSummary& s) {
                s.world_steps = 1000;
                s.skipped_world_steps = 2000;
                s.world.p50 = 200e-3;
              }).front(),
              AllOf(HasSubstr("is 20 ms. No option is fast enough and keeps the stimulus of "
                              "one-plume: close other programs"),
                    Not(HasSubstr("--grid"))));
}

TEST(Verdict, OneStepInAHundredMayBeMissing) {
  const auto with_skipped = [](std::int64_t skipped) {
    return judged([&](RunSummary& s) {
      s.world_steps -= skipped;
      s.skipped_world_steps = skipped;
      s.plans -= skipped / 2;
    });
  };
  EXPECT_EQ(with_skipped(30).held, true);
  EXPECT_EQ(with_skipped(32).held, false);
  EXPECT_THAT(with_skipped(32).sentences.front(), HasSubstr("another program takes the processor"));
}

TEST(Verdict, ASlowPlannerIsReported) {
  const auto slow = [](RunSummary& s) {
    s.plans = 700;
    s.skipped_updates = 500;
    s.plan.p50 = 58e-3;
  };
  EXPECT_EQ(judged(slow).held, false);
  EXPECT_THAT(said(slow).front(),
              AllOf(HasSubstr("plans 16.7 of 25 Hz"), HasSubstr("A plan takes 58.0 ms (median)"),
                    HasSubstr("is 40 ms. Use --preset fast")));
  PipelineSettings fast;
  fast.plan.preset = Preset::Fast;
  RunSummary s = good();
  slow(s);
  EXPECT_THAT(verdict_of(s, fast).sentences.front(), HasSubstr("Use fewer --paths."));
}

TEST(Verdict, MissedBlocksAreReportedByTheirEffect) {
  const Verdict few = judged([](RunSummary& s) { s.device.missed_blocks = 3; });
  EXPECT_EQ(few.held, true);
  EXPECT_THAT(few.sentences.front(), HasSubstr("(3 of 60000 blocks missed, hardly noticeable)"));
  const Verdict many = judged([](RunSummary& s) { s.device.missed_blocks = 475; });
  EXPECT_EQ(many.held, false);
  EXPECT_THAT(
      many.sentences,
      ElementsAre(AllOf(StartsWith("Smoke and plans kept their rates (smoke 50.0"),
                        HasSubstr("was silent for 475 ms in all"),
                        HasSubstr("too late for 475 of 60000 blocks"), HasSubstr("ulimit -r 10"))));
  EXPECT_THAT(said([](RunSummary& s) {
                s.device.missed_blocks = 475;
                s.world_steps = 2000;
                s.skipped_world_steps = 1000;
              }),
              ElementsAre(StartsWith("The rates were not held: "),
                          StartsWith("The array was silent for 475 ms in all")));
}

TEST(Verdict, LateBlocksThatTheQueueAbsorbedAreNormal) {
  EXPECT_EQ(said([](RunSummary& s) { s.device.late_blocks = 214; }), said([](RunSummary&) {}));
}

TEST(Verdict, WithoutAClockThePaceIsReported) {
  const auto fast = judged([](RunSummary& s) {
    s.mode = RunMode::AsFastAsPossible;
    s.took = 12.0;
    s.skipped_world_steps = 0;
  });
  EXPECT_FALSE(fast.held);
  EXPECT_THAT(fast.sentences,
              ElementsAre("60.0 s of the scene were computed in 12.0 s, 5.0 times faster than real "
                          "time; without a clock there are no rates to hold.",
                          "Nothing was unusual."));
  EXPECT_THAT(said([](RunSummary& s) {
                s.mode = RunMode::Stepped;
                s.took = 90.0;
              }).front(),
              HasSubstr("computed in 90.0 s, 1.5 times slower than real time"));
  EXPECT_THAT(said([](RunSummary& s) { s.mode = RunMode::Stepped; }).front(),
              HasSubstr("computed in 60.0 s, as fast as real time; "));
}

TEST(Verdict, ARunWithoutAStepIsReported) {
  EXPECT_THAT(verdict_of({}, {}).sentences, ElementsAre("The run ended before its first step."));
}

TEST(Verdict, UnusualEventsAreReportedWithTheirRemedy) {
  const std::pair<std::function<void(RunSummary&)>, const char*> cases[] = {
      {[](RunSummary& s) { s.emit.saturated = 4'800'000; },
       "50 % of the samples were at full scale, 0.224 Pa, where stronger pressure feels the same. "
       "Raise full_scale_pressure in [emit] (--settings)."},
      {[](RunSummary& s) { s.emit.limited = 1'920'000; },
       "20 % of the samples were weakened by the power limit: raise power_limit in [emit] "
       "(--settings), or use fewer --paths."},
      {[](RunSummary& s) { s.contact_stats.joints_outside = 19'500; },
       "50 % of the hand's joints were outside the smoke's box, where nothing is felt: hold it "
       "above the array, or check --tracker."},
      {[](RunSummary& s) { s.contact_stats.steep_cells = 300'000; },
       "60 % of the hand's skin was too steep for the array to press on: turn the palm towards "
       "it."},
      {[](RunSummary& s) { s.unobserved = 12; },
       "12 updates are missing in the recording or for the picture: writing was too slow. Record "
       "to a faster disk."},
      {[](RunSummary& s) { s.world_resets = 2; },
       "The smoke simulation failed 2 times and restarted at rest: ignore what was felt then."},
      {[](RunSummary& s) { s.limited_samples = 7; },
       "7 samples were outside the device's limits and were clamped: an earlier stage is at "
       "fault."},
      {[](RunSummary& s) {
         s.safety.acoustic_pressure = 4;
         s.safety.head_level = 1'920'000;
       },
       "20 % of the samples were weakened to keep the caps of [safety], most of them for "
       "head_level: hold the hand farther from the array, or use fewer --paths "
       "(docs/devices/safety.md)."},
  };
  for (const auto& [change, sentence] : cases) {
    const Verdict verdict = judged(change);
    EXPECT_EQ(verdict.held, true);
    EXPECT_THAT(verdict.sentences, ElementsAre(StartsWith("The rates were held: "), sentence));
  }
}

// a small box that follows a finger cannot contain the whole hand
TEST(Verdict, AHandMayReachBeyondABoxThatFollowsIt) {
  RunSummary s = good();
  s.contact_stats.joints_outside = 19'500;
  PipelineSettings settings;
  settings.box.follow = BoxFollows::Index;
  EXPECT_THAT(verdict_of(s, settings, {}).sentences,
              ElementsAre(StartsWith("The rates were held: "), "Nothing was unusual."));
}

TEST(Verdict, ARunWithoutContactIsExplained) {
  const auto nothing_felt = [](auto change) {
    return said([&](RunSummary& s) {
      s.plans = 0;
      s.empty_updates = 1500;
      change(s);
    });
  };
  EXPECT_THAT(nothing_felt([](RunSummary& s) { s.contact_stats = {}; }).back(),
              "No hand was in sight, so nothing was felt.");
  EXPECT_THAT(
      nothing_felt([](RunSummary& s) {
        s.contact_stats.skin_cells = 0;
        s.contact_stats.joints_outside = s.contact_stats.joints;
      }),
      ElementsAre(StartsWith("The rates were held"),
                  StartsWith("The hand never faced the array in the smoke's box, so nothing "
                             "was felt: hold it above the array")));
  EXPECT_THAT(nothing_felt([](RunSummary&) {}).back(),
              "No pressure reached the hand, so nothing was felt.");
}

TEST(Verdict, ATrackerIsEvaluated) {
  const auto of = [](const std::function<void(TrackerStatus&)>& change) {
    TrackerStatus tracker;
    tracker.connected = true;
    tracker.frames = 6000;
    tracker.sentence = "connected to leap://127.0.0.1:6437";
    change(tracker);
    return judged([](RunSummary&) {}, tracker).sentences;
  };
  EXPECT_THAT(of([](TrackerStatus&) {}).back(), "Nothing was unusual.");
  EXPECT_THAT(of([](TrackerStatus& t) { t.reconnects = 2; }).back(),
              StartsWith("The tracker was lost 2 times and came back"));
  EXPECT_THAT(of([](TrackerStatus& t) { t.dropped = 300; }).back(),
              "5 % of the tracker's 6000 frames were discarded: connected to "
              "leap://127.0.0.1:6437.");
  EXPECT_THAT(of([](TrackerStatus& t) { t.connected = false; }).back(),
              StartsWith("The tracker was lost and had not come back at the end: "));
  // consequences of that are not reported
  RunSummary s = good();
  s.plans = 0;
  s.contact_stats = {};
  TrackerStatus absent;
  absent.sentence = "nothing answers";
  EXPECT_THAT(verdict_of(s, {}, absent).sentences,
              ElementsAre(StartsWith("The rates were held"),
                          "No hand frame ever arrived: nothing answers."));
}

TEST(Verdict, HasAtMostFourSentencesTheMostImportantFirst) {
  const auto all = said([](RunSummary& s) {
    s.device.missed_blocks = 475;
    s.world_steps = 2000;
    s.skipped_world_steps = 1000;
    s.unobserved = 12;
    s.emit.saturated = s.emit.samples;
    s.contact_stats.joints_outside = s.contact_stats.joints / 2;
    s.world_resets = 1;
  });
  EXPECT_THAT(
      all,
      ElementsAre(StartsWith("The rates were not held"), StartsWith("The array was silent"),
                  StartsWith("The smoke simulation failed"), HasSubstr("of the hand's joints")));
}

TEST(Verdict, AHandThatIsEnteringIsNoWarning) {
  const auto outside_for = [](double seconds) {
    return said([seconds](RunSummary& s) {
      s.seconds = seconds;
      s.contact_stats.joints_outside = s.contact_stats.joints / 2;
    });
  };
  EXPECT_THAT(outside_for(8.0).back(), "Nothing was unusual.");
  EXPECT_THAT(outside_for(12.0).back(), HasSubstr("of the hand's joints were outside"));
}

}  // namespace
}  // namespace prostm
