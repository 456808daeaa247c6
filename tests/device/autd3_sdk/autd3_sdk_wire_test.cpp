#include "prostm/device/autd3_sdk/detail/autd3_sdk_wire.hpp"

#include <gmock/gmock.h>

#include <set>

#include "prostm/core/random.hpp"
#include "support/load.hpp"

namespace prostm::sdk {
namespace {

using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;

std::vector<std::uint8_t> bytes_of(const Datagram& d) {
  return {d.bytes().begin(), d.bytes().end()};
}

TEST(SdkWire, WritesTheHeadersOfMessages) {
  Datagram d;
  begin(d, Kind::Discover, 0x1234);
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 3, 0x34, 0x12));
  begin(d, Kind::Heartbeat, 0xFFFE);
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 7, 0xFE, 0xFF));
  assign_id(d, 5, 0, true);
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 4, 5, 0, 0, 1));
  assign_id(d, 6, 2, false);
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 4, 6, 0, 2, 0));
  set_time(d, 7, 0x0123456789ABCDEF);
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 6, 7, 0, 0xEF, 0xCD, 0xAB, 0x89, 0x67, 0x45, 0x23, 0x01));
}

TEST(SdkWire, NumbersFrames) {
  Datagram d;
  frame(d, Command::Clear);
  d.renumber(0xABCD, 250);
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 0, 0xCD, 0xAB, 250, 3));
  EXPECT_EQ(d.command(), Command::Clear);
}

TEST(SdkWire, WritesFoci) {
  Datagram d;
  write_foci(d, 1, 100, std::array<SlotWord, 2>{0x1122334455667788, 0xFF});
  d.renumber(1, 9);
  // the offset counts words of 16 bit, four a focus; the length counts bytes
  EXPECT_THAT(bytes_of(d),
              ElementsAre(2, 0, 1, 0, 9, 0x10, 1, 0, 0x90, 0x01, 0, 0, 16, 0, 0x88, 0x77, 0x66,
                          0x55, 0x44, 0x33, 0x22, 0x11, 0xFF, 0, 0, 0, 0, 0, 0, 0));
}

TEST(SdkWire, FillsADatagramWithFoci) {
  Datagram d;
  write_foci(d, 0, 0, std::vector<SlotWord>(kFociPerFrame));
  EXPECT_EQ(d.bytes().size(), 4U + 2U + 8U + 179U * 8U);
  EXPECT_LE(d.bytes().size(), kMostDatagram);
}

TEST(SdkWire, WritesPatternSettings) {
  Datagram d;
  config_pattern(d,
                 {.bank = 1, .divider = 4, .samples = 0x10203, .slots = 8, .sound_speed = 346.0});
  d.renumber(2, 3);
  // 346 m/s are 22144 = 0x5680 in units of 1/64 m/s
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 0, 2, 0, 3, 0x11, 1, 0, 4, 0, 0x03, 0x02, 0x01, 0, 8, 0,
                                       0x80, 0x56, 0, 0));
  config_pattern(d, {.bank = 0, .divider = 300, .samples = 2, .slots = 1, .sound_speed = 340.0});
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 0, 0, 0, 0, 0x11, 0, 0, 0x2C, 0x01, 2, 0, 0, 0, 1, 0,
                                       0x00, 0x55, 0, 0));
}

TEST(SdkWire, ActivatesBanksInBothForms) {
  Datagram d;
  activate(d, 1, false);
  EXPECT_THAT(bytes_of(d), ElementsAre(2, 0, 0, 0, 0, 0x12, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0));
  activate(d, 0, true);
  EXPECT_THAT(bytes_of(d),
              ElementsAre(2, 0, 0, 0, 0, 0x12, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(SdkWire, SetsAStrictSilencer) {
  Datagram d;
  silencer(d, 260);
  EXPECT_THAT(bytes_of(d),
              ElementsAre(2, 0, 0, 0, 0, 0x30, 2, 0, 0, 1, 0, 1, 0x04, 0x01, 0x04, 0x01));
}

TEST(SdkWire, SetsTheFailsafeAmongAllSettingsOfTheProcessor) {
  Datagram d;
  cpu_config(d, 80);
  const std::vector<std::uint8_t> expected = {
      2,    0,    0,    0,    0,    5,                              // header, sequence, command
      0x80, 0x96, 0x98, 0,    0x40, 0x42, 0x0F, 0,                  // 10 000 000, 1 000 000
      0x00, 0x94, 0x35, 0x77, 0x90, 0xD0, 0x03, 0,                  // 2 000 000 000, 250 000
      100,  0,    8,    0,    3,    0,    6,    0, 0xE8, 3, 64, 0,  // 100 8 3 6 1000 64
      0x10, 0x27, 0,    0,    100,  0,    0,    0, 50,   0, 0,  0,
      1,    0,    0,    0,  // 10 000, 100, 50, 1
      0x20, 0xA1, 7,    0,  // 500 000
      80,   0,    32,   0,    5,    0,    48,   0, 64,   0, 8,  0,
      0,    0,    3,    0};
  EXPECT_THAT(bytes_of(d), ElementsAreArray(expected));
  EXPECT_EQ(expected.size(), 6U + 64U);
}

TEST(SdkWire, ReadsAnswersOfUnits) {
  const std::vector<std::uint8_t> info = {2, 1, 9, 0, 0, 3, 29, 0, 0, 0, 10, 2, 0,
                                          1, 0, 0, 0, 0, 0, 0,  0, 5, 0, 0,  0};
  const auto reply = read_reply(info);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->kind, Kind::ReadUnitInfo);
  EXPECT_EQ(reply->id, 9);
  EXPECT_EQ(reply->status, kOk);
  const auto unit = read_unit_info(*reply);
  ASSERT_TRUE(unit);
  EXPECT_EQ(unit->unit, 3);
  EXPECT_EQ(unit->flags, kAssigned | kDownstreamLink | kSyncReady | kClockLocked);
  EXPECT_THAT(unit->firmware, ElementsAre(0, 10, 2));
}

TEST(SdkWire, ReadsAcknowledgements) {
  const std::vector<std::uint8_t> bytes = {2,    0,    0x34, 0x12, 77, 0x15, 25, 1,  0xEF,
                                           0xCD, 0xAB, 0x89, 0x67, 5,  0,    0,  132};
  const auto reply = read_reply(bytes);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->id, 0x1234);
  const auto frame_reply = read_frame_reply(*reply);
  ASSERT_TRUE(frame_reply);
  EXPECT_EQ(frame_reply->ack, 77);
  EXPECT_EQ(frame_reply->error, kFailsafeConditionActive);
  EXPECT_EQ(frame_reply->flags, kAssigned | kSyncReady | kClockLocked);
  EXPECT_EQ(frame_reply->unit, 1);
  EXPECT_EQ(frame_reply->time, 0x0000000567'89ABCDEF);
  EXPECT_THAT(frame_reply->data, ElementsAre(132));
  EXPECT_FALSE(read_unit_info(*reply));
}

TEST(SdkWire, RejectsMessagesThatAreTooShortOrOfAnotherVersion) {
  std::vector<std::uint8_t> bytes = {2, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  ASSERT_TRUE(read_frame_reply(*read_reply(bytes)));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto reply = read_reply(std::span(bytes).first(size));
    EXPECT_TRUE(!reply || !read_frame_reply(*reply)) << size;
  }
  bytes[0] = 1;
  EXPECT_FALSE(read_reply(bytes));
  EXPECT_EQ(version_of(bytes), 1);
  bytes = {2, 8, 0, 0, 0};
  EXPECT_FALSE(read_reply(bytes));
  EXPECT_FALSE(read_reply(std::array<std::uint8_t, 4>{2, 3, 0, 0}));  // the status is missing
}

TEST(SdkWire, SurvivesRandomBytes) {
  Random random(7);
  for (std::uint64_t i = 0; i < test::reduced(100'000); ++i) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(random.uniform(0.0, 60.0)));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
    if (bytes.size() > 1) bytes[0] = kVersion, bytes[1] &= 7;
    const auto reply = read_reply(bytes);
    if (!reply) continue;
    EXPECT_LE(reply->body.size(), bytes.size() - 4);
    if (const auto answer = read_frame_reply(*reply)) {
      EXPECT_EQ(answer->data.size(), bytes.size() - 16);
    }
    if (read_unit_info(*reply)) {
      EXPECT_GE(bytes.size(), 25U);
    }
  }
}

TEST(SdkWire, HasADistinctSentenceForEachError) {
  std::set<std::string> seen;
  for (int error = 1; error <= 0x15; ++error) {
    if (error == 3) continue;  // not in the table
    const std::string words = error_words(static_cast<std::uint8_t>(error));
    EXPECT_THAT(words, testing::Not(HasSubstr("does not know; its firmware is newer"))) << error;
    if (error == 0x0D || error == 0x0E) continue;  // same as 0x0A
    EXPECT_TRUE(seen.insert(words).second) << error;
  }
  EXPECT_THAT(error_words(0x40), HasSubstr("error 64"));
  for (int status = 1; status <= 4; ++status)
    EXPECT_TRUE(seen.insert(status_words(static_cast<std::uint8_t>(status))).second);
  EXPECT_THAT(status_words(9), HasSubstr("status 9"));
}

}  // namespace
}  // namespace prostm::sdk
