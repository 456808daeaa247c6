// Closed loops on AUTD3 units.
#include <gmock/gmock.h>

#include "autd3_stand_in.hpp"
#include "prostm/device/autd3/detail/autd3_loops.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

using test::sleep_s;
using test::StandIn;
using testing::HasSubstr;

/// A circle of a few focal points that closes after `length` samples.
std::vector<FocusSample> circle(int length, int foci, double radius, double begin = 0.0) {
  std::vector<FocusSample> loop;
  for (int s = 0; s < length; ++s) {
    for (int f = 0; f < foci; ++f) {
      const double angle = begin + 2.0 * std::numbers::pi * s / length + f;
      loop.push_back(
          {Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.2).cast<float>(),
           0.8F});
    }
  }
  return loop;
}

TEST(Autd3Loops, AreRepeatedAndReplaced) {
  StandIn server({"--frames-per-ms", "4", "--log"});
  Autd3Array array(server.setup());
  EXPECT_TRUE(array.info().loads_segments);
  const int length = static_cast<int>(array.info().sample_rate * 0.12 / 7.0);  // 120 mm at 7 m/s
  /// Loads a loop while another plays. @return the number of silences in the meantime.
  const auto silences_of = [&](const std::vector<FocusSample>& loop) {
    EXPECT_GT(server.wait_until_it(true), 0.0);
    const int before = server.report()["silences"];
    EXPECT_EQ(array.load_segment(loop, 4), DeviceStatus::Running);
    sleep_s(0.2);
    EXPECT_GT(server.wait_until_it(true), 0.0);
    return server.report()["silences"].get<int>() - before;
  };
  ASSERT_EQ(array.load_segment(circle(length, 4, 0.019), 4), DeviceStatus::Running);
  // same length, and close by: the switch happens at the same sample, without silence
  double radius = 0.019;
  EXPECT_EQ(test::best_of(5, 0.5,
                          [&] {
                            radius += 0.02e-3;
                            return silences_of(circle(length, 4, radius));
                          }),
            0);
  EXPECT_LE(server.report()["largest_speed"], 8.0);
  // far away, or of another length: the switch needs a short silence
  EXPECT_GE(silences_of(circle(length, 4, 0.019, 2.0)), 1);
  EXPECT_GE(silences_of(circle(length + 7, 4, 0.019)), 1);
  const nlohmann::json report = server.report();
  EXPECT_LE(report["largest_speed"], 8.0);
  EXPECT_EQ(report["problems"], 0) << report["first_problem"];
  EXPECT_EQ(report["errors"], 0);
  EXPECT_EQ(report["sounds"], true);
  const std::vector<test::PlayedSample> log = server.log();
  ASSERT_FALSE(log.empty());
  EXPECT_NEAR((log.back().place(0) - Vec3(0.0, 0.0, 0.2)).norm(), 0.019, 0.05e-3);
  array.stop();
  EXPECT_EQ(server.report()["sounds"], false);
}

// a modulation that arrives later than expected is sent again, with the margin that it needs
TEST(Autd3Loops, ContinueWhenTheLinkBecomesSlower) {
  StandIn server({"--frames-per-ms", "4"});
  Autd3Array array(server.setup());
  ASSERT_EQ(array.load_segment(circle(150, 4, 0.019), 4), DeviceStatus::Running);
  ASSERT_GT(server.wait_until_it(true), 0.0);
  for (const char* delay : {"delay 2", "delay 4"}) {  // of each frame [ms]
    server.say(delay);
    EXPECT_EQ(test::best_of(5, 0.5,
                            [&] {
                              const int before = server.report()["silences"];
                              sleep_s(0.4);
                              return server.report()["silences"].get<int>() - before;
                            }),
              0)
        << delay;
  }
  array.stop();
  EXPECT_EQ(server.report()["sounds"], false);
}

TEST(Autd3Loops, ResumeAfterADisconnection) {
  StandIn server({"--frames-per-ms", "4"});
  Autd3Array array(server.setup(2));
  ASSERT_EQ(array.load_segment(circle(150, 2, 0.019), 2), DeviceStatus::Running);
  ASSERT_GT(server.wait_until_it(true), 0.0);
  const double cut = test::now_s();
  server.say("cut 100");
  ASSERT_TRUE(test::eventually([&] { return array.status() == DeviceStatus::Vanished; }));
  const double again = server.wait_until_it(true);
  EXPECT_GT(again, 0.0);
  EXPECT_LT(again - cut, 1.0);
}

TEST(Autd3Loops, MayBeAsLongAsTheUnitsStore) {
  StandIn server({"--frames-per-ms", "0"});
  Autd3Array array(server.setup());
  EXPECT_EQ(array.load_segment(circle(8193, 4, 0.019), 4), DeviceStatus::Refused);
  EXPECT_THAT(array.problem(), HasSubstr("AUTD3 holds 8192 of 8 slots"));
  ASSERT_EQ(array.load_segment(circle(8192, 4, 0.019), 4), DeviceStatus::Running);
  ASSERT_GT(server.wait_until_it(true), 0.0);
  // the current loop keeps playing while the next one is written
  EXPECT_EQ(test::best_of(4, 0.5,
                          [&] {
                            const int before = server.report()["silences"];
                            EXPECT_EQ(array.load_segment(circle(8192, 4, 0.01901), 4),
                                      DeviceStatus::Running);
                            sleep_s(0.7);
                            return server.report()["silences"].get<int>() - before;
                          }),
            0);
  const nlohmann::json report = server.report();
  EXPECT_EQ(report["problems"], 0) << report["first_problem"];
}

TEST(Autd3Loops, AreRejectedWithOneSentence) {
  StandIn server({"--frames-per-ms", "0"});
  Autd3Array array(server.setup(2));
  EXPECT_EQ(array.load_segment(circle(10, 3, 0.019), 3), DeviceStatus::Refused);
  EXPECT_THAT(array.problem(), HasSubstr("was set up for 1 to 2"));
  std::vector<FocusSample> bad = circle(10, 2, 0.019);
  bad[7].intensity = NAN;
  EXPECT_EQ(array.load_segment(bad, 2), DeviceStatus::Refused);
  EXPECT_THAT(array.problem(), HasSubstr("Sample 3 of the loop"));
  EXPECT_EQ(array.load_segment({}, 2), DeviceStatus::Refused);
  test::Circles source(2, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  EXPECT_EQ(array.load_segment(circle(10, 2, 0.019), 2), DeviceStatus::Refused);
  EXPECT_THAT(array.problem(), HasSubstr("plays a stream"));
  // a point at rest is the shortest loop
  array.stop();
  EXPECT_EQ(array.load_segment(circle(1, 2, 0.019), 2), DeviceStatus::Running);
  EXPECT_GT(server.wait_until_it(true), 0.0);
}

}  // namespace
}  // namespace prostm
