#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "prostm/track/hand_source.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kStep = 0.02;

struct Noise {
  double position = 0, velocity = 0;            // rms of a coordinate [m], [m/s]
  double position_step = 0, velocity_step = 0;  // rms change between frames
};

/// Measures the remainder of 0.3 mm of tracking noise on a still hand.
Noise noise_of(const TrackSettings& track) {
  ScriptedHandSettings settings;
  settings.still = true;
  const HandFrame rest = [&] {
    HandFrame frame;
    make_scripted_hand(settings, track)->sample(0.0, frame);
    return frame;
  }();
  settings.jitter = 3e-4;
  const auto source = make_scripted_hand(settings, track);
  HandFilter filter(track);
  HandFrame frame, last;
  Noise noise;
  int count = 0;
  for (int i = 0; i < 1000; ++i) {
    source->sample(kStep * i, frame);
    filter.apply(kStep, frame);
    if (i >= 100) {
      for (std::size_t j = 0; j < kJointCount; ++j, ++count) {
        noise.position +=
            (frame.hands[0].position[j] - rest.hands[0].position[j]).squaredNorm() / 3;
        noise.velocity += frame.hands[0].velocity[j].squaredNorm() / 3;
        noise.position_step +=
            (frame.hands[0].position[j] - last.hands[0].position[j]).squaredNorm() / 3;
        noise.velocity_step +=
            (frame.hands[0].velocity[j] - last.hands[0].velocity[j]).squaredNorm() / 3;
      }
    }
    last = frame;
  }
  for (double* x : {&noise.position, &noise.velocity, &noise.position_step, &noise.velocity_step}) {
    *x = std::sqrt(*x / count);
  }
  return noise;
}

TEST(HandFilter, RemovesTheNoiseOfAHandAtRest) {
  TrackSettings open;
  open.filter_position = open.filter_velocity = 1.0;
  const Noise raw = noise_of(open), filtered = noise_of({});
  RecordProperty("position_noise_ratio", std::to_string(filtered.position / raw.position));
  RecordProperty("velocity_noise_ratio", std::to_string(filtered.velocity / raw.velocity));
  // the air reacts to changes of the skin's velocity, so these must be filtered
  EXPECT_LT(filtered.velocity_step, 0.25 * raw.velocity_step);
  EXPECT_LT(filtered.velocity, 0.45 * raw.velocity);
  EXPECT_LT(filtered.position_step, 0.45 * raw.position_step);
  EXPECT_LT(filtered.position, 0.60 * raw.position);
}

TEST(HandFilter, FollowsSteadyMotionWithoutLag) {
  HandFilter filter{TrackSettings()};
  HandFrame frame;
  const Vec3 velocity(0.2, -0.1, 0.05);
  for (int i = 0; i < 200; ++i) {
    frame.hands.clear();
    frame.hands.emplace_back();
    frame.hands[0].position.fill(kStep * i * velocity);
    frame.hands[0].velocity.fill(velocity);
    frame.hands[0].orientation.fill(Quat::Identity());
    filter.apply(kStep, frame);
  }
  EXPECT_LT((frame.hands[0].position[kPalm] - kStep * 199 * velocity).norm(), 1e-9);
  EXPECT_LT((frame.hands[0].velocity[kPalm] - velocity).norm(), 1e-9);
}

TEST(HandFilter, OpensForFastMotion) {
  // the largest lag over a swing of 60 mm at 1.5 Hz: an acceleration of 5.3 m/s²
  HandFilter filter{TrackSettings()};
  constexpr double kOmega = 2 * 3.14159 * 1.5, kAmplitude = 0.06;
  double lag = 0.0;
  for (int i = 0; i < 200; ++i) {
    HandFrame frame;
    frame.hands.emplace_back();
    const Vec3 p(kAmplitude * std::sin(kOmega * kStep * i), 0, 0);
    frame.hands[0].position.fill(p);
    frame.hands[0].velocity.fill(Vec3(kAmplitude * kOmega * std::cos(kOmega * kStep * i), 0, 0));
    frame.hands[0].orientation.fill(
        Quat(Eigen::AngleAxisd(0.5 * std::sin(kOmega * kStep * i), Vec3::UnitZ())));
    filter.apply(kStep, frame);
    lag = std::max(lag, (frame.hands[0].position[kPalm] - p).norm());
  }
  EXPECT_LT(lag, 0.004);
}

TEST(HandFilter, ANewHandStartsUnfilteredAndAReturningHandIsNew) {
  HandFilter filter{TrackSettings()};
  const auto frame_of = [](std::int64_t id, double x) {
    HandFrame frame;
    frame.hands.emplace_back();
    frame.hands[0].id = id;
    frame.hands[0].position.fill(Vec3(x, 0, 0));
    frame.hands[0].velocity.fill(Vec3::Zero());
    frame.hands[0].orientation.fill(Quat::Identity());
    return frame;
  };
  HandFrame frame = frame_of(1, 0.0);
  filter.apply(kStep, frame);
  frame = frame_of(1, 0.001);
  filter.apply(kStep, frame);
  EXPECT_LT(frame.hands[0].position[kPalm].x(), 0.0005);
  frame = frame_of(2, 0.001);
  filter.apply(kStep, frame);
  EXPECT_EQ(frame.hands[0].position[kPalm].x(), 0.001);
  frame = HandFrame();
  filter.apply(kStep, frame);
  frame = frame_of(2, 0.5);
  filter.apply(kStep, frame);
  EXPECT_EQ(frame.hands[0].position[kPalm].x(), 0.5);
}

TEST(HandFilter, DoesNotAllocate) {
  ScriptedHandSettings settings;
  settings.jitter = 3e-4;
  const auto source = make_scripted_hand(settings, {});
  HandFilter filter{TrackSettings()};
  HandFrame frame;
  test::HeapGuard guard;
  for (int i = 0; i < 300; ++i) {
    source->sample(kStep * i, frame);
    filter.apply(kStep, frame);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(HandFilter, RejectsFactorsOutOfBounds) {
  for (const double bad : {0.0, -0.1, 1.5}) {
    TrackSettings settings;
    settings.filter_position = bad;
    EXPECT_THROW(HandFilter{settings}, std::invalid_argument) << bad;
    settings = {};
    settings.filter_velocity = bad;
    EXPECT_THROW(HandFilter{settings}, std::invalid_argument) << bad;
  }
}

}  // namespace
}  // namespace prostm
