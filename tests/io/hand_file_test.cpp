#include "prostm/io/hand/hand_file.hpp"

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>

#include "prostm/core/file/file.hpp"
#include "support/input_errors.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using nlohmann::json;

json neutral_header() {
  return {{"format", "hand-frames"}, {"version", 1}, {"units", "m"}, {"source", "made by a test"}};
}

/// Returns a hand whose fingers are straight bones of 30 mm.
json neutral_hand(int id, double y) {
  json p = json::array(), q = json::array(), r = json::array();
  for (int j = 0; j < kJointCount; ++j) {
    const int finger = j < 2 ? 0 : j < 6 ? 0 : (j - 1) / 5;
    const int along = j < 2 ? 0 : j < 6 ? j - 2 : (j - 6) % 5;
    for (const double x : {0.02 * finger, y, -0.03 * along}) p.push_back(x);
    for (const double x : {0.0, 0.0, 0.0, 1.0}) q.push_back(x);
    r.push_back(0.009);
  }
  return {{"id", id}, {"side", "R"}, {"conf", nullptr}, {"inferred", 0},
          {"p", p},   {"q", q},      {"r", r}};
}

json neutral_frame(double t, int id = 1) {
  return {{"t", t}, {"hands", {neutral_hand(id, 0.2)}}};
}

std::string jsonl(const std::vector<json>& lines) {
  std::string text;
  for (const json& line : lines) text += line.dump() + "\n";
  return text;
}

void expect_error(const std::function<void()>& read, const std::string& part) {
  EXPECT_THAT(test::input_error(read), testing::HasSubstr(part));
}

void expect_jsonl_error(const std::string& text, const std::string& part) {
  expect_error([&] { hands_from_jsonl(text, "x.hands.jsonl"); }, part);
}
void expect_leap_error(const json& document, const std::string& part) {
  expect_error([&] { hands_from_leap_json(document.dump(), "x.json"); }, part);
}

TEST(HandsJsonl, ReadsFramesWithAndWithoutHands) {
  const HandRecording recording = hands_from_jsonl(jsonl({neutral_header(),
                                                          neutral_frame(5.0),
                                                          {{"t", 5.5}, {"hands", json::array()}},
                                                          neutral_frame(6.0)}),
                                                   "x");
  ASSERT_EQ(recording.frames.size(), 3u);
  EXPECT_EQ(recording.description, "made by a test");
  EXPECT_EQ(recording.frames[0].time, 0.0);
  EXPECT_EQ(recording.frames[2].time, 1.0);
  EXPECT_TRUE(recording.frames[1].hands.empty());
  const Hand& hand = recording.frames[2].hands.at(0);
  EXPECT_EQ(hand.id, 1);
  EXPECT_EQ(hand.side, Side::Right);
  EXPECT_EQ(hand.confidence, 1.0);
  EXPECT_TRUE(hand.position[kIndexProximal].isApprox(Vec3(0.02, 0.2, -0.03)));
  EXPECT_EQ(hand.radius[kWrist], 0.009);
  EXPECT_EQ(hand.velocity[kPalm], Vec3::Zero());
}

TEST(HandsJsonl, ReportsTheProgressAfterEachFrame) {
  const std::string text = jsonl({neutral_header(), neutral_frame(5.0), neutral_frame(6.0)});
  std::vector<std::size_t> done;
  hands_from_jsonl(text, "x", [&](std::size_t bytes, std::size_t all) {
    EXPECT_EQ(all, text.size());
    done.push_back(bytes);
  });
  ASSERT_EQ(done.size(), 2u);
  EXPECT_LT(done[0], done[1]);
  EXPECT_EQ(done[1], text.size());
}

TEST(HandsJsonl, ReportsErrorsWithTheirPosition) {
  const auto with = [](const char* key, const json& value) {
    json frame = neutral_frame(0.1);
    frame["hands"][0][key] = value;
    return jsonl({neutral_header(), neutral_frame(0.0), frame});
  };
  const auto with_number = [&](const char* key, std::size_t i, const json& value) {
    json list = neutral_hand(1, 0.2)[key];
    list[i] = value;
    return with(key, list);
  };
  json short_list = neutral_hand(1, 0.2)["p"];
  short_list.erase(0);
  expect_jsonl_error("", "is empty");
  expect_jsonl_error(" \n\n", "is empty");
  expect_jsonl_error(jsonl({neutral_header()}), "holds 0 frames");
  expect_jsonl_error(jsonl({{{"format", "other"}}, neutral_frame(0)}), "hand-frames");
  expect_jsonl_error(with("p", short_list), "line 3");
  expect_jsonl_error(with("p", short_list), "has 77 numbers; it must have 78");
  expect_jsonl_error(with_number("p", 4, nullptr), "must be a number");
  expect_jsonl_error(with_number("p", 4, "NaN"), "must be a number");
  expect_jsonl_error(with_number("p", 4, 1e200), "from -10 to 10");
  expect_jsonl_error(with_number("q", 3, 0.5), "has a quaternion of length 0.5");
  expect_jsonl_error(with_number("r", 1, 0.05), "has a radius of 50.0 mm at joint wrist");
  expect_jsonl_error(with_number("r", 1, 0.0), "radii must be from 3 to 40 mm");
  expect_jsonl_error(with_number("p", 3 * kIndexTip, 0.5),
                     "from index-distal to index-tip; bones must be from 8 to 120 mm");
  expect_jsonl_error(with("side", "left"), "must be \"L\" or \"R\"");
  expect_jsonl_error(with("conf", 1.5), "from 0 to 1");
  expect_jsonl_error(jsonl({neutral_header(), neutral_frame(1.0), neutral_frame(0.9)}),
                     "time must increase");
  expect_jsonl_error(jsonl({neutral_header(), neutral_frame(1.0), neutral_frame(1.0)}),
                     "time must increase");
  expect_jsonl_error(jsonl({neutral_header(), neutral_frame(1.0), neutral_frame(1e9)}),
                     "more than a day");
  const std::string whole = jsonl({neutral_header(), neutral_frame(0.0)});
  expect_jsonl_error(whole.substr(0, whole.size() - 100), "ends too early");
  json three = neutral_frame(0.0);
  three["hands"] = {neutral_hand(1, 0.1), neutral_hand(2, 0.2), neutral_hand(3, 0.3)};
  expect_jsonl_error(jsonl({neutral_header(), three}),
                     "is one of 3 hands of its frame; there must be at most 2");
  three["hands"] = {neutral_hand(1, 0.1), neutral_hand(1, 0.2)};
  expect_jsonl_error(jsonl({neutral_header(), three}), "ids must differ");
}

TEST(HandsJsonl, ANumberOutsideTheRangeOfDoublesIsAnError) {
  std::string text = jsonl({neutral_header(), neutral_frame(0.0)});
  text.replace(text.find("0.009"), 5, "1e999");
  // the standard library's conversion overflows, which the program's traps would treat as a fault
  fedisableexcept(FE_OVERFLOW);
  expect_jsonl_error(text, "out of range");
  feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(FE_OVERFLOW);
}

TEST(HandsJsonl, DeepNestingIsAnError) {
  expect_jsonl_error(jsonl({neutral_header()}) + std::string(1 << 20, '['), "nested deeper");
  const std::string text = std::string("{\"frames\":").append(1 << 20, '[');
  expect_error([&] { hands_from_leap_json(text, "x"); }, "nested deeper");
}

/// Returns a Leap frame with a right hand, palm down, as in old recordings: without carps, bases
/// and wrist.
json leap_frame(std::int64_t microseconds) {
  json pointables = json::array();
  for (int f = 0; f < 5; ++f) {
    const double x = -40.0 + 20.0 * f, z = f == 0 ? 40.0 : -30.0;
    const auto at = [&](double along) { return json{x, 200.0, z - along}; };
    pointables.push_back({{"id", 10 + f},
                          {"handId", 1},
                          {"type", f},
                          {"mcpPosition", at(0)},
                          {"pipPosition", at(40)},
                          {"dipPosition", at(65)},
                          {"tipPosition", at(82)},
                          {"width", 18.0}});
  }
  json hand = {{"id", 1},
               {"type", "right"},
               {"confidence", 0.9},
               {"palmPosition", {0, 200, 0}},
               {"palmNormal", {0, -1, 0}},
               {"direction", {0, 0, -1}}};
  return {{"timestamp", microseconds}, {"hands", {hand}}, {"pointables", pointables}};
}

json leap_recording() {
  return {{"metadata", {{"protocolVersion", 6}}},
          {"frames", {leap_frame(1000000), leap_frame(1010000)}}};
}

TEST(LeapJson, ReadsMillimetresAndMicrosecondsAndRebuildsMissingBones) {
  const HandRecording recording = hands_from_leap_json(leap_recording().dump(), "x");
  ASSERT_EQ(recording.frames.size(), 2u);
  EXPECT_NEAR(recording.frames[1].time, 0.01, 1e-12);
  const Hand& hand = recording.frames[0].hands.at(0);
  EXPECT_EQ(hand.inferred, 3u);
  EXPECT_EQ(hand.side, Side::Right);
  EXPECT_TRUE(hand.position[kIndexProximal].isApprox(Vec3(-0.020, 0.2, -0.03)));
  EXPECT_TRUE(hand.position[kThumbMetacarpal].isApprox(Vec3(-0.040, 0.2, 0.04)));
  // the rebuilt bases of the metacarpals lie between the knuckles and the wrist
  EXPECT_GT(hand.position[kIndexMetacarpal].z(), 0.03);
  EXPECT_GT(hand.position[kWrist].z(), hand.position[kIndexMetacarpal].z());
  EXPECT_NEAR(hand.radius[kIndexProximal], 0.009, 1e-12);
  for (int j = kThumbMetacarpal; j < kLittleTip; ++j) {
    if (j == kThumbTip || j == kIndexTip || j == kMiddleTip || j == kRingTip) continue;
    const auto n = static_cast<std::size_t>(j);
    const Vec3 bone = (hand.position[n + 1] - hand.position[n]).normalized();
    EXPECT_GT(bone.dot(hand.orientation[n] * Vec3(0, 0, -1)), 0.999);
  }
}

TEST(LeapJson, FindsTheSideWithoutATypeAndMirrorsLeftHands) {
  json right = leap_recording(), left = leap_recording();
  for (json& frame : right["frames"]) frame["hands"][0].erase("type");
  for (json& frame : left["frames"]) {
    frame["hands"][0].erase("type");
    for (json& finger : frame["pointables"]) {
      for (const char* key : {"mcpPosition", "pipPosition", "dipPosition", "tipPosition"}) {
        finger[key][0] = -finger[key][0].get<double>();
      }
    }
  }
  const Hand a = hands_from_leap_json(right.dump(), "x").frames[0].hands.at(0);
  const Hand b = hands_from_leap_json(left.dump(), "x").frames[0].hands.at(0);
  EXPECT_EQ(a.side, Side::Right);
  EXPECT_EQ(b.side, Side::Left);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_LT((a.position[j].cwiseProduct(Vec3(-1, 1, 1)) - b.position[j]).norm(), 1e-12);
    EXPECT_NEAR(b.orientation[j].norm(), 1.0, 1e-12);
  }
}

TEST(LeapJson, PackedFramesEqualPlainFrames) {
  // formatVersion 2 of LeapJS Playback: frames[0] names the members of the arrays in the others
  const json plain = leap_recording();
  const json fingers = {"id",          "handId",      "type",        "mcpPosition",
                        "pipPosition", "dipPosition", "tipPosition", "width"};
  const json hands = {"id", "type", "confidence", "palmPosition", "palmNormal", "direction"};
  json packed_frames = json::array();
  packed_frames.push_back(
      {"timestamp", {{"hands", json::array({hands})}}, {{"pointables", json::array({fingers})}}});
  for (const json& frame : plain["frames"]) {
    const auto rows = [&](const char* key, const json& names) {
      json list = json::array();
      for (const json& element : frame[key]) {
        json row = json::array();
        for (const json& name : names) row.push_back(element[name.get<std::string>()]);
        list.push_back(row);
      }
      return list;
    };
    packed_frames.push_back(
        {frame["timestamp"], rows("hands", hands), rows("pointables", fingers)});
  }
  const json packed = {{"metadata", {{"formatVersion", 2}}}, {"frames", packed_frames}};
  const HandRecording a = hands_from_leap_json(plain.dump(), "x"),
                      b = hands_from_leap_json(packed.dump(), "x");
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    EXPECT_EQ(a.frames[i].time, b.frames[i].time);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      EXPECT_EQ(a.frames[i].hands[0].position[j], b.frames[i].hands[0].position[j]);
    }
  }
  json ragged = packed;
  ragged["frames"][2].erase(0);
  expect_leap_error(ragged, "the packing structure in frames[0] names 3");
}

TEST(LeapJson, ReportsErrorsWithTheirPosition) {
  const auto with = [](const char* path, const json& value) {
    json document = leap_recording();
    document[json::json_pointer(path)] = value;
    return document;
  };
  expect_error([] { hands_from_leap_json(" ", "x.json"); }, "is empty");
  expect_leap_error({{"metadata", 1}}, "frames");
  expect_leap_error({{"frames", json::array()}}, "holds 0 frames");
  expect_leap_error(with("/frames/1/timestamp", 999), "frames[1]");
  expect_leap_error(with("/frames/1/timestamp", 999), "time must increase");
  expect_leap_error(with("/frames/1/timestamp", "soon"), "must be a number");
  expect_leap_error(with("/frames/0/pointables/2/mcpPosition", {1, 2}), "it must have 3");
  expect_leap_error(with("/frames/0/pointables/2/mcpPosition", {1, 2, nullptr}),
                    "must be a number");
  expect_leap_error(with("/frames/0/pointables/2/type", 1), "has no finger of type 2");
  expect_leap_error(with("/frames/0/pointables/2/handId", 7), "has no finger of type 2");
  expect_leap_error(with("/frames/0/pointables/2/tipPosition", {0, 400, 0}),
                    "bones must be from 8 to 120 mm");
  expect_leap_error(with("/frames/0/hands/0/palmNormal", {0, -0.5, 0}), "it must be 1 within 0.01");
  expect_leap_error(with("/frames/0/hands/0/palmNormal", {0, 0, 1}), "parallel axes");
  expect_leap_error(with("/frames/0/hands/0/type", "both"), "must be \"left\" or \"right\"");
}

TEST(HandFile, DetectsTheFormatFromTheContent) {
  const test::TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    write_file(folder.file("a"), text);
    return read_hand_recording(folder.file("a"));
  };
  EXPECT_EQ(read(jsonl({neutral_header(), neutral_frame(0.0)})).frames.size(), 1u);
  EXPECT_EQ(read(leap_recording().dump(1)).frames.size(), 2u);
  EXPECT_THROW(read_hand_recording(folder.file("none")), InputError);
  for (const char* other : {"\x89HDF\r\n\x1a\n[[[[[", "1 2 3", "   "}) {
    EXPECT_THAT(test::input_error([&] { read(other); }),
                testing::HasSubstr("a hand recording is hand-frames JSON Lines"));
  }
  EXPECT_THAT(test::input_error([&] { read("\x89HDF\r\n\x1a\n"); }),
              testing::HasSubstr("is a recording of prostm (HDF5), not a hand recording"));
}

struct Difference {
  double position = 0, radius = 0, time = 0, angle = 0, thumb_angle = 0;
};

Difference difference(const HandRecording& a, const HandRecording& b) {
  Difference d;
  EXPECT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < std::min(a.frames.size(), b.frames.size()); ++i) {
    d.time = std::max(d.time, std::abs(a.frames[i].time - b.frames[i].time));
    EXPECT_EQ(a.frames[i].hands.size(), b.frames[i].hands.size());
    for (std::size_t h = 0; h < std::min(a.frames[i].hands.size(), b.frames[i].hands.size()); ++h) {
      const Hand &x = a.frames[i].hands[h], &y = b.frames[i].hands[h];
      EXPECT_EQ(x.id, y.id);
      EXPECT_EQ(x.side, y.side);
      for (std::size_t j = 0; j < kJointCount; ++j) {
        d.position = std::max(d.position, (x.position[j] - y.position[j]).norm());
        d.radius = std::max(d.radius, std::abs(x.radius[j] - y.radius[j]));
        double& angle = j >= kThumbMetacarpal && j <= kThumbTip ? d.thumb_angle : d.angle;
        angle =
            std::max(angle, x.orientation[j].angularDistance(y.orientation[j]) * 180 / 3.14159265);
      }
    }
  }
  return d;
}

TEST(HandFile, LeapRecordingsAgreeWithTheirNeutralConversions) {
  for (const char* name : {"flapping", "finger-tap-54fps"}) {
    const std::string leap = std::string("data/leap/") + name + ".json";
    const std::string neutral = std::string("data/hands/") + name + ".hands.jsonl";
    PROSTM_NEEDS_SHARED(leap);
    PROSTM_NEEDS_SHARED(neutral);
    const Difference d = difference(read_hand_recording(test::shared_file(leap)),
                                    read_hand_recording(test::shared_file(neutral)));
    EXPECT_LT(d.position, 1e-5);
    EXPECT_LT(d.radius, 1e-4);
    EXPECT_LT(d.time, 1e-9);
    // the converter of the other file transferred the orientations by a coarser rule
    if (std::string(name) == "finger-tap-54fps") {
      EXPECT_LT(std::max(d.angle, d.thumb_angle), 0.01);
    }
  }
}

TEST(HandFile, StrippedBonesOfAFullRecordingAreRebuilt) {
  PROSTM_NEEDS_SHARED("data/leap/finger-tap-54fps.json");
  const std::string text = read_file(test::shared_file("data/leap/finger-tap-54fps.json"));
  json document = json::parse(text);
  for (json& frame : document["frames"]) {
    for (json& hand : frame["hands"]) hand.erase("wrist");
    for (json& finger : frame["pointables"]) {
      finger.erase("carpPosition");
      finger.erase("bases");
    }
  }
  const HandRecording rebuilt = hands_from_leap_json(document.dump(), "stripped");
  EXPECT_EQ(rebuilt.frames[0].hands[0].inferred, 3u);
  const Difference d = difference(rebuilt, hands_from_leap_json(text, "full"));
  EXPECT_LT(d.position, 1e-5);
  EXPECT_LT(d.angle, 0.05);
  EXPECT_LT(d.thumb_angle, 0.05);
}

TEST(HandFile, MissingBonesAreRebuiltFromTheTemplate) {
  // this recording has metacarpals, and the template was not measured on it
  PROSTM_NEEDS_SHARED("data/hands/pinch-57fps.hands.jsonl");
  const HandRecording recorded =
      read_hand_recording(test::shared_file("data/hands/pinch-57fps.hands.jsonl"));
  json frames = json::array();
  const auto mm = [](const Vec3& p) { return json{1e3 * p.x(), 1e3 * p.y(), 1e3 * p.z()}; };
  for (const HandFrame& frame : recorded.frames) {
    const Hand& hand = frame.hands.at(0);
    // the file lacks the palm's position, which follows from the middle finger's knuckle
    const Eigen::Matrix3d R_TP = hand.orientation[kWrist].toRotationMatrix();
    const double span = (hand.position[kLittleProximal] - hand.position[kIndexProximal]).norm();
    const Vec3 palm =
        hand.position[kMiddleProximal] - span * (R_TP * Vec3(-0.0464245, 0.0665875, -0.3870754));
    json pointables = json::array();
    for (int f = 0; f < 5; ++f) {
      const auto first =
          static_cast<std::size_t>(f == 0 ? kThumbMetacarpal : kIndexProximal + 5 * (f - 1));
      pointables.push_back({{"handId", hand.id},
                            {"type", f},
                            {"mcpPosition", mm(hand.position[first])},
                            {"pipPosition", mm(hand.position[first + 1])},
                            {"dipPosition", mm(hand.position[first + 2])},
                            {"btipPosition", mm(hand.position[first + 3])}});
    }
    const Vec3 normal = -R_TP.col(1), direction = -R_TP.col(2);
    frames.push_back({{"timestamp", std::llround(frame.time * 1e6)},
                      {"pointables", pointables},
                      {"hands",
                       {{{"id", hand.id},
                         {"palmPosition", mm(palm)},
                         {"palmNormal", {normal.x(), normal.y(), normal.z()}},
                         {"direction", {direction.x(), direction.y(), direction.z()}}}}}});
  }
  const json document = {{"frames", frames}};
  const HandRecording rebuilt = hands_from_leap_json(document.dump(), "rebuilt");
  const Difference d = difference(rebuilt, recorded);
  EXPECT_LT(d.position, 1e-5);
  EXPECT_LT(d.angle, 0.05);
  EXPECT_LT(d.thumb_angle, 0.05);
}

}  // namespace
}  // namespace prostm
