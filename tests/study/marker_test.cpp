#include "prostm/study/session/marker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/study_support.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

TEST(Marker, LabelsKeepTheirParts) {
  for (const Presentation& p : {Presentation{0, 0, 0}, Presentation{1, 2, 3},
                                Presentation{(1U << 24U) - 1, (1U << 24U) - 1, 0xFFFF}})
    EXPECT_EQ(Presentation::of_label(p.label()), p);
}

TEST(Marker, CodesMatchTheTable) {
  Marker marker;
  const auto code = [&](bool on, Presentation p, int part) {
    marker.on = on;
    marker.presentation = p;
    marker.part = part;
    return int{code_of(marker)};
  };
  EXPECT_EQ(code(true, {1, 1, 0}, 1), 1);
  EXPECT_EQ(code(false, {1, 1, 0}, 1), 2);
  EXPECT_EQ(code(true, {1, 1, 0}, 2), 3);
  EXPECT_EQ(code(true, {1, 0, 0}, 1), 4);
  EXPECT_EQ(code(false, {1, 0, 0}, 1), 5);
  EXPECT_EQ(code(true, {1, 1, 1}, 1), 16);
  EXPECT_EQ(code(true, {1, 1, 3}, 2), 3);
  EXPECT_EQ(code(false, {1, 1, 3}, 1), 2);
  EXPECT_EQ(code(true, {1, 1, kMostMarkedConditions}, 1), 254);
}

TEST(Marker, ShowsTheConditionOnlyIfAllowed) {
  const Protocol blind = test::study_protocol();
  EXPECT_FALSE(blind.markers.conditions);
  Marker marker;
  marker.on = true;
  marker.presentation = {4, 2, 0};
  marker.played = 100.0000004;
  marker.sent = 100.0015;
  marker.utc_offset = 1.7e9;
  const auto json = marker_json(marker, blind, 2);
  EXPECT_EQ(json["event"], "stimulus-on");
  EXPECT_EQ(json["run"], 2);
  EXPECT_EQ(json["played_s"], 100.0);
  EXPECT_NEAR(json["played_utc_s"].get<double>(), 1.7e9 + 100.0, 2e-6);
  EXPECT_NEAR(json["late_ms"].get<double>(), 1.5, 1e-3);
  EXPECT_FALSE(json.contains("method") || json.contains("scene"));
  marker.presentation.condition = 4;
  const auto told = marker_json(marker, blind, 2);
  EXPECT_EQ(told["method"], "pro-stm");
  EXPECT_EQ(told["scene"], "four-plumes");
  EXPECT_TRUE(told["played"].is_null());
  marker.emission = {.speed = 7.98765432, .period = 0.025, .changed = 1};
  EXPECT_EQ(
      marker_json(marker, blind, 2)["played"],
      (nlohmann::ordered_json{{"speed_m_s", 7.9877}, {"period_ms", 25.0}, {"changed_paths", 1}}));
  marker.presentation.condition = 0;
  EXPECT_FALSE(marker_json(marker, blind, 2).contains("played"));
  marker.presentation.condition = 4;
  marker.played.reset();
  EXPECT_TRUE(marker_json(marker, blind, 2)["late_ms"].is_null());
}

TEST(Marker, ASessionsPresentationHasItsTrialAndItsConditionIfAllowed) {
  for (const bool told : {false, true}) {
    const Protocol protocol =
        test::study_protocol(std::string("methods = \"within\"\n[markers]\nconditions = ") +
                             (told ? "true" : "false") + "\n[training]\nseconds = 0\n");
    const test::TemporaryFolder folder;
    ResponseFile file(folder.file("1.jsonl"));
    StudySession session(protocol, 1, file, {}, test::sight_at(0.0));
    EXPECT_EQ(presentation_of(session, 7), (Presentation{7, 0, 0}));
    session.take({.what = StudyAct::Do::Next}, test::sight_at(1.0));
    for (double time = 1.0; session.phase() != StudyPhase::Presenting && time < 30.0; time += 0.1)
      session.look(test::sight_at(time));
    ASSERT_EQ(session.phase(), StudyPhase::Presenting) << session.waits_for();
    const Trial& trial = session.trial();
    const int condition = told ? 2 * trial.method + trial.scene + 1 : 0;
    EXPECT_EQ(presentation_of(session, 7),
              (Presentation{7, 1, static_cast<std::uint16_t>(condition)}));
  }
}

TEST(Marker, MoreConditionsThanCodesAreRejected) {
  std::string methods;
  for (int i = 0; i < 120; ++i) methods += "[method.m" + std::to_string(i) + "]\n";
  const auto read = [&](const std::string& more) {
    return [&, more] { test::study_protocol(more, methods); };
  };
  EXPECT_NO_THROW(read("[markers]\nconditions = false\n")());
  EXPECT_THAT(test::input_error(read("[markers]\nconditions = true\n")),
              testing::HasSubstr("markers.conditions needs a code for each of 240 conditions"));
}

}  // namespace
}  // namespace prostm
