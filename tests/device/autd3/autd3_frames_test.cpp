#include "prostm/device/autd3/detail/autd3_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace prostm::autd3 {
namespace {

std::vector<int> bytes(const Frame& frame, std::size_t first, std::size_t count) {
  return {frame.begin() + static_cast<std::ptrdiff_t>(first),
          frame.begin() + static_cast<std::ptrdiff_t>(first + count)};
}

using testing::ElementsAre;

TEST(Autd3Frames, AreWrittenByteByByte) {
  Frame frame;
  frame.fill(0xAA);
  clear_and_synchronise(frame);
  EXPECT_THAT(bytes(frame, 0, 10), ElementsAre(0, 0, 2, 0, 0x01, 0, 0x02, 0, 0, 0));
  silencer(frame, 300);
  EXPECT_THAT(bytes(frame, 0, 11), ElementsAre(0, 0, 0, 0, 0x21, 4, 0x2C, 1, 0x2C, 1, 0));
  firmware(frame, Info::FpgaMinor);
  EXPECT_THAT(bytes(frame, 4, 3), ElementsAre(0x03, 4, 0));
  read_state(frame);
  EXPECT_THAT(bytes(frame, 4, 3), ElementsAre(0x61, 1, 0));
  frame.fill(0xAA);
  alternate(frame, 1);
  EXPECT_THAT(bytes(frame, 4, 17),
              ElementsAre(0x44, 1, 0xF0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
  gpio(frame, 1);
  EXPECT_THAT(bytes(frame, 4, 3), ElementsAre(0xF1, 1, 0));
  modulation(frame, std::vector<std::uint8_t>{255, 7, 0}, 1, 40);
  EXPECT_THAT(bytes(frame, 4, 20), ElementsAre(0x10, 1 | 2 | 4 | 8, 3, 2, 40, 0, 0, 0, 0, 0, 0, 0,
                                               0, 0, 0, 0, 255, 7, 0, 0));
}

TEST(Autd3Frames, SplitASegmentIntoWholeSamples) {
  const FociSegment segment{.segment = 1,
                            .transition = Transition::Alternate,
                            .slots = 2,
                            .samples = 76,
                            .divider = 0x0102,
                            .sound_speed = 340.0};
  std::vector<SlotWord> words(152);
  std::iota(words.begin(), words.end(), SlotWord{0x0102030405060000});
  ASSERT_EQ(foci_frames(2, 76), 3);
  Frame frame;
  foci(frame, segment, words, 0);
  EXPECT_THAT(bytes(frame, 4, 24), ElementsAre(0x42, 1, 37, 1, 0xF0, 2, 0, 85, 2, 1, 0xFF, 0xFF, 0,
                                               0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0));
  EXPECT_THAT(bytes(frame, 28, 16), ElementsAre(0, 0, 6, 5, 4, 3, 2, 1, 1, 0, 6, 5, 4, 3, 2, 1));
  EXPECT_THAT(bytes(frame, 28 + 73 * 8, 9), ElementsAre(73, 0, 6, 5, 4, 3, 2, 1, 0));
  foci(frame, segment, words, 1);
  EXPECT_THAT(bytes(frame, 4, 6), ElementsAre(0x42, 0, 38, 1, 74, 0));
  foci(frame, segment, words, 2);
  EXPECT_THAT(bytes(frame, 4, 6), ElementsAre(0x42, 2 | 4, 1, 1, 150, 0));
  FociSegment later = segment;
  later.transition = Transition::Later;
  foci(frame, later, words, 0);
  EXPECT_EQ(frame[8], 0xFE);
  foci(frame, later, words, 2);
  EXPECT_EQ(frame[5], 2);
}

TEST(Autd3Frames, CountOfALoopIsThatOfTheBudget) {
  // a block of 10, 20 and 40 ms: 8 slots at 6.7 kHz, 4 at 13.3 kHz
  EXPECT_EQ(foci_frames(8, 67), 8);
  EXPECT_EQ(foci_frames(8, 133), 15);
  EXPECT_EQ(foci_frames(8, 267), 30);
  EXPECT_EQ(foci_frames(4, 133), 7 + 1);
  EXPECT_EQ(foci_frames(4, 267), 15);
  EXPECT_EQ(foci_frames(1, 74), 1);
  EXPECT_EQ(foci_frames(1, 75), 2);
}

}  // namespace
}  // namespace prostm::autd3
