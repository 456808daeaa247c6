/// All messages of a page, valid and invalid.

#include "prostm/viewer/page_message.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "prostm/core/units.hpp"
#include "support/input_errors.hpp"

namespace prostm {
namespace {

std::string problem_of(const std::string& text) {
  const test::WithoutTraps without;  // for numbers like 1e999
  PageMessage message;
  std::string problem;
  return read_page_message(text, message, problem) ? "" : problem;
}

template <class T>
T read(const std::string& text) {
  PageMessage message;
  std::string problem;
  EXPECT_TRUE(read_page_message(text, message, problem)) << problem;
  return std::get<T>(message);
}

TEST(PageMessage, SetTakesNumbersSwitchesAndNames) {
  EXPECT_EQ(std::get<double>(read<SetMessage>(R"({"type":"set","id":"gain","value":2})").value), 2);
  EXPECT_EQ(std::get<bool>(read<SetMessage>(R"({"type":"set","id":"a","value":true})").value),
            true);
  const auto set = read<SetMessage>(R"({"type":"set","id":"scene","value":"still-air"})");
  EXPECT_EQ(set.id, "scene");
  EXPECT_EQ(std::get<std::string>(set.value), "still-air");
}

TEST(PageMessage, TransportHasFourCommands) {
  using Do = TransportMessage::Do;
  EXPECT_EQ(read<TransportMessage>(R"({"type":"transport","do":"play"})").what, Do::Play);
  EXPECT_EQ(read<TransportMessage>(R"({"type":"transport","do":"pause"})").what, Do::Pause);
  EXPECT_EQ(read<TransportMessage>(R"({"type":"transport","do":"step"})").what, Do::Step);
  const auto seek = read<TransportMessage>(R"({"type":"transport","do":"seek","time_s":1.5})");
  EXPECT_EQ(seek.what, Do::Seek);
  EXPECT_EQ(seek.time, 1.5);
}

TEST(PageMessage, HandIsInMetresAndRadians) {
  const auto hand = read<HandMessage>(
      R"({"type":"hand","palm_mm":[10,-20,200],"yaw_deg":90,"pitch_deg":0,"roll_deg":-45,)"
      R"("closure":0.25,"side":"left"})");
  EXPECT_FALSE(hand.release);
  EXPECT_DOUBLE_EQ(hand.palm[0], 0.010);
  EXPECT_DOUBLE_EQ(hand.palm[1], -0.020);
  EXPECT_DOUBLE_EQ(hand.palm[2], 0.200);
  EXPECT_DOUBLE_EQ(hand.yaw, kPi / 2);
  EXPECT_DOUBLE_EQ(hand.roll, -kPi / 4);
  EXPECT_EQ(hand.closure, 0.25);
  EXPECT_TRUE(hand.left);
  EXPECT_FALSE(hand.take);
  const auto released = read<HandMessage>(R"({"type":"hand","release":true})");
  EXPECT_TRUE(released.release);
  EXPECT_FALSE(released.hidden);
  EXPECT_TRUE(read<HandMessage>(R"({"type":"hand","release":true,"hidden":true})").hidden);
}

TEST(PageMessage, CalibrationMuteAndRate) {
  using Do = CalibrationMessage::Do;
  EXPECT_EQ(read<CalibrationMessage>(R"({"type":"calibration","do":"begin"})").what, Do::Begin);
  const auto take = read<CalibrationMessage>(R"({"type":"calibration","do":"take","mark":2})");
  EXPECT_EQ(take.what, Do::Take);
  EXPECT_EQ(take.mark, 2);
  EXPECT_EQ(read<CalibrationMessage>(R"({"type":"calibration","do":"cancel"})").what, Do::Cancel);
  EXPECT_TRUE(read<MuteMessage>(R"({"type":"mute","on":true})").on);
  EXPECT_FALSE(read<MuteMessage>(R"({"type":"mute","on":false})").on);
  EXPECT_EQ(read<RateMessage>(R"({"type":"rate","hz":60})").rate, 60.0);
}

TEST(PageMessage, Study) {
  using Do = StudyAct::Do;
  EXPECT_EQ(read<StudyAct>(R"({"type":"study","do":"next"})").what, Do::Next);
  const auto answer = read<StudyAct>(R"({"type":"study","do":"answer","yes":true})");
  EXPECT_EQ(answer.what, Do::Answer);
  EXPECT_TRUE(answer.yes);
  EXPECT_EQ(read<StudyAct>(R"({"type":"study","do":"answer","interval":2})").interval, 2);
  const auto tune = read<StudyAct>(R"({"type":"study","do":"tune","to":"less","coarse":true})");
  EXPECT_EQ(tune.what, Do::Tune);
  EXPECT_EQ(tune.steps, -1);
  EXPECT_TRUE(tune.coarse);
  EXPECT_EQ(read<StudyAct>(R"({"type":"study","do":"accept"})").what, Do::Accept);
  EXPECT_EQ(read<StudyAct>(R"({"type":"study","do":"explore","scene":3})").scene, 3);
  const auto about = read<StudyAct>(R"({"type":"study","do":"about","about":{"hand":"left"}})");
  EXPECT_EQ(about.about, (nlohmann::ordered_json{{"hand", "left"}}));
  // every act by its name
  for (std::size_t i = 0; i < kNames<Do>.size(); ++i) {
    const nlohmann::json message = {{"type", "study"},
                                    {"do", kNames<Do>[i]},
                                    {"yes", true},
                                    {"to", "more"},
                                    {"coarse", false},
                                    {"scene", 0},
                                    {"about", nlohmann::json::object()}};
    EXPECT_EQ(read<StudyAct>(message.dump()).what, static_cast<Do>(i)) << kNames<Do>[i];
  }
}

TEST(PageMessage, ReportOfTheParticipantsPage) {
  const auto report =
      read<PageReport>(R"({"type":"page","visible":true,"noise":"playing","picture":false})");
  EXPECT_TRUE(report.visible);
  EXPECT_EQ(report.noise, PageNoise::Playing);
  EXPECT_FALSE(report.picture);
}

TEST(PageMessage, InvalidMessagesAreReportedInASentence) {
  const char* const hand =
      R"({"type":"hand","palm_mm":[0,0,200],"yaw_deg":0,"pitch_deg":0,"roll_deg":0,"closure":0,)";
  const std::pair<std::string, std::string> cases[] = {
      {"", "JSON object"},
      {"[]", "JSON object"},
      {"{", "JSON object"},
      {"\xff\xfe", "JSON object"},
      {std::string(4097, ' '), "4096 bytes"},
      {"{}", "lacks \"type\""},
      {R"({"type":7})", "\"type\" must be a string"},
      {R"({"type":"reset"})", "set, transport, hand, calibration, mute, rate, study or page"},
      {R"({"type":"page","visible":true,"picture":true})", "lacks \"noise\""},
      {R"({"type":"page","visible":true,"noise":"loud","picture":true})", "off, silent or playing"},
      {R"({"type":"set","value":1})", "lacks \"id\""},
      {R"({"type":"set","id":"gain"})", "lacks \"value\""},
      {R"({"type":"set","id":"gain","value":null})", "\"value\" must be a number"},
      {R"({"type":"set","id":"gain","value":1e999})", "JSON object"},
      {R"({"type":"set","id":"gain","value":[1]})", "\"value\" must be a number"},
      {R"({"type":"transport","do":"rewind"})", "play, pause, step or seek"},
      {R"({"type":"transport","do":"seek"})", "lacks \"time_s\""},
      {R"({"type":"transport","do":"seek","time_s":-1})", "\"time_s\" must be a number between 0"},
      {hand + std::string(R"("side":"up"})"), "left or right"},
      {hand + std::string("\"x\":0}"), "lacks \"side\""},
      {R"({"type":"hand"})", "lacks \"palm_mm\""},
      {R"({"type":"hand","palm_mm":[0,0]})", "three numbers"},
      {R"({"type":"hand","palm_mm":[0,0,"a"]})", "\"palm_mm\" must be a number"},
      {R"({"type":"hand","palm_mm":[0,0,2000]})", "between -500 and 500"},
      {R"({"type":"hand","release":1})", "true or false"},
      {R"({"type":"hand","release":true,"hidden":1})", "\"hidden\" must be true or false"},
      {R"({"type":"calibration","do":"undo"})", "begin, take, solve, save or cancel"},
      {R"({"type":"calibration","do":"take"})", "lacks \"mark\""},
      {R"({"type":"calibration","do":"take","mark":0.5})", "whole number"},
      {R"({"type":"calibration","do":"take","mark":-1})", "between 0 and 100"},
      {R"({"type":"hand","take":1})", "\"take\" must be true or false"},
      {R"({"type":"mute"})", "lacks \"on\""},
      {R"({"type":"mute","on":1})", "\"on\" must be true or false"},
      {R"({"type":"rate","hz":0})", "between 1 and 60"},
      {R"({"type":"rate","hz":"fast"})", "between 1 and 60"},
      {R"({"type":"study","do":"peek"})", "next, anyway, answer, correct, pause"},
      {R"({"type":"study","do":"answer"})", "lacks \"yes\""},
      {R"({"type":"study","do":"answer","interval":10})", "between 1 and 9"},
      {R"({"type":"study","do":"answer","interval":1.5})", "must be a whole number"},
      {R"({"type":"study","do":"tune","to":"up","coarse":false})", "less or more"},
      {R"({"type":"study","do":"tune","to":"more"})", "lacks \"coarse\""},
      {R"({"type":"study","do":"explore","scene":-1})", "between 0 and 1000"},
      {R"({"type":"study","do":"about","about":[]})", "an object of at most 20 texts"},
      {R"({"type":"study","do":"about","about":{"age":30}})", "at most 200 bytes"}};
  for (const auto& [text, expected] : cases) {
    SCOPED_TRACE(text.substr(0, 100));
    EXPECT_NE(problem_of(text).find(expected), std::string::npos) << problem_of(text);
  }
}

TEST(PageMessage, DeepNestingIsAnInvalidMessage) {
  EXPECT_FALSE(problem_of(std::string(4000, '[')).empty());
  EXPECT_FALSE(problem_of(std::string(2000, '[') + std::string(2000, ']')).empty());
}

}  // namespace
}  // namespace prostm
