/// Faults in hand recordings: what each of them discards, and how bad files are reported.

#include <gmock/gmock.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "../track/leap_json.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "support/input_errors.hpp"
#include "support/load.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr std::size_t kFrames = 6;
constexpr double kStep = 9e-3;  // [s]

/// Returns frames of a moving right hand, or of a left and a right one.
std::vector<HandFrame> moving_hands(std::size_t hands) {
  std::vector<HandFrame> frames;
  for (std::size_t f = 0; f < kFrames; ++f) {
    HandFrame frame;
    for (std::size_t h = 0; h < hands; ++h) {
      HandFrame one;
      make_study_hand({.side = h == 0 ? Side::Right : Side::Left})->sample(0.0, one);
      Hand hand = one.hands.at(0);
      hand.id = 7 + static_cast<int>(h);
      const Vec3 shift(1e-3 * static_cast<double>(f) - 0.18 * static_cast<double>(h), 0.0, 0.0);
      for (Vec3& p : hand.position) p += shift;
      frame.hands.push_back(hand);
    }
    frame.time = 5.0 + kStep * static_cast<double>(f);
    frames.push_back(frame);
  }
  return frames;
}

json neutral(const Hand& hand) {
  json p, q, r;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (const double x : hand.position[j]) p.push_back(x);
    for (const double x : hand.orientation[j].coeffs()) q.push_back(x);
    r.push_back(hand.radius[j]);
  }
  return {{"id", hand.id},
          {"side", hand.side == Side::Right ? "R" : "L"},
          {"p", p},
          {"q", q},
          {"r", r}};
}

/// A recording as a list of frames, each a JSON value.
struct Document {
  bool leap = false;
  std::vector<json> frames;

  const char* stamp() const { return leap ? "timestamp" : "t"; }
  HandRecording read() const {
    std::string text = leap ? "{\"serviceVersion\":\"2.3.1\",\"version\":6}\n"
                            : "{\"format\":\"hand-frames\",\"version\":1,\"units\":\"m\"}\n";
    for (const json& frame : frames) text += frame.dump() + '\n';
    return leap ? hands_from_leap_json(text, "x") : hands_from_jsonl(text, "x");
  }
};

Document document_of(bool leap, std::size_t hands) {
  Document out{leap, {}};
  for (const HandFrame& frame : moving_hands(hands)) {
    json one = {{"t", frame.time}, {"hands", json::array()}};
    if (leap) {
      one = test::leap_json(frame);
      for (json& finger : one["pointables"]) finger.erase("bases");
    } else {
      for (const Hand& hand : frame.hands) one["hands"].push_back(neutral(hand));
    }
    out.frames.push_back(one);
  }
  return out;
}

/// A fault in a frame, or in hand `h` of it.
struct Fault {
  HandFault cause;
  std::function<void(Document&, std::size_t f, std::size_t h, std::mt19937&)> make;
};

std::size_t any(std::mt19937& random, std::size_t count) {
  return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
}
json nonsense(std::mt19937& random) {
  const json values[] = {nullptr, "x", true, json::object()};
  return values[any(random, 4)];
}
json& hand_of(Document& d, std::size_t f, std::size_t h) {
  return d.frames[f]["hands"][h];
}
json& finger_of(Document& d, std::size_t f, std::size_t h, std::mt19937& random) {
  return d.frames[f]["pointables"][5 * h + any(random, 5)];
}

std::vector<Fault> faults_of_frames() {
  using enum HandFault;
  return {
      {Time, [](auto& d, auto f, auto, auto& r) { d.frames[f][d.stamp()] = nonsense(r); }},
      {Time, [](auto& d, auto f, auto, auto&) { d.frames[f].erase(d.stamp()); }},
      {Unreadable, [](auto& d, auto f, auto, auto& r) { d.frames[f]["hands"] = nonsense(r); }},
      {Unreadable, [](auto& d, auto f, auto, auto&) { d.frames[f].erase("hands"); }},
      {Unreadable, [](auto& d, auto f, auto, auto&) { d.frames[f] = "x"; }},
      {Order,
       [](auto& d, auto f, auto, auto&) {
         const auto from = f > 0 ? f - 1 : f + 1;
         d.frames[f][d.stamp()] = d.frames[from][d.stamp()];
       }},
      {Order,
       [](auto& d, auto f, auto, auto&) {
         d.frames[f][d.stamp()] = d.frames[f][d.stamp()].template get<double>() * 1e3;
       }},
      {Order, [](auto& d, auto f, auto, auto&) { d.frames[f][d.stamp()] = 0.0; }},
  };
}

std::vector<Fault> faults_of_neutral_hands() {
  using enum HandFault;
  return {
      {Member, [](auto& d, auto f, auto h, auto& r) { hand_of(d, f, h) = nonsense(r); }},
      {Member,
       [](auto& d, auto f, auto h, auto& r) {
         const char* keys[] = {"id", "side", "p", "q", "r"};
         hand_of(d, f, h).erase(keys[any(r, 5)]);
       }},
      {Member,
       [](auto& d, auto f, auto h, auto& r) { hand_of(d, f, h)["p"][any(r, 78)] = nonsense(r); }},
      {Member, [](auto& d, auto f, auto h, auto& r) { hand_of(d, f, h)["p"][any(r, 78)] = 11.0; }},
      {Member, [](auto& d, auto f, auto h, auto&) { hand_of(d, f, h)["q"].erase(5); }},
      {Bones,
       [](auto& d, auto f, auto h, auto& r) {
         json& x = hand_of(d, f, h)["p"][any(r, 78)];
         x = x.template get<double>() + 0.3;
       }},
      {Bones, [](auto& d, auto f, auto h, auto& r) { hand_of(d, f, h)["r"][any(r, 26)] = 0.05; }},
      {Axes,
       [](auto& d, auto f, auto h, auto& r) {
         const auto joint = any(r, 26);
         for (std::size_t i = 0; i < 4; ++i) hand_of(d, f, h)["q"][4 * joint + i] = 0.0;
       }},
      {Side,
       [](auto& d, auto f, auto h, auto&) {
         json& side = hand_of(d, f, h)["side"];
         side = side == "R" ? "L" : "R";
       }},
  };
}

std::vector<Fault> faults_of_leap_hands() {
  using enum HandFault;
  return {
      {Member, [](auto& d, auto f, auto h, auto& r) { hand_of(d, f, h) = nonsense(r); }},
      {Member, [](auto& d, auto f, auto h, auto&) { hand_of(d, f, h).erase("direction"); }},
      {Member,
       [](auto& d, auto f, auto h, auto&) {
         hand_of(d, f, h)["palmPosition"] = {0, 2000, 0};
       }},
      {Member,
       [](auto& d, auto f, auto h, auto& r) {
         const char* keys[] = {"mcpPosition", "pipPosition", "dipPosition", "btipPosition"};
         finger_of(d, f, h, r)[keys[any(r, 4)]] = {0, nullptr, 0};
       }},
      {Bones,
       [](auto& d, auto f, auto h, auto& r) {
         const char* keys[] = {"mcpPosition", "pipPosition", "dipPosition", "btipPosition"};
         json& y = finger_of(d, f, h, r)[keys[any(r, 4)]][1];
         y = y.template get<double>() + 300.0;
       }},
      {Fingers, [](auto& d, auto f, auto h, auto& r) { finger_of(d, f, h, r) = nonsense(r); }},
      {Fingers,
       [](auto& d, auto f, auto h, auto& r) {
         json& type = finger_of(d, f, h, r)["type"];
         type = (type.template get<int>() + 1) % 5;
       }},
      {Fingers,
       [](auto& d, auto f, auto h, auto& r) { finger_of(d, f, h, r)["handId"] = h == 0 ? 8 : 7; }},
      {Axes,
       [](auto& d, auto f, auto h, auto&) {
         hand_of(d, f, h)["palmNormal"] = {0, 0, 0};
       }},
      {Side,
       [](auto& d, auto f, auto h, auto&) {
         json& side = hand_of(d, f, h)["type"];
         side = side == "right" ? "left" : "right";
       }},
  };
}

/// Checks that a recording equals the good one without frame `f`, or without hand `h` of it.
void expect_rest(const HandRecording& got, const HandRecording& good, std::size_t f,
                 std::optional<std::size_t> h) {
  ASSERT_EQ(got.frames.size(), good.frames.size() - (h ? 0 : 1));
  const double start = !h && f == 0 ? good.frames[1].time : 0.0;
  for (std::size_t i = 0; i < got.frames.size(); ++i) {
    const std::size_t k = !h && i >= f ? i + 1 : i;
    HandFrame expected = good.frames[k];
    if (h && k == f) expected.hands.erase(expected.hands.begin() + static_cast<std::ptrdiff_t>(*h));
    ASSERT_NEAR(got.frames[i].time, expected.time - start, 1e-9);
    ASSERT_EQ(got.frames[i].hands.size(), expected.hands.size());
    for (std::size_t n = 0; n < expected.hands.size(); ++n) {
      const Hand &a = got.frames[i].hands[n], &b = expected.hands[n];
      ASSERT_EQ(a.id, b.id);
      ASSERT_EQ(a.side, b.side);
      ASSERT_EQ(a.position, b.position);
      ASSERT_EQ(a.radius, b.radius);
    }
  }
}

TEST(HandFaults, ASingleFaultDiscardsItsHandOrItsFrame) {
  std::mt19937 random(1);
  const std::vector<Fault> of_frames = faults_of_frames(), of_neutral = faults_of_neutral_hands(),
                           of_leap = faults_of_leap_hands();
  for (const bool leap : {false, true}) {
    for (const std::size_t hands : {1u, 2u}) {
      const Document good = document_of(leap, hands);
      const HandRecording expected = good.read();
      ASSERT_FALSE(expected.reading.faults.any()) << expected.reading.faults.first;
      for (std::uint64_t n = 0; n < test::reduced(2500); ++n) {
        const std::vector<Fault>& of_hands = leap ? of_leap : of_neutral;
        const std::size_t kind = any(random, of_frames.size() + of_hands.size());
        const bool frame = kind < of_frames.size();
        const Fault& fault = frame ? of_frames[kind] : of_hands[kind - of_frames.size()];
        const std::size_t f = any(random, kFrames), h = any(random, hands);
        Document bad = good;
        fault.make(bad, f, h, random);
        SCOPED_TRACE(testing::Message()
                     << (leap ? "leap " : "neutral ") << hands << " hands, frame " << f << ", hand "
                     << h << ", " << kind << ": " << bad.frames[f].dump().substr(0, 300));
        const HandRecording got = bad.read();
        const HandFaults& faults = got.reading.faults;
        ASSERT_EQ(faults.count[static_cast<std::size_t>(fault.cause)], 1) << causes_of(faults);
        ASSERT_EQ(faults.frames() + faults.hands(), 1);
        expect_rest(got, expected, f, frame ? std::nullopt : std::optional(h));
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(HandFaults, MoreThanAQuarterOfBadFramesIsRejected) {
  Document two = document_of(false, 1);
  two.frames[1]["t"] = two.frames[2]["hands"] = nullptr;
  EXPECT_THAT(test::input_error([&] { two.read(); }),
              HasSubstr("dropped: 2 of 6 frames and 0 of 4 hands, for 1 unreadable, 1 time"));
}

TEST(HandFaults, ImplausibleUnitsAreReported) {
  const auto error = [](bool leap, double time, double length) {
    Document d = document_of(leap, 1);
    for (json& frame : d.frames) {
      frame[d.stamp()] = frame[d.stamp()].get<double>() * time;
      if (leap) {
        for (json& finger : frame["pointables"]) {
          for (const char* key :
               {"carpPosition", "mcpPosition", "pipPosition", "dipPosition", "btipPosition"}) {
            for (json& x : finger[key]) x = x.get<double>() * length;
          }
        }
      } else {
        for (json& x : frame["hands"][0]["p"]) x = x.get<double>() * length;
      }
    }
    return test::input_error([&] { d.read(); });
  };
  EXPECT_THAT(error(true, 1e-3, 1.0),
              HasSubstr("seem to be in milliseconds; they must be in micro"));
  EXPECT_THAT(error(true, 1e-6, 1.0), HasSubstr("seem to be in seconds"));
  EXPECT_THAT(error(true, 1e3, 1.0), HasSubstr("seem to be in nanoseconds"));
  EXPECT_THAT(error(false, 1e3, 1.0),
              HasSubstr("seem to be in milliseconds; they must be in seconds"));
  EXPECT_THAT(error(true, 1.0, 1e-3), HasSubstr("positions seem to be in metres"));
  EXPECT_THAT(error(false, 1.0, 1e3), HasSubstr("positions seem to be in millimetres"));
}

TEST(HandFaults, MicrosecondsSince1970AreAccepted) {
  Document d = document_of(true, 1);
  for (json& frame : d.frames)
    frame["timestamp"] = frame["timestamp"].get<std::int64_t>() + 1'700'000'000'000'000;
  EXPECT_NEAR(d.read().frames.back().time, kStep * (kFrames - 1), 1e-6);
}

TEST(HandFaults, OtherConventionsAreReported) {
  using Change = std::function<void(json & hand)>;
  const auto error = [](const Change& change) {
    Document d = document_of(false, 1);
    // a tilted hand, since a level one looks the same in some conventions
    const Quat turn(Eigen::AngleAxisd(0.5, Vec3(1.0, 2.0, 0.5).normalized()));
    for (json& frame : d.frames) {
      json& hand = frame["hands"][0];
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto x = [&](const char* key, std::size_t i) { return hand[key][i].get<double>(); };
        const Vec3 p = turn * Vec3(x("p", 3 * j), x("p", 3 * j + 1), x("p", 3 * j + 2));
        const Quat q =
            turn * Quat(x("q", 4 * j + 3), x("q", 4 * j), x("q", 4 * j + 1), x("q", 4 * j + 2));
        for (std::size_t a = 0; a < 3; ++a) hand["p"][3 * j + a] = p[static_cast<int>(a)];
        for (std::size_t a = 0; a < 4; ++a) hand["q"][4 * j + a] = q.coeffs()[static_cast<int>(a)];
      }
      change(hand);
    }
    return test::input_error([&] { d.read(); });
  };
  const auto flip = [](json& hand, const char* key, std::size_t size, std::size_t axis) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      json& x = hand[key][size * j + axis];
      x = -x.get<double>();
    }
  };
  EXPECT_THAT(error([](json& hand) {
                for (std::size_t j = 0; j < kJointCount; ++j) {
                  json& q = hand["q"];
                  const json w = q[4 * j + 3];
                  for (std::size_t a = 3; a > 0; --a) q[4 * j + a] = q[4 * j + a - 1];
                  q[4 * j] = w;
                }
              }),
              HasSubstr("quaternions in the order w, x, y, z"));
  EXPECT_THAT(error([&](json& hand) {
                flip(hand, "p", 3, 2);
                flip(hand, "q", 4, 0);
                flip(hand, "q", 4, 1);
              }),
              HasSubstr("mirrored in z, as in Unity"));
  EXPECT_THAT(error([](json& hand) { hand["side"] = "L"; }),
              HasSubstr("left and right seem exchanged"));
  EXPECT_THAT(error([](json& hand) {
                for (std::size_t j = 0; j < kJointCount; ++j) {
                  std::swap(hand["p"][3 * j + 1], hand["p"][3 * j + 2]);
                  std::swap(hand["q"][4 * j + 1], hand["q"][4 * j + 2]);
                  json& w = hand["q"][4 * j + 3];
                  w = -w.get<double>();
                }
              }),
              HasSubstr("given with y and z exchanged"));
}

TEST(HandFaults, LeapFramesMayBeListsOrLinesWithAByteOrderMark) {
  const Document d = document_of(true, 2);
  json lists = json::array({json::array({{{"version", 6}}})}), frames = json::array();
  for (const json& frame : d.frames) {
    lists.push_back(json::array({frame}));
    frames.push_back(frame);
  }
  const std::string mark = "\xEF\xBB\xBF";
  const json object = {{"frames", lists}};
  const HandRecording expected = d.read();
  for (const std::string& text : {lists.dump(), frames.dump(), object.dump(2), mark + frames.dump(),
                                  mark + json{{"frames", frames}}.dump()}) {
    const HandRecording got = hands_from_leap_json(text, "x");
    ASSERT_EQ(got.frames.size(), expected.frames.size());
    EXPECT_FALSE(got.reading.faults.any()) << got.reading.faults.first;
    EXPECT_EQ(got.frames[2].hands.at(1).position, expected.frames[2].hands.at(1).position);
  }
}

TEST(HandFaults, FingerTypesFollowFromTheirIds) {
  Document d = document_of(true, 2);
  for (json& frame : d.frames) {
    for (json& finger : frame["pointables"]) finger.erase("type");
  }
  EXPECT_FALSE(d.read().reading.faults.any()) << d.read().reading.faults.first;
}

TEST(HandFaults, RecordingsOfOtherProgramsAreRead) {
  const auto read = [](const std::string& name) {
    return read_hand_recording(test::shared_file("data/found/" + name + ".json")).reading;
  };
  PROSTM_NEEDS_SHARED("data/found/bom.json");
  for (const char* name :
       {"bom", "fist-beside-flat-hand", "frames-in-lists", "packed-without-type", "socket"}) {
    EXPECT_FALSE(read(name).faults.any()) << name << ": " << read(name).faults.first;
  }
  EXPECT_EQ(causes_of(read("same-time-twice").faults), "1 order");
  EXPECT_EQ(causes_of(read("third-hand-in-one-frame").faults), "1 third");
  EXPECT_THAT(test::input_error([&] { read("time-in-ms"); }), HasSubstr("in milliseconds"));
}

}  // namespace
}  // namespace prostm
