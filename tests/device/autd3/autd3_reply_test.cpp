#include "prostm/device/autd3/autd3_reply.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace prostm::autd3 {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(Autd3Reply, IsReadPieceByPiece) {
  EXPECT_EQ(read_reply({}, Request::Send, 2).kind, Reply::Kind::Incomplete);
  EXPECT_EQ(read_reply(Bytes{0}, Request::Send, 2).kind, Reply::Kind::Accepted);
  const Reply part = read_reply(Bytes{0}, Request::Read, 2);
  EXPECT_EQ(part.kind, Reply::Kind::Incomplete);
  EXPECT_EQ(part.bytes, 5U);
  EXPECT_EQ(read_reply(Bytes{0, 1, 2, 3, 4}, Request::Read, 2).kind, Reply::Kind::Accepted);
  EXPECT_EQ(read_reply(Bytes{7}, Request::Read, 2).kind, Reply::Kind::Strange);
  const Bytes refusal = {0xFF, 2, 0, 0, 0, 'n', 'o'};
  for (std::size_t size = 1; size < refusal.size(); ++size) {
    const Reply begun = read_reply(std::span(refusal).first(size), Request::Hello, 1);
    EXPECT_EQ(begun.kind, Reply::Kind::Incomplete);
    EXPECT_GT(begun.bytes, size);
  }
  const Reply refused = read_reply(refusal, Request::Hello, 1);
  EXPECT_EQ(refused.kind, Reply::Kind::Refused);
  EXPECT_EQ(refused.words, "no");
  EXPECT_EQ(read_reply(Bytes{0xFF, 0, 0, 0, 1}, Request::Hello, 1).kind, Reply::Kind::Strange);
}

TEST(Autd3Request, LengthDependsOnItsKind) {
  EXPECT_EQ(request_bytes(Bytes{0x10}, 1), 14U);
  EXPECT_EQ(request_bytes(Bytes{1}, 1), 0U);
  EXPECT_EQ(request_bytes(Bytes{1, 3, 0, 0, 0}, 1), 5U + 3U * 28U);
  EXPECT_EQ(request_bytes(Bytes{3}, 2), 1U + 2U * 626U);
  EXPECT_EQ(request_bytes(Bytes{4}, 2), 1U);
  EXPECT_EQ(request_bytes(Bytes{9}, 2), 0U);
}

}  // namespace
}  // namespace prostm::autd3
