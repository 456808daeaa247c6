#include "prostm/device/autd3/autd3_array.hpp"

#include <gmock/gmock.h>

#include "autd3_stand_in.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

using test::Circles;
using test::now_s;
using test::sleep_s;
using test::StandIn;
using testing::HasSubstr;

/// Message of the exception that construction throws; empty if it throws none.
std::string refusal_of(const Autd3Setup& setup) {
  try {
    const Autd3Array array(setup);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return {};
}

void expect_no_fault(const nlohmann::json& report) {
  EXPECT_EQ(report["problems"], 0) << report["first_problem"];
  EXPECT_EQ(report["errors"], 0);
}

/// Largest distance between the positions played and those given, sample by sample. [m]
double largest_error(const std::vector<test::PlayedSample>& log, const Circles& given, int foci,
                     int& compared) {
  double largest = 0.0;
  std::int64_t at = -1;
  for (const test::PlayedSample& played : log) {
    if (played.intensity == 0 || played.loudest == 0) {
      at = -1;
      continue;
    }
    const Vec3 first = played.place(0);
    if (at < 0) {
      // finds the position in the stream at which the output resumes
      double best = 1.0;
      for (std::int64_t k = 0; k < given.samples(); ++k) {
        const double away = (given.place(0, k) - first).norm();
        if (away < best - 1e-9) best = away, at = k;
        if (best < 0.02e-3) break;
      }
    }
    for (int f = 0; f < foci; ++f) {
      const Vec3 told = played.place(static_cast<std::size_t>(2 * f));
      largest = std::max(largest, (given.place(f, at) - told).norm());
    }
    ++at;
    ++compared;
  }
  return largest;
}

/// Plays for 1.5 s and compares each sample. @return false if every block was too late.
bool plays_every_sample() {
  StandIn server({"--frames-per-ms", "2", "--log"});
  Autd3Array array(server.setup());
  EXPECT_LE(array.budget().frames_per_ms, 2.1);
  EXPECT_LE(array.budget().block_time, 0.0205);
  Circles source(4, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  EXPECT_EQ(array.start(source), DeviceStatus::Running);
  sleep_s(1.5);
  const DeviceStats stats = array.stats();
  array.stop();
  const nlohmann::json report = server.report();
  std::printf("%s\n%s\nmissed %d of %d blocks, longest silence %.1f ms\n",
              array.description().c_str(), report.dump().c_str(),
              static_cast<int>(stats.missed_blocks), static_cast<int>(stats.blocks),
              1e3 * report["longest_silence"].get<double>());
  if (stats.missed_blocks == stats.blocks) return false;
  expect_no_fault(report);
  EXPECT_GE(stats.blocks, 30);
  EXPECT_EQ(report["sounds"], false);
  EXPECT_GE(report["largest_key"], 150);
  EXPECT_LE(report["largest_speed"], 8.0);
  EXPECT_LE(report["phase_error"], 4.0);  // due to the firmware's own tables
  int compared = 0;
  EXPECT_LT(largest_error(server.log(), source, 4, compared), 0.05e-3);
  EXPECT_GT(compared, 500);
  EXPECT_EQ(source.allocations(), 0U);
  return true;
}

TEST(Autd3Array, PlaysEverySampleAtItsPosition) {
  // a connection measures its link once: if the machine slows down after that, all blocks are late
  bool played = false;
  for (int connection = 0; connection < 3 && !played; ++connection) played = plays_every_sample();
  EXPECT_TRUE(played);
}

TEST(Autd3Array, SendsEachUnitItsOwnPositions) {
  StandIn server;
  Autd3Setup setup = server.setup(2);
  setup.units = autd3_units_from_json(
      R"({"format": "prostm-autd3/1", "units": [{"position_mm": [-96, 0, 0]},
          {"position_mm": [96, 0, 5], "quaternion": [0, 0, 1, 0]}]})",
      "units.json");
  Autd3Array array(setup);
  const nlohmann::json places = server.report()["places"];
  ASSERT_EQ(places.size(), 14U);
  // transducer 0 lies 8.5 and 6.5 pitches of 10.16 mm from the middle
  EXPECT_NEAR(places[0], -96.0 - 86.36, 1e-3);
  EXPECT_NEAR(places[1], -66.04, 1e-3);
  EXPECT_NEAR(places[3], 1.0, 1e-6);
  EXPECT_NEAR(places[7], 96.0 + 86.36, 1e-3);
  EXPECT_NEAR(places[8], 66.04, 1e-3);
  EXPECT_NEAR(places[9], 5.0, 1e-3);
  Circles source(2, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  EXPECT_GT(server.wait_until_it(true), 0.0);
  array.stop();
  expect_no_fault(server.report());
}

TEST(Autd3Array, GivesEqualFocalPointsOneSlotEach) {
  StandIn server;
  Autd3Setup setup = server.setup(8);
  EXPECT_THAT(refusal_of(setup), HasSubstr("1 to 4 focal points"));
  setup.own_intensities = false;
  Autd3Array array(setup);
  EXPECT_EQ(array.budget().slots, 8);
  EXPECT_FALSE(array.info().intensity_per_focus);
}

TEST(Autd3Array, ResumesAfterADisconnection) {
  StandIn server;
  Autd3Array array(server.setup());
  Circles source(4, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  const double again = test::best_of(3, 1.0, [&] {
    EXPECT_GT(server.wait_until_it(true), 0.0);
    const double cut = now_s();
    server.say("cut 300");
    EXPECT_TRUE(test::eventually([&] { return array.status() == DeviceStatus::Vanished; }));
    EXPECT_THAT(array.problem(), HasSubstr("is lost"));
    EXPECT_TRUE(test::eventually([&] { return array.status() == DeviceStatus::Running; }));
    EXPECT_EQ(array.problem(), "");
    return server.wait_until_it(true) - cut;
  });
  EXPECT_GT(again, 0.3);
  EXPECT_LT(again, 1.0);
  std::printf("sounds %.0f ms after a cut of 300 ms\n", 1e3 * again);
  const DeviceStats stats = array.stats();
  EXPECT_GE(stats.lost_links, 1);
  EXPECT_GE(static_cast<double>(stats.lost_blocks) * array.info().block_time(), 0.3);
  EXPECT_LE(stats.lost_blocks + stats.slow_blocks, stats.missed_blocks);
  array.stop();
  expect_no_fault(server.report());
}

TEST(Autd3Array, ResumesAfterAHalfOpenConnection) {
  StandIn server;
  Autd3Array array(server.setup());
  Circles source(4, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  double silent = 0.0;
  const double again = test::best_of(3, 0.4 + 1.0, [&] {
    EXPECT_GT(server.wait_until_it(true), 0.0);
    const double stall = now_s();
    server.say("stall 400");
    silent = server.wait_until_it(false) - stall;
    EXPECT_LT(silent, 0.1);
    return server.wait_until_it(true) - stall;
  });
  EXPECT_LT(again, 0.4 + 1.0);
  std::printf("silent %.0f ms after a stall, sounds %.0f ms after it\n", 1e3 * silent,
              1e3 * again - 400.0);
  array.stop();
}

TEST(Autd3Array, CountsMissedBlocksOfASlowLinkAndNeverJumps) {
  StandIn server({"--frames-per-ms", "4"});
  Autd3Array array(server.setup());
  Circles source(4, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  ASSERT_GT(server.wait_until_it(true), 0.0);
  const std::int64_t before = array.stats().missed_blocks;
  server.say("rate 0.4");
  sleep_s(0.4);
  server.say("rate 4");
  EXPECT_GT(array.stats().missed_blocks, before + 3);
  EXPECT_GT(server.wait_until_it(true), 0.0);
  array.stop();
  const nlohmann::json report = server.report();
  expect_no_fault(report);
  EXPECT_LE(report["largest_speed"], 8.0);
}

TEST(Autd3Array, ExplainsEachErrorAndContinues) {
  const std::array words = {"",        "v12.1",    "error 2",          "error 3", "error 4",
                            "error 5", "too late", "silencer's limit", "error 8"};
  StandIn server({"--frames-per-ms", "8"});
  Autd3Array array(server.setup(1));
  Circles source(1, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  for (int error = 1; error <= 8; ++error) {
    ASSERT_GT(server.wait_until_it(true), 0.0) << error;
    server.say("refuse " + std::to_string(error) + " 1");
    ASSERT_TRUE(test::eventually([&] { return array.status() == DeviceStatus::Vanished; }));
    EXPECT_THAT(array.problem(), HasSubstr(words[static_cast<std::size_t>(error)]));
    ASSERT_TRUE(test::eventually([&] { return array.status() == DeviceStatus::Running; }));
  }
}

TEST(Autd3Array, ReportsWhyItCannotStart) {
  Autd3Setup nowhere;
  nowhere.address = {"127.0.0.1", 1};
  EXPECT_THAT(refusal_of(nowhere), HasSubstr("nothing listens there; start AUTD3's simulator"));
  StandIn old({"--version", "163"});
  EXPECT_THAT(refusal_of(old.setup()), HasSubstr("v11.0.0; AUTD3 v38 needs v12.1"));
  StandIn slow({"--frames-per-ms", "0.1"});
  EXPECT_THAT(refusal_of(slow.setup()), HasSubstr("too few for 8 slots at 2 kHz"));
}

TEST(Autd3Array, ReportsAHotUnit) {
  StandIn server;
  Autd3Array array(server.setup(1));
  Circles source(1, array.info().sample_rate);
  const test::StopAtEnd stop(array);
  ASSERT_EQ(array.start(source), DeviceStatus::Running);
  EXPECT_FALSE(array.is_hot());
  server.say("hot 1");
  EXPECT_TRUE(test::eventually([&] { return array.is_hot(); }));
}

TEST(Autd3Array, IsDetectedWithoutBeingDisturbed) {
  StandIn server({"--frames-per-ms", "0"});
  const DeviceFinding found = look_for_autd3(server.setup());
  EXPECT_TRUE(found.found);
  EXPECT_THAT(found.words, HasSubstr("CPU v12.1.0, FPGA v12.1.0"));
  EXPECT_EQ(server.report()["clears"], 0);
  Autd3Setup nowhere;
  nowhere.address = {"127.0.0.1", 1};
  EXPECT_FALSE(look_for_autd3(nowhere).found);
  EXPECT_THAT(look_for_autd3(nowhere).words, HasSubstr("check the port"));
  // another program is connected
  Autd3Array busy(server.setup(1));
  const double begin = now_s();
  const DeviceFinding waits = look_for_autd3(server.setup());
  EXPECT_LT(now_s() - begin, 1.2);
  EXPECT_FALSE(waits.found);
  EXPECT_THAT(waits.words, HasSubstr("another program is connected"));
}

}  // namespace
}  // namespace prostm
