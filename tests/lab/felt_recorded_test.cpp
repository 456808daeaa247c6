/// Sequences from recordings.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "felt/recorded.hpp"
#include "prostm/fields/felt_fields.hpp"
#include "prostm/io/recorder.hpp"
#include "support/input_errors.hpp"
#include "support/shared.hpp"

namespace prostm::bench {
namespace {

/// Returns a target whose raster is shifted by some cells, and whose pressure is a plane through
/// 1 Pa at the origin, plus `more`.
TargetField sloped(int shift, double more) {
  TargetField field = fields::felt_field(fields::FeltKind::Plume, 1, fields::Outline::Hand);
  field.origin += field.cell * Vec2(shift, -shift);
  for (std::size_t i = 0; i < field.size(); ++i) {
    const Vec2 x = field.position(i);
    field.pressure[i] = field.skin[i] != 0 ? 1.0 + more + 2.0 * x.x() + 3.0 * x.y() : 0.0;
  }
  return field;
}

/// Records frames, by default every 20 ms; the one with index `without` has no hand.
std::string recorded(const test::TemporaryFolder& folder, int frames, int without,
                     double apart = 0.02) {
  const std::string path = folder.file("run.h5");
  Recorder recorder(path, {});
  for (int i = 0; i < frames; ++i) {
    TargetFrame frame;
    frame.time = apart * i;
    if (i != without) frame.patches.push_back(sloped(i % 3, 0.01 * i));
    HandFrame hands;
    hands.time = frame.time;
    recorder.append(frame, hands, nullptr);
  }
  recorder.close();
  return path;
}

TEST(FeltLab, RecordedSequencesHaveOneRasterAndTheRecordedPressure) {
  const test::TemporaryFolder folder;
  const auto all = recorded_sequences(recorded(folder, 170, 60), 8);
  // 0 to 1 s, and two seconds from the frame after the gap at 1.2 s
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[1].name, "from 1.22 s");
  for (const LiveSequence& sequence : all) {
    ASSERT_EQ(sequence.targets.size(), 25u);
    const TargetField& first = sequence.targets.front();
    for (std::size_t k = 0; k < sequence.targets.size(); ++k) {
      const TargetField& target = sequence.targets[k];
      ASSERT_EQ(target.skin, first.skin);
      ASSERT_EQ(target.origin, first.origin);
    }
  }
  const TargetField& last = all[0].targets.back();
  const auto middle = last.index(last.rows / 2, last.cols / 2);
  const Vec2 x = last.position(middle);
  ASSERT_EQ(last.skin[middle], 1);
  EXPECT_NEAR(last.pressure[middle], 1.0 + 0.01 * 48 + 2.0 * x.x() + 3.0 * x.y(), 1e-6);
  EXPECT_EQ(recorded_sequences(folder.file("run.h5"), 1).front().name, "from 1.22 s");
}

TEST(FeltLab, ARecordingWithoutAWholeSecondIsRejected) {
  const test::TemporaryFolder folder;
  const std::string path = recorded(folder, 60, 30);
  EXPECT_THAT(test::input_error([&] { recorded_sequences(path, 8); }),
              testing::HasSubstr("no second has a hand with pressure in every frame"));
}

TEST(FeltLab, ARecordingWithFewerFramesThanPlansIsRejected) {
  const test::TemporaryFolder folder;
  const std::string path = recorded(folder, 60, -1, 0.1);
  EXPECT_THAT(test::input_error([&] { recorded_sequences(path, 0); }),
              testing::HasSubstr("25 frames or more"));
}

TEST(FeltLab, EachPlanGetsTheNearestFrame) {
  const test::TemporaryFolder folder;
  const auto all = recorded_sequences(recorded(folder, 40, -1, 1.0 / 30.0), 0);
  ASSERT_EQ(all.size(), 1u);
  const auto& targets = all[0].targets;
  const auto middle = targets[0].index(targets[0].rows / 2, targets[0].cols / 2);
  for (int k = 0; k < kLivePlans; ++k) {
    const int nearest = static_cast<int>(std::lround(0.04 * k * 30.0));
    const double more =
        targets[static_cast<std::size_t>(k)].pressure[middle] - targets[0].pressure[middle];
    ASSERT_NEAR(more, 0.01 * nearest, 1e-6) << k;
  }
}

}  // namespace
}  // namespace prostm::bench
