#include "prostm/device/stream/stream_device.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <thread>

#include "device/stream/stream_client.hpp"
#include "device/stream/stream_sources.hpp"
#include "prostm/core/random.hpp"
#include "prostm/device/stream/stream_kind.hpp"
#include "support/eventually.hpp"

namespace prostm {
namespace {

using test::eventually;
using test::NumberedSource;
using test::Over;
using test::StreamClient;
using test::StreamMessage;
using test::StreamWish;
using testing::HasSubstr;

constexpr int kHello = 16, kBlock = 17, kState = 18, kHeartbeat = 19, kTime = 20, kEnd = 23,
              kError = 24;

std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void sleep_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

StreamDevice device_on_any_port(const StreamSettings& settings = {}) {
  return StreamDevice(settings, {"127.0.0.1", 0});
}

/// Checks that a block's samples carry their indices. @param offset of the session's indices.
void expect_numbered(const StreamMessage& m, std::int64_t offset = 0) {
  const auto first = m.at<std::int64_t>(0);
  const int count = m.at<std::uint16_t>(16), stride = m.at<std::uint16_t>(18), foci = m.body[20];
  ASSERT_EQ(m.body.size(), 32u + static_cast<std::size_t>(count * foci) * 16);
  for (int k = 0; k < count; ++k) {
    for (int f = 0; f < foci; ++f) {
      const auto at = 32 + static_cast<std::size_t>(k * foci + f) * 16;
      const std::int64_t number = (first + k * stride - offset) % NumberedSource::kCycle;
      ASSERT_EQ(m.at<float>(at), static_cast<float>(number));
      ASSERT_EQ(m.at<float>(at + 4), static_cast<float>(f));
      ASSERT_EQ(m.at<float>(at + 8), 0.2F);
      ASSERT_EQ(m.at<float>(at + 12), 0.5F);
    }
  }
}

class StreamOver : public testing::TestWithParam<Over> {};
INSTANTIATE_TEST_SUITE_P(Stream, StreamOver, testing::Values(Over::Tcp, Over::Udp),
                         [](const auto& p) { return p.param == Over::Tcp ? "Tcp" : "Udp"; });

TEST_P(StreamOver, EverySampleArrivesWithItsTime) {
  NumberedSource source(3);
  StreamDevice device = device_on_any_port();
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  StreamClient client(GetParam(), device.port());
  const auto hello = client.subscribe();
  ASSERT_TRUE(hello);
  ASSERT_EQ(hello->kind, kHello);
  EXPECT_EQ(hello->body.size(), 72u);
  EXPECT_EQ(hello->body[4], 1);
  EXPECT_EQ(hello->body[6], 8);
  EXPECT_EQ(hello->body[11], 1);
  EXPECT_EQ(hello->body[12], 1);
  EXPECT_EQ(hello->at<std::uint16_t>(14), 40);
  EXPECT_EQ(hello->at<double>(16), 40e3);
  EXPECT_NEAR(static_cast<double>(hello->at<std::int64_t>(24)), static_cast<double>(steady_ns()),
              5e9);
  EXPECT_EQ(hello->at<std::int64_t>(48), 20'000'000);
  EXPECT_EQ(hello->at<std::uint32_t>(56), 20'000u);
  EXPECT_EQ(hello->at<std::uint32_t>(60), 5'000u);

  std::int64_t next = -1, time = 0, in_time = 0, blocks = 0;
  std::uint32_t sequence = hello->sequence;
  while (next < 0 || device.stats().blocks < 500) {
    const auto m = client.next();
    ASSERT_TRUE(m);
    EXPECT_EQ(m->session, hello->session);
    EXPECT_EQ(m->sequence, ++sequence);
    if (m->kind != kBlock) continue;
    expect_numbered(*m);
    if (next >= 0) {
      ASSERT_EQ(m->at<std::int64_t>(0), next);
    }
    if (next >= 0 && device.stats().missed_blocks == 0) {
      EXPECT_EQ(m->at<std::int64_t>(8), time);
    }
    const int count = m->at<std::uint16_t>(16);
    next = m->at<std::int64_t>(0) + count;
    time = m->at<std::int64_t>(8) + count * 25'000;
    ++blocks;
    in_time += m->at<std::int64_t>(8) > steady_ns() ? 1 : 0;
  }
  // most arrive before they are played, however loaded the machine is
  EXPECT_GT(in_time, blocks / 2);
  const std::int64_t sample = next - 1;
  EXPECT_NEAR(device.play_time(sample), static_cast<double>(time - 25'000) * 1e-9, 1e-6);
  EXPECT_NEAR(device.play_time(sample) - device.ask_time(sample), 0.020, 1e-9);
  EXPECT_EQ(source.allocations, 0u);
}

TEST_P(StreamOver, WishesAreHonoured) {
  NumberedSource source(4);
  StreamDevice device = device_on_any_port({.block_samples = 50});
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  StreamClient client(GetParam(), device.port());
  const auto hello = client.subscribe({.foci = 2, .stride = 64, .flags = 1});
  ASSERT_TRUE(hello);
  EXPECT_EQ(hello->body[7], 2);
  EXPECT_EQ(hello->at<std::uint16_t>(8), 64);
  EXPECT_EQ(hello->body[10], 1);
  std::int64_t last = -1;
  int empty = 0;
  for (int i = 0; i < 100; ++i) {
    const auto m = client.next_of(kBlock);
    ASSERT_TRUE(m);
    EXPECT_EQ(m->body[20], 2);
    EXPECT_EQ(m->body[21] & 1, 1);
    expect_numbered(*m);
    if (m->at<std::uint16_t>(16) == 0) {
      ++empty;
      continue;
    }
    EXPECT_EQ(m->at<std::int64_t>(0) % 64, 0);
    if (last >= 0) {
      EXPECT_EQ(m->at<std::int64_t>(0), last + 64);
    }
    last = m->at<std::int64_t>(0);
  }
  EXPECT_GT(empty, 5);
}

TEST_P(StreamOver, ARequestForTheTimeIsAnswered) {
  StreamDevice device = device_on_any_port();
  StreamClient client(GetParam(), device.port());
  ASSERT_TRUE(client.subscribe());
  const std::int64_t before = steady_ns();
  client.ask_time(-987654321012345678);
  const auto m = client.next_of(kTime);
  ASSERT_TRUE(m);
  EXPECT_EQ(m->at<std::int64_t>(0), -987654321012345678);
  EXPECT_LE(before, m->at<std::int64_t>(8));
  EXPECT_LE(m->at<std::int64_t>(8), m->at<std::int64_t>(16));
  EXPECT_LE(m->at<std::int64_t>(16), steady_ns());
}

TEST_P(StreamOver, ASubscriptionExpiresUnlessRenewed) {
  bool renewed = false;
  for (int trial = 0; trial < 10 && !renewed; ++trial) {
    StreamDevice device = device_on_any_port();
    StreamClient kept(GetParam(), device.port()), left(GetParam(), device.port());
    ASSERT_TRUE(kept.subscribe());
    ASSERT_TRUE(left.subscribe());
    left.renews = false;
    const std::int64_t begin = steady_ns();
    renewed = kept.pass_over(std::chrono::milliseconds(1600));
    const auto end = left.next_of(kEnd);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->at<std::uint16_t>(0), 18);
    EXPECT_GE(steady_ns() - begin, 1'000'000'000);
    if (!renewed) continue;
    EXPECT_EQ(device.stream_stats().subscribers, 1);
    kept.ask_time(1);
    EXPECT_TRUE(kept.next_of(kTime));
  }
  EXPECT_TRUE(renewed);
}

TEST_P(StreamOver, ByeEndsASubscription) {
  StreamDevice device = device_on_any_port();
  StreamClient client(GetParam(), device.port());
  ASSERT_TRUE(client.subscribe());
  std::vector<std::uint8_t> body(8);
  std::memcpy(body.data(), &client.token, 4);
  client.send(StreamClient::message(3, body));
  const auto end = client.next_of(kEnd);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->at<std::uint16_t>(0), 17);
  EXPECT_TRUE(eventually([&] { return device.stream_stats().subscribers == 0; }));
}

TEST_P(StreamOver, TheEndOfTheProgramIsAnnounced) {
  auto device = std::make_unique<StreamDevice>(StreamSettings{}, HostPort{"127.0.0.1", 0});
  StreamClient client(GetParam(), device->port());
  ASSERT_TRUE(client.subscribe());
  device.reset();
  const auto end = client.next_of(kEnd);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->at<std::uint16_t>(0), 16);
  EXPECT_THAT(end->text(4), HasSubstr("prostm ends"));
}

TEST_P(StreamOver, StatesAreSentAndHeartbeatsContinue) {
  NumberedSource source(2), again(2);
  StreamDevice device = device_on_any_port();
  StreamClient client(GetParam(), device.port());
  ASSERT_TRUE(client.subscribe());
  const auto expect_state = [&](int state, int reason) {
    const auto m = client.next_of(kState);
    ASSERT_TRUE(m);
    EXPECT_EQ(m->body[2], state);
    EXPECT_EQ(m->at<std::uint16_t>(0), reason);
  };
  expect_state(0, 1);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(client.next_of(kHeartbeat));
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  expect_state(2, 0);
  source.intensity = 0.0F;
  expect_state(1, 2);
  source.intensity = 0.5F;
  expect_state(2, 0);
  device.stop();
  expect_state(0, 1);
  const auto beat = client.next_of(kHeartbeat);
  ASSERT_TRUE(beat);
  EXPECT_EQ(beat->body[16], 0);
  const std::int64_t sent = source.filled;
  EXPECT_EQ(beat->at<std::int64_t>(8), sent);

  // sample indices continue across the session
  ASSERT_EQ(device.start(again), DeviceStatus::Running);
  EXPECT_EQ(device.samples() / 1000, 0);
  const auto block = client.next_of(kBlock);
  ASSERT_TRUE(block);
  EXPECT_EQ(block->at<std::int64_t>(0), sent);
  expect_numbered(*block, sent);
}

TEST(StreamDevice, KeepsTimeWithoutSubscribers) {
  StreamDevice device = device_on_any_port();
  EXPECT_EQ(device.info().block_samples, 40);
  EXPECT_TRUE(device.info().streams);
  NumberedSource source;
  const std::int64_t begin = steady_ns();
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  EXPECT_EQ(device.status(), DeviceStatus::Running);
  ASSERT_TRUE(eventually([&] { return device.samples() > 8000; }));
  EXPECT_GE(steady_ns() - begin, 200'000'000);
  EXPECT_EQ(device.start(source), DeviceStatus::Refused);
  EXPECT_THAT(device.problem(), HasSubstr("running already"));
  EXPECT_EQ(device.status(), DeviceStatus::Running);
  device.stop();
  EXPECT_EQ(device.status(), DeviceStatus::Idle);
  EXPECT_EQ(device.stats().queue_blocks, 20);
  NumberedSource wide(9);
  EXPECT_EQ(device.start(wide), DeviceStatus::Refused);
  EXPECT_THAT(device.problem(), HasSubstr("1 to 8"));
}

TEST(StreamDevice, ReportsWhyItCannotListen) {
  const StreamDevice first = device_on_any_port();
  const auto problem = [](const HostPort& address) {
    try {
      const StreamDevice device({}, address);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(problem({"127.0.0.1", first.port()}), HasSubstr("in use by another program"));
  EXPECT_THAT(problem({"192.0.2.1", 0}), HasSubstr("no address of this machine"));
  EXPECT_THAT(problem({"array.example", 0}), HasSubstr("must be a number"));
  EXPECT_THROW(StreamDevice({.block_samples = 401}, {"127.0.0.1", 0}), std::invalid_argument);

  DeviceSetup setup;
  setup.address = "127.0.0.1:" + std::to_string(first.port());
  const DeviceFinding finding = stream_kind().look(setup);
  EXPECT_FALSE(finding.found);
  EXPECT_THAT(finding.words, HasSubstr("in use"));
}

TEST(StreamDevice, DatagramsNeedTheTokenOfTheirAddress) {
  StreamDevice device = device_on_any_port();
  StreamClient honest(Over::Udp, device.port()), foreign(Over::Udp, device.port());
  ASSERT_TRUE(honest.subscribe());
  foreign.token = honest.token;
  foreign.send(foreign.subscribe_message({}));
  const auto m = foreign.next();
  ASSERT_TRUE(m);
  EXPECT_EQ(m->kind, kHello);
  EXPECT_EQ(m->body[4], 0);
  EXPECT_FALSE(foreign.next(100));
  EXPECT_EQ(device.stream_stats().subscribers, 1);
}

TEST(StreamDevice, ALostDatagramShowsAsAGapInTheIndices) {
  NumberedSource source(8);
  StreamDevice device = device_on_any_port();
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  // a receiver with a small buffer that pauses reading
  StreamClient client(Over::Udp, device.port(), 4096);
  ASSERT_TRUE(client.subscribe());
  sleep_ms(100);
  std::int64_t next = -1, lost = 0;
  while (lost == 0) {
    const auto m = client.next_of(kBlock);
    ASSERT_TRUE(m);
    expect_numbered(*m);
    if (next >= 0) lost += m->at<std::int64_t>(0) - next;
    next = m->at<std::int64_t>(0) + m->at<std::uint16_t>(16);
  }
  EXPECT_GT(lost, 0);
}

TEST(StreamDevice, ASlowReaderIsSkippedAndDelaysNoOther) {
  NumberedSource source(8);
  StreamDevice device = device_on_any_port();
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  StreamClient slow(Over::Tcp, device.port(), 4096), quick(Over::Tcp, device.port());
  ASSERT_TRUE(slow.subscribe());
  ASSERT_TRUE(quick.subscribe());
  std::int64_t next = -1;
  std::int64_t asked = steady_ns();
  while (device.stream_stats().skipped_blocks < 300) {
    const auto m = quick.next_of(kBlock);
    ASSERT_TRUE(m);
    if (next >= 0 && m->at<std::int64_t>(24) == 0) {
      ASSERT_EQ(m->at<std::int64_t>(0), next);
    }
    next = m->at<std::int64_t>(0) + m->at<std::uint16_t>(16);
    if (steady_ns() - asked < 200'000'000) continue;
    asked = steady_ns();
    slow.ask_time(0);
    quick.ask_time(0);
  }
  EXPECT_EQ(source.allocations, 0u);
  // it finally reads complete messages, with each gap marked and counted
  std::int64_t skipped = 0;
  next = -1;
  while (skipped < 300 * 40 / 2) {
    const auto m = slow.next_of(kBlock);
    ASSERT_TRUE(m);
    expect_numbered(*m);
    const std::int64_t first = m->at<std::int64_t>(0), more = m->at<std::int64_t>(24) - skipped;
    EXPECT_EQ((m->body[21] & 2) != 0, more > 0);
    if (next >= 0) {
      EXPECT_EQ(first - next, more);
    }
    skipped += more;
    next = first + m->at<std::uint16_t>(16);
    slow.ask_time(0);
  }
}

TEST(StreamDevice, TheNinthSubscriberIsRejected) {
  StreamDevice device = device_on_any_port();
  std::vector<std::unique_ptr<StreamClient>> clients;
  for (int i = 0; i < 8; ++i) {
    clients.push_back(
        std::make_unique<StreamClient>(i % 2 == 0 ? Over::Tcp : Over::Udp, device.port()));
    const auto hello = clients.back()->subscribe();
    ASSERT_TRUE(hello);
    ASSERT_EQ(hello->kind, kHello);
  }
  for (const Over over : {Over::Tcp, Over::Udp}) {
    StreamClient late(over, device.port());
    const auto m = late.subscribe();
    ASSERT_TRUE(m);
    EXPECT_EQ(m->kind, kError);
    EXPECT_EQ(m->at<std::uint16_t>(0), 37);
    EXPECT_THAT(m->text(4), HasSubstr("Eight receivers"));
  }
}

TEST(StreamDevice, WrongMessagesAreAnsweredWithASentenceAndClosed) {
  StreamDevice device = device_on_any_port();
  const auto answer = [&](const std::vector<std::uint8_t>& bytes) {
    StreamClient client(Over::Tcp, device.port());
    client.send(bytes);
    const auto m = client.next();
    EXPECT_TRUE(m);
    EXPECT_FALSE(client.next());
    EXPECT_TRUE(client.ended);
    if (!m) return std::string();
    EXPECT_EQ(m->kind, kError);
    return m->text(4);
  };
  const std::string http = "GET / HTTP/1.1\r\n\r\n";
  EXPECT_THAT(answer({http.begin(), http.end()}), HasSubstr("must begin with the four bytes PSTM"));
  auto bytes = StreamClient::message(1, std::vector<std::uint8_t>(72));
  EXPECT_THAT(answer(bytes), HasSubstr("want must be 1 or 2"));
  bytes[4] = 2;
  EXPECT_THAT(answer(bytes), HasSubstr("version"));
  bytes[4] = 1;
  bytes[7] = 0xFF;
  EXPECT_THAT(answer(bytes), HasSubstr("72 bytes"));
  bytes[5] = 99;
  EXPECT_THAT(answer(bytes), HasSubstr("kind is unknown"));
  EXPECT_THAT(answer(StreamClient::message(2, std::vector<std::uint8_t>(8))),
              HasSubstr("must be the first message"));
  EXPECT_THAT(answer({'P'}), HasSubstr("within 1 s"));
  EXPECT_EQ(device.stream_stats().refused_requests, 6);
}

TEST(StreamDevice, WrongDatagramsAreAnsweredOrIgnored) {
  StreamDevice device = device_on_any_port();
  StreamClient client(Over::Udp, device.port());
  const auto error = [&](const std::vector<std::uint8_t>& bytes) {
    client.send(bytes);
    const auto m = client.next();
    EXPECT_TRUE(m);
    return m && m->kind == kError ? m->at<std::uint16_t>(0) : 0;
  };
  auto bytes = StreamClient::message(1, std::vector<std::uint8_t>(72));
  bytes.resize(3000);
  EXPECT_EQ(error(bytes), 35);
  EXPECT_EQ(error(client.subscribe_message({.want = 2})), 38);
  EXPECT_EQ(error(StreamClient::message(2, std::vector<std::uint8_t>(8))), 39);
  // messages outside the protocol, or of a server, are not answered
  client.send({1, 2, 3});
  client.send(std::vector<std::uint8_t>(1500, 7));
  client.send(StreamClient::message(24, std::vector<std::uint8_t>(20)));
  EXPECT_TRUE(eventually([&] { return device.stream_stats().ignored_datagrams == 3; }));
  EXPECT_FALSE(client.next(50));
}

TEST(StreamDevice, StillServesAfterAHundredThousandRandomMessages) {
  NumberedSource source;
  StreamDevice device = device_on_any_port();
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  Random random(11);
  StreamClient datagrams(Over::Udp, device.port());
  const auto random_message = [&] {
    auto bytes = datagrams.subscribe_message({});
    if (random.below(4) == 0) bytes = StreamClient::message(random.below(26), {});
    bytes.resize(static_cast<std::size_t>(random.below(120)));
    for (int k = random.below(3); k > 0 && !bytes.empty(); --k) {
      const auto at = static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())));
      bytes[at] = static_cast<std::uint8_t>(random.bits());
    }
    return bytes;
  };
  for (int i = 0; i < 200; ++i) {
    StreamClient client(Over::Tcp, device.port());
    for (int k = 0; k < 200; ++k) client.send(random_message());
  }
  for (int i = 0; i < 60'000; ++i) datagrams.send(random_message());
  EXPECT_GT(device.stream_stats().refused_requests, 100);
  ASSERT_TRUE(eventually([&] { return device.stream_stats().subscribers == 0; }));
  StreamClient client(Over::Tcp, device.port());
  ASSERT_TRUE(client.subscribe());
  const auto block = client.next_of(kBlock);
  ASSERT_TRUE(block);
  expect_numbered(*block);
  EXPECT_EQ(source.allocations, 0u);
}

}  // namespace
}  // namespace prostm
