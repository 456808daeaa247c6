// Loops over the stream, and sending without allocation.
#include <gmock/gmock.h>
#include <sys/socket.h>

#include "device/stream/stream_client.hpp"
#include "device/stream/stream_sources.hpp"
#include "prostm/device/stream/detail/stream_peer.hpp"
#include "prostm/device/stream/stream_device.hpp"

namespace prostm {
namespace {

using test::Over;
using test::StreamClient;

constexpr int kBlock = 17, kState = 18, kLoop = 21, kLoopStart = 22;

std::vector<FocusSample> loop_of(std::size_t samples, std::size_t foci, float mark) {
  std::vector<FocusSample> out(samples * foci);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].p_D = Eigen::Vector3f(static_cast<float>(i), mark, 0.2F);
    out[i].intensity = 0.5F;
  }
  return out;
}

/// Receives the parts of a loop; returns the x of all its focal points, and its id.
std::vector<float> whole_loop(StreamClient& client, float mark, std::uint32_t& id) {
  std::vector<float> x;
  for (std::uint32_t next = 0, all = 1; next < all;) {
    const auto m = client.next_of(kLoop);
    if (!m) return {};
    id = m->at<std::uint32_t>(0);
    all = m->at<std::uint32_t>(4);
    EXPECT_EQ(m->at<std::uint32_t>(8), next);
    EXPECT_EQ(m->at<double>(16), 40e3);
    next += m->at<std::uint16_t>(12);
    for (std::size_t at = 24; at < m->body.size(); at += 16) {
      x.push_back(m->at<float>(at));
      EXPECT_EQ(m->at<float>(at + 4), mark);
    }
  }
  return x;
}

TEST(StreamLoops, ArriveCompleteAndInStepWithTheSamples) {
  StreamDevice device({}, {"127.0.0.1", 0});
  StreamClient loops(Over::Tcp, device.port()), samples(Over::Tcp, device.port());
  ASSERT_TRUE(loops.subscribe({.want = 2}));
  ASSERT_TRUE(samples.subscribe());
  ASSERT_EQ(device.load_segment(loop_of(5000, 3, 1.0F), 3), DeviceStatus::Running);

  std::uint32_t first_id = 0, second_id = 0;
  const std::vector<float> first = whole_loop(loops, 1.0F, first_id);
  ASSERT_EQ(first.size(), 15000u);
  for (std::size_t i = 0; i < first.size(); ++i) ASSERT_EQ(first[i], static_cast<float>(i));
  auto start = loops.next_of(kLoopStart);
  ASSERT_TRUE(start);
  EXPECT_EQ(start->at<std::uint32_t>(0), first_id);
  EXPECT_EQ(start->at<std::int64_t>(8), 0);
  EXPECT_NEAR(device.play_time(0), static_cast<double>(start->at<std::int64_t>(16)) * 1e-9, 1e-6);

  // the next loop starts at the end of a lap
  ASSERT_EQ(device.load_segment(loop_of(333, 3, 2.0F), 3), DeviceStatus::Running);
  const std::vector<float> second = whole_loop(loops, 2.0F, second_id);
  EXPECT_EQ(second.size(), 999u);
  start = loops.next_of(kLoopStart);
  ASSERT_TRUE(start);
  EXPECT_GT(second_id, first_id);
  EXPECT_EQ(start->at<std::uint32_t>(0), second_id);
  const std::int64_t s = start->at<std::int64_t>(8);
  EXPECT_EQ(s % 5000, 0);
  std::int64_t seen = 0;
  while (seen < s + 2000) {
    const auto m = samples.next_of(kBlock);
    ASSERT_TRUE(m);
    for (std::size_t at = 32; at < m->body.size(); at += 16) {
      seen = m->at<std::int64_t>(0) + static_cast<std::int64_t>((at - 32) / 48);
      const std::int64_t length = seen < s ? 5000 : 333, k = seen < s ? seen : seen - s;
      const auto focus = static_cast<std::int64_t>((at - 32) / 16 % 3);
      ASSERT_EQ(m->at<float>(at), static_cast<float>(k % length * 3 + focus));
      ASSERT_EQ(m->at<float>(at + 4), seen < s ? 1.0F : 2.0F);
    }
  }
}

TEST(StreamLoops, AreRejectedWhileAStreamPlays) {
  test::NumberedSource source;
  StreamDevice device({}, {"127.0.0.1", 0});
  ASSERT_EQ(device.start(source), DeviceStatus::Running);
  EXPECT_EQ(device.load_segment(loop_of(10, 2, 0.0F), 2), DeviceStatus::Refused);
  EXPECT_THAT(device.problem(), testing::HasSubstr("stop it first"));
  StreamClient client(Over::Tcp, device.port());
  ASSERT_TRUE(client.subscribe({.want = 2}));
  auto state = client.next_of(kState);
  ASSERT_TRUE(state);
  if (state->at<std::uint16_t>(0) == 1) state = client.next_of(kState);  // before the first block
  ASSERT_TRUE(state);
  EXPECT_EQ(state->body[2], 0);
  EXPECT_THAT(state->text(16), testing::HasSubstr("no loop"));
  device.stop();
  EXPECT_EQ(device.load_segment(loop_of(65537, 1, 0.0F), 1), DeviceStatus::Refused);
  EXPECT_THAT(device.problem(), testing::HasSubstr("at most 65536"));
}

TEST(StreamPeer, SendsWithoutAllocation) {
  using namespace stream;
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0);
  const Descriptor other(ends[1]);
  Peer peer;
  const auto now = Clock::now();
  peer.open_tcp(Descriptor(ends[0]), now);
  peer.subscribe({}, now);
  auto loop = std::make_shared<PlayedLoop>();
  loop->id = 7;
  loop->foci = 8;
  loop->sample_rate = 40e3;
  loop->samples = loop_of(1000, 8, 0.0F);
  const auto samples = loop_of(40, 8, 0.0F);
  std::int64_t skipped = 0, bytes = 0;
  {
    const test::HeapGuard guard;
    for (int i = 0; i < 2000; ++i) {
      if (!peer.send_block(1, {40 * i, 0, 40e3, 8, samples}, now)) ++skipped;
      std::uint8_t out[4096];
      // reads less than is sent
      const auto got = recv(other.get(), out, sizeof(out), 0);
      bytes += std::max<std::int64_t>(0, got);
      peer.flush();
    }
    peer.send_loop(1, loop, now);
    EXPECT_EQ(guard.allocations(), 0u);
  }
  EXPECT_GT(skipped, 100);
  EXPECT_GT(bytes, 1'000'000);
}

}  // namespace
}  // namespace prostm
