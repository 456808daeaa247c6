#include "prostm/track/live/leap_client.hpp"

#include <nlohmann/json.hpp>

#include "leap_json.hpp"
#include "leap_server.hpp"
#include "prostm/core/file/file.hpp"
#include "prostm/io/hand/hand_file.hpp"
#include "support/eventually.hpp"
#include "support/input_errors.hpp"
#include "support/shared.hpp"

namespace prostm {
namespace {

using nlohmann::json;
using test::eventually;
using test::LeapServer;

/// Returns frames of the scripted hand at 110 Hz, from 5 s on, while it is visible.
std::vector<HandFrame> scripted_frames(int count) {
  const auto source = make_scripted_hand({}, {});
  std::vector<HandFrame> frames(static_cast<std::size_t>(count));
  double time = 5.0;
  for (HandFrame& frame : frames) {
    source->sample(time, frame);
    frame.time = time - 5.0;
    time += 1.0 / 110.0;
  }
  return frames;
}

std::vector<LeapServer::Message> messages_of(const std::vector<HandFrame>& frames) {
  std::vector<LeapServer::Message> messages;
  for (const HandFrame& frame : frames)
    messages.push_back({frame.time, test::leap_json(frame).dump()});
  return messages;
}

HostPort address_of(const LeapServer& server) {
  return {"127.0.0.1", server.port()};
}

/// Receives the next `count` frames of a tracker, or fewer if they do not arrive.
std::vector<HandFrame> receive(LiveTracker& tracker, std::size_t count) {
  std::vector<HandFrame> frames;
  HandFrame frame;
  eventually([&] {
    while (tracker.next(frame)) frames.push_back(frame);
    return frames.size() >= count;
  });
  return frames;
}

void expect_same_hands(const std::vector<HandFrame>& received,
                       const std::vector<HandFrame>& expected) {
  ASSERT_EQ(received.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(received[i].hands.size(), expected[i].hands.size()) << "frame " << i;
    for (std::size_t h = 0; h < expected[i].hands.size(); ++h) {
      const Hand &a = received[i].hands[h], &b = expected[i].hands[h];
      EXPECT_EQ(a.id, b.id);
      EXPECT_EQ(a.side, b.side);
      for (std::size_t j = 0; j < kJointCount; ++j) {
        ASSERT_LT((a.position[j] - b.position[j]).norm(), 1e-4)
            << "frame " << i << ", " << joint_name(static_cast<int>(j));
      }
    }
  }
}

TEST(LeapClient, EveryFrameOfARecordingArrives) {
  for (const char* name : {"flapping", "finger-tap-54fps"}) {
    const std::string leap = std::string("data/leap/") + name + ".json";
    const std::string neutral = std::string("data/hands/") + name + ".hands.jsonl";
    PROSTM_NEEDS_SHARED(leap);
    PROSTM_NEEDS_SHARED(neutral);
    const json document = json::parse(read_file(test::shared_file(leap)));
    std::vector<LeapServer::Message> messages;
    double first = 0.0;
    for (const json& frame : document["frames"]) {
      const double time = 1e-6 * frame["timestamp"].get<double>();
      if (messages.empty()) first = time;
      messages.push_back({time - first, frame.dump()});
    }
    LeapServer server(messages);
    const auto tracker = make_leap_tracker(address_of(server));
    const auto received = receive(*tracker, messages.size());
    const HandRecording recording = read_hand_recording(test::shared_file(neutral));
    expect_same_hands(received, recording.frames);
    for (std::size_t i = 1; i < received.size(); ++i)
      EXPECT_GT(received[i].time, received[i - 1].time);
    const TrackerStatus status = tracker->status();
    EXPECT_EQ(status.frames, static_cast<std::int64_t>(messages.size()));
    EXPECT_EQ(status.dropped, 0);
    EXPECT_TRUE(status.connected);
  }
}

TEST(LeapClient, EveryGeneratedFrameArrivesAndTheServiceGetsItsRequests) {
  const std::vector<HandFrame> frames = scripted_frames(60);
  LeapServer server(messages_of(frames));
  const auto tracker = make_leap_tracker(address_of(server));
  expect_same_hands(receive(*tracker, frames.size()), frames);
  const std::vector<std::string> said = server.requests(3);
  EXPECT_THAT(said, testing::ElementsAre(R"({"background":true})", R"({"focused":true})",
                                         R"({"optimizeHMD":false})"));
  for (const std::string& text : said) EXPECT_LT(text.size(), 32u) << "the bridge's buffer";
  EXPECT_THAT(tracker->status().sentence, testing::HasSubstr("connected to leap://127.0.0.1:"));
}

TEST(LeapClient, ReconnectsAndHasNoHandMeanwhile) {
  auto server = std::make_unique<LeapServer>(messages_of(scripted_frames(110)), true);
  const auto hands = make_live_hand(make_leap_tracker(address_of(*server)), {});
  HandFrame frame;
  const auto has_hand = [&] {
    hands->sample(1.0, frame);
    return !frame.hands.empty();
  };
  ASSERT_TRUE(eventually(has_hand));
  EXPECT_EQ(frame.time, 1.0);
  EXPECT_GE(frame.age, 0.0);
  EXPECT_LE(frame.age, TrackSettings().max_gap + 1e-9);
  server->cut();
  ASSERT_TRUE(eventually([&] { return hands->tracker_status()->reconnects == 1; }));
  ASSERT_TRUE(eventually(has_hand));
  EXPECT_TRUE(hands->tracker_status()->connected);

  server.reset();
  ASSERT_TRUE(eventually([&] { return !has_hand(); }));
  ASSERT_TRUE(eventually([&] { return !hands->tracker_status()->connected; }));
}

TEST(LeapClient, WithoutAConnectionThereIsNoHand) {
  auto server = std::make_unique<LeapServer>(messages_of(scripted_frames(110)), true);
  const auto hands = make_live_hand(make_leap_tracker(address_of(*server)), {});
  HandFrame frame;
  ASSERT_TRUE(eventually([&] {
    hands->sample(0.0, frame);
    return !frame.hands.empty();
  }));
  server.reset();
  ASSERT_TRUE(eventually([&] {
    hands->sample(0.0, frame);
    return !hands->tracker_status()->connected;
  }));
  hands->sample(0.0, frame);
  EXPECT_TRUE(frame.hands.empty())
      << "although the last frame is not " << TrackSettings().max_gap << " s old";
}

/// A service that plays its script for a moment and then hangs in one of several ways.
struct Stuck {
  const char* name;
  bool new_ids, time_goes_on;
};
class StuckLeap : public testing::TestWithParam<Stuck> {};
INSTANTIATE_TEST_SUITE_P(LeapClient, StuckLeap,
                         testing::Values(Stuck{"one_frame", false, false},
                                         Stuck{"new_ids", true, false},
                                         Stuck{"time_goes_on", false, true},
                                         Stuck{"new_ids_and_time", true, true}),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST_P(StuckLeap, HasNoHandAfterAMomentAndExplainsWhy) {
  const Stuck& kind = GetParam();
  std::vector<HandFrame> frames = scripted_frames(20);
  std::vector<LeapServer::Message> messages = messages_of(frames);
  HandFrame stuck = frames.back();
  for (double time = stuck.time; messages.size() < 150;) {
    time += 0.01;
    if (kind.time_goes_on) stuck.time = time;
    if (kind.new_ids) ++stuck.hands[0].id;
    messages.push_back({time, test::leap_json(stuck).dump()});
  }
  LeapServer server(messages);
  TrackSettings settings;
  settings.freeze_time = 0.2;
  const auto hands = make_live_hand(make_leap_tracker(address_of(server)), settings);
  HandFrame frame;
  const auto count = [&] {
    hands->sample(0.0, frame);
    return frame.hands.size();
  };
  const auto all = [&] {
    return hands->tracker_status()->frames == static_cast<std::int64_t>(messages.size());
  };
  ASSERT_TRUE(eventually([&] { return count() == 1; }));
  // hangs from then on
  bool gone = false, came_back = false;
  ASSERT_TRUE(eventually([&] {
    const bool there = count() == 1;
    came_back = came_back || (gone && there);
    gone = gone || (!there && hands->tracker_status()->frames > 75);
    return all();
  }));
  EXPECT_TRUE(gone);
  EXPECT_FALSE(came_back);
  const TrackerStatus status = *hands->tracker_status();
  EXPECT_TRUE(status.connected);
  EXPECT_EQ(status.dropped, 0);
  if (kind.time_goes_on) {
    EXPECT_EQ(status.repeated, 0);
    EXPECT_GT(status.frozen, 50);
    EXPECT_THAT(status.sentence, testing::HasSubstr("has not moved at all for 0.2 s"));
  } else {
    EXPECT_EQ(status.repeated, 130);
    EXPECT_EQ(status.frozen, 0);
    EXPECT_THAT(status.sentence, testing::HasSubstr("130 frames were ignored"));
  }
}

TEST(LeapClient, HandsComeAndGo) {
  std::vector<HandFrame> frames = scripted_frames(110);
  for (std::size_t i = 50; i < 100; ++i) frames[i].hands.clear();
  LeapServer server(messages_of(frames), true);
  const auto hands = make_live_hand(make_leap_tracker(address_of(server)), {});
  HandFrame frame;
  for (const std::size_t there : {1u, 0u, 1u, 0u}) {
    ASSERT_TRUE(eventually([&] {
      hands->sample(0.0, frame);
      return frame.hands.size() == there;
    }));
  }
  EXPECT_EQ(hands->tracker_status()->dropped, 0);
}

TEST(LeapClient, BadFramesAreDroppedAndCounted) {
  const std::vector<HandFrame> frames = scripted_frames(20);
  const json good = test::leap_json(frames[0]);
  const auto with = [&](const char* path, const json& value) {
    json bad = good;
    bad[json::json_pointer(path)] = value;
    return bad.dump();
  };
  json without_finger = good, without_time = good;
  without_finger["pointables"].erase(2);
  without_time.erase("timestamp");
  const std::vector<std::string> bad_frames = {"undefined", "", "[]", good.dump().substr(0, 400),
                                               without_time.dump()};
  const std::vector<std::string> bad_hands = {without_finger.dump(),
                                              with("/hands/0/palmPosition", {0, 1e9, 0}),
                                              with("/hands/0/palmPosition", {0, nullptr, 0}),
                                              with("/hands/0/id", "one"),
                                              with("/pointables/1/btipPosition", {0, 900, 0}),
                                              with("/hands", {good["hands"][0], good["hands"][0]})};
  std::vector<LeapServer::Message> messages = {
      {0.0, R"({"event":{"type":"deviceEvent","state":{"attached":true,"streaming":true}}})"}};
  for (const std::string& text : bad_frames) messages.push_back({0.0, text});
  for (const std::string& text : bad_hands) messages.push_back({0.0, text});
  for (const LeapServer::Message& message : messages_of(frames)) messages.push_back(message);
  LeapServer server(messages);
  const auto tracker = make_leap_tracker(address_of(server));
  // the first of the frames without their hand has the common time; the others repeat it
  std::vector<HandFrame> received = receive(*tracker, frames.size());
  received.erase(received.begin());
  expect_same_hands(received, {frames.begin() + 1, frames.end()});
  const TrackerStatus status = tracker->status();
  EXPECT_EQ(status.dropped, static_cast<std::int64_t>(bad_frames.size()));
  EXPECT_EQ(status.dropped_hands, static_cast<std::int64_t>(bad_hands.size()));
  EXPECT_EQ(status.faults[static_cast<std::size_t>(HandFault::Fingers)], 1);
  EXPECT_EQ(status.faults[static_cast<std::size_t>(HandFault::Twice)], 1);
  EXPECT_EQ(status.frames,
            static_cast<std::int64_t>(bad_frames.size() + bad_hands.size() + frames.size()));
  EXPECT_TRUE(status.connected);
  EXPECT_THAT(status.sentence, testing::HasSubstr("of another hand"));
}

TEST(LeapClient, ReportsThatNothingOrAnotherServerAnswers) {
  std::uint16_t free_port = 0;
  {
    LeapServer server({}, false, "/other.json");
    free_port = server.port();
    const auto tracker = make_leap_tracker(address_of(server));
    EXPECT_TRUE(eventually([&] {
      return tracker->status().sentence.find("does not serve /v6.json") != std::string::npos;
    }));
  }
  const auto tracker = make_leap_tracker({"127.0.0.1", free_port});
  EXPECT_TRUE(eventually(
      [&] { return tracker->status().sentence.find("nothing answers at") != std::string::npos; }));
  EXPECT_FALSE(tracker->status().connected);
}

TEST(LeapClient, TheHostHasBracketsAroundAnIpv6Address) {
  for (const std::string address : {"127.0.0.1", "::1"}) {
    std::optional<LeapServer> server;
    try {
      server.emplace(std::vector<LeapServer::Message>{}, false, "/v6.json", address);
    } catch (const boost::system::system_error&) {
      GTEST_SKIP() << "this machine has no address " << address;
    }
    const auto tracker = make_leap_tracker({address, server->port()});
    server->requests(1);
    const bool is_v6 = address == "::1";
    const std::string host =
        (is_v6 ? "[::1]:" : "127.0.0.1:") + std::to_string(int{server->port()});
    EXPECT_EQ(server->host(), host);
    EXPECT_EQ(tracker->status().sentence, "connected to leap://" + host);
  }
}

TEST(LeapAddress, IsReadOrRejectedWithASentence) {
  EXPECT_EQ(leap_address("leap://127.0.0.1:6437").host, "127.0.0.1");
  EXPECT_EQ(leap_address("leap://localhost").port, 6437);
  EXPECT_EQ(leap_address("leap://[::1]:700").host, "::1");
  EXPECT_EQ(leap_address("leap://[::1]:700").port, 700);
  for (const char* bad : {"leap://", "leap://:6437", "leap://host:", "leap://host:0",
                          "leap://host:65536", "leap://host:80/x", "leap://a b", "leap://[::1",
                          "leap://[::1]80", "ws://host", "leap://user@host"}) {
    EXPECT_THAT(test::input_error([&] { leap_address(bad); }),
                testing::HasSubstr("for example leap://127.0.0.1:6437"))
        << bad;
  }
}

TEST(StampClock, RemovesTheJitterOfTheTransport) {
  // frames every 9 ms with a delay of 2 ms, or up to 12 ms
  StampClock clock;
  double last = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double stamp = 500.0 + 0.009 * i, way = i % 3 == 0 ? 0.002 : 0.002 + 0.001 * (i % 10);
    const double arrival = 100.0 + 0.009 * i + way;
    const double time = clock.time_of(stamp, arrival).value();
    EXPECT_LE(time, arrival);
    if (i > 0) {
      EXPECT_NEAR(time - last, 0.009, 1e-4);
    }
    last = time;
  }
  // a clock that was reset, backwards or forwards
  EXPECT_NEAR(clock.time_of(3.0, 200.0).value(), 200.0, 1e-9);
  EXPECT_NEAR(clock.time_of(9000.0, 200.1).value(), 200.1, 1e-9);
}

TEST(StampClock, ARepeatedStampIsNoNewFrameHoweverLate) {
  StampClock clock;
  EXPECT_TRUE(clock.time_of(5.0, 100.0));
  for (double arrival = 100.0; arrival < 110.0; arrival += 0.01)
    ASSERT_FALSE(clock.time_of(5.0, arrival)) << arrival;
  EXPECT_FALSE(clock.time_of(4.95, 110.0)) << "a frame that was overtaken";
  EXPECT_NEAR(clock.time_of(5.01, 110.0).value(), 110.0, 1e-9);
  // a new connection does not make it new either
  clock.reset();
  EXPECT_FALSE(clock.time_of(5.01, 111.0));
  EXPECT_NEAR(clock.time_of(5.02, 111.0).value(), 111.0, 1e-9);
}

TEST(LeapLook, ReportsWhatIsConnectedInTime) {
  constexpr double kLong = 60.0;  // longer than a loaded machine takes to answer [s]
  {
    const LeapServer server(messages_of(scripted_frames(200)), true);
    const TrackerFinding finding = look_for_leap(address_of(server), kLong);
    EXPECT_TRUE(finding.found);
    EXPECT_NE(finding.words.find("frames come in"), std::string::npos) << finding.words;
  }
  TrackerFinding silent;
  for (double limit = 0.5; !silent.found && limit < kLong; limit *= 4.0) {
    const LeapServer server({{2.0 * kLong, "{}"}});
    silent = look_for_leap(address_of(server), limit);
  }
  EXPECT_TRUE(silent.found);
  EXPECT_NE(silent.words.find("no frame came in"), std::string::npos) << silent.words;
  {
    const LeapServer server({}, false, "/other");
    const TrackerFinding finding = look_for_leap(address_of(server), kLong);
    EXPECT_FALSE(finding.found);
    EXPECT_NE(finding.words.find("does not serve /v6.json"), std::string::npos) << finding.words;
  }
  std::uint16_t free_port = 0;
  {
    const LeapServer server({});
    free_port = server.port();
  }
  const TrackerFinding finding = look_for_leap({"127.0.0.1", free_port}, kLong);
  EXPECT_FALSE(finding.found);
  EXPECT_NE(finding.words.find("nothing answers"), std::string::npos) << finding.words;
  EXPECT_NE(finding.words.find("UltraleapTrackingWebSocket"), std::string::npos) << finding.words;
}

}  // namespace
}  // namespace prostm
