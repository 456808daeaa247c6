#include "prostm/device/stream/detail/stream_wire.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "device/stream/stream_client.hpp"
#include "prostm/core/random.hpp"

namespace prostm {
namespace {

using namespace stream;
using test::StreamClient;
using test::StreamMessage;

using Bytes = std::vector<std::uint8_t>;

/// A message as received.
StreamMessage seen(const Bytes& out, std::size_t size) {
  EXPECT_GE(size, 16u);
  EXPECT_EQ(std::memcmp(out.data(), "PSTM\1", 5), 0);
  EXPECT_EQ(test::number_at<std::uint16_t>(out, 6), size - 16);
  return {out[5],
          test::number_at<std::uint32_t>(out, 8),
          test::number_at<std::uint32_t>(out, 12),
          {out.begin() + 16, out.begin() + static_cast<std::ptrdiff_t>(size)}};
}

Bytes subscribe_message() {
  Bytes body(72);
  body[4] = 1;
  body[6] = 1;
  return StreamClient::message(1, body);
}

std::vector<FocusSample> ramp(std::size_t samples, std::size_t foci) {
  std::vector<FocusSample> out(samples * foci);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].p_D = Eigen::Vector3f(static_cast<float>(i), -0.5F, 0.2F);
    out[i].intensity = static_cast<float>(i % foci) / static_cast<float>(foci);
  }
  return out;
}

TEST(StreamWire, BlocksHaveTheDocumentedLayout) {
  const auto samples = ramp(40, 3);
  const BlockView block{1'000'000'000'040, 5'000'000'000, 40e3, 3, samples};
  const Wishes wishes{.foci = 2, .stride = 7};
  // 1000000000040 = 7 · 142857142862 + 6: the next multiple is one sample later
  ASSERT_EQ(wished_samples(block, wishes), 6u);
  Bytes out(kLongestMessage);
  const StreamMessage m = seen(out, put_block(out, {77, 5}, block, wishes, 1, 4, 123, true));
  EXPECT_EQ(m.kind, 17);
  EXPECT_EQ(m.session, 77u);
  EXPECT_EQ(m.sequence, 5u);
  EXPECT_EQ(m.at<std::int64_t>(0), 1'000'000'000'048);
  EXPECT_EQ(m.at<std::int64_t>(8), 5'000'000'000 + 8 * 25'000);
  EXPECT_EQ(m.at<std::uint16_t>(16), 4);
  EXPECT_EQ(m.at<std::uint16_t>(18), 7);
  EXPECT_EQ(m.body[20], 2);
  EXPECT_EQ(m.body[21], 2);
  EXPECT_EQ(m.at<std::int64_t>(24), 123);
  ASSERT_EQ(m.body.size(), 32u + 4 * 2 * 16);
  for (std::size_t k = 0; k < 4; ++k) {
    for (std::size_t f = 0; f < 2; ++f) {
      const FocusSample& sent = samples[(8 + 7 * k) * 3 + f];
      const std::size_t at = 32 + (2 * k + f) * 16;
      EXPECT_EQ(m.at<float>(at), sent.p_D.x());
      EXPECT_EQ(m.at<float>(at + 4), sent.p_D.y());
      EXPECT_EQ(m.at<float>(at + 8), sent.p_D.z());
      EXPECT_EQ(m.at<float>(at + 12), sent.intensity);
    }
  }
}

TEST(StreamWire, ASharedIntensityPreservesThePowerOfASample) {
  Random random(3);
  Bytes out(kLongestMessage);
  for (int i = 0; i < 10'000; ++i) {
    std::vector<FocusSample> sample(4);
    double power = 0.0;
    for (FocusSample& f : sample) {
      f.intensity = static_cast<float>(random.uniform());
      power += static_cast<double>(f.intensity) * static_cast<double>(f.intensity);
    }
    const BlockView block{0, 0, 40e3, 4, sample};
    const Wishes wishes{.shared = true};
    const StreamMessage m = seen(out, put_block(out, {}, block, wishes, 0, 1, 0, false));
    double shared = 0.0;
    for (std::size_t f = 0; f < 4; ++f) {
      const auto x = static_cast<double>(m.at<float>(44 + 16 * f));
      ASSERT_GE(x, 0.0);
      ASSERT_LE(x, 1.0);
      shared += x * x;
    }
    ASSERT_NEAR(shared, power, 1e-5);
  }
}

TEST(StreamWire, EachSampleIsInExactlyOnePartOfABlock) {
  Random random(4);
  Bytes out(kLongestMessage);
  for (int trial = 0; trial < 2'000; ++trial) {
    const std::size_t n = 1 + random.bits() % 100, foci = 1 + random.bits() % 8;
    const Wishes wishes{.stride = static_cast<std::uint16_t>(1 + random.bits() % 50)};
    const auto samples = ramp(n, foci);
    const auto first = static_cast<std::int64_t>(random.bits() % 1'000'000);
    const BlockView block{first, 0, 40e3, static_cast<int>(foci), samples};
    const std::size_t all = wished_samples(block, wishes), room = samples_in(kDatagramBytes, foci);
    std::int64_t expected = (first + wishes.stride - 1) / wishes.stride * wishes.stride;
    for (std::size_t begin = 0; begin < all; begin += room) {
      const std::size_t count = std::min(room, all - begin);
      const std::size_t size = put_block(out, {}, block, wishes, begin, count, 0, false);
      ASSERT_LE(size, kDatagramBytes);
      const StreamMessage m = seen(out, size);
      ASSERT_EQ(m.at<std::int64_t>(0), expected);
      expected += static_cast<std::int64_t>(count) * wishes.stride;
    }
    ASSERT_GE(expected, first + static_cast<std::int64_t>(n));
  }
}

TEST(StreamWire, EveryReasonHasASentenceThatFitsADatagram) {
  Bytes out(kDatagramBytes);
  for (const int reason : {1, 2, 3, 4, 16, 17, 18, 32, 33, 34, 35, 36, 37, 38, 39}) {
    const auto size = put_end(out, {}, Kind::Error, static_cast<Reason>(reason));
    const StreamMessage m = seen(out, size);
    EXPECT_EQ(m.at<std::uint16_t>(0), reason);
    EXPECT_GT(m.text(4).size(), 10u) << reason;
    EXPECT_EQ(m.text(4).back(), '.') << reason;
  }
}

TEST(StreamWire, RequestsAreReadOnlyIfComplete) {
  const Bytes whole = subscribe_message();
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const Reading part = read_request(std::span(whole).first(n));
    EXPECT_EQ(part.used, 0u);
    EXPECT_EQ(part.wrong, Reason::None);
  }
  EXPECT_EQ(read_request(whole).used, whole.size());
}

TEST(StreamWire, EachWrongFieldHasItsReason) {
  const auto changed = [](std::size_t at, int value) {
    Bytes bytes = subscribe_message();
    bytes[at] = static_cast<std::uint8_t>(value);
    return read_request(bytes).wrong;
  };
  EXPECT_EQ(changed(0, 'p'), Reason::Foreign);
  EXPECT_EQ(changed(4, 2), Reason::Version);
  EXPECT_EQ(changed(5, 16), Reason::UnknownKind);
  EXPECT_EQ(changed(5, 0), Reason::UnknownKind);
  EXPECT_EQ(changed(6, 71), Reason::Length);
  EXPECT_EQ(changed(7, 255), Reason::Length);
  EXPECT_EQ(changed(16 + 4, 0), Reason::Value);
  EXPECT_EQ(changed(16 + 4, 3), Reason::Value);
  EXPECT_EQ(changed(16 + 5, 9), Reason::Value);
  EXPECT_EQ(changed(16 + 6, 0), Reason::Value);
  EXPECT_EQ(changed(16 + 7, 4), Reason::Value);  // a stride of 1025
  EXPECT_EQ(changed(16 + 8, 2), Reason::Value);
  EXPECT_EQ(changed(16 + 71, 1), Reason::Value);
  EXPECT_EQ(changed(16 + 5, 8), Reason::None);
}

TEST(StreamWire, AnyBytesGiveAValidRequestOrAnError) {
  Random random(5);
  int whole = 0;
  for (int i = 0; i < 100'000; ++i) {
    Bytes bytes = subscribe_message();
    if (i % 3 == 0)
      bytes = StreamClient::message(2 + static_cast<int>(random.bits() % 2), Bytes(8));
    bytes.resize(random.bits() % (bytes.size() + 8));
    for (std::uint64_t k = random.bits() % 4; k > 0 && !bytes.empty(); --k)
      bytes[random.bits() % bytes.size()] = static_cast<std::uint8_t>(random.bits());
    const Reading reading = read_request(bytes);
    ASSERT_LE(reading.used, bytes.size());
    if (reading.wrong != Reason::None) {
      ASSERT_EQ(reading.used, 0u);
    }
    if (reading.used == 0) continue;
    ++whole;
    ASSERT_LE(reading.request.wishes.foci, kMostFoci);
    ASSERT_GE(reading.request.wishes.stride, 1);
    ASSERT_LE(reading.request.wishes.stride, kMostStride);
  }
  EXPECT_GT(whole, 1'000);
}

}  // namespace
}  // namespace prostm
