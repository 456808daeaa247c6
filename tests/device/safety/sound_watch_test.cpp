#include "prostm/device/safety/sound_watch.hpp"

#include <gtest/gtest.h>

#include "emit/paths.hpp"
#include "prostm/core/random.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "support/heap_guard.hpp"

namespace prostm {
namespace {

constexpr double kRate = 40e3;

/// An emission of one method with its plans and its chain, and whether each sample is silent.
class Output {
 public:
  Output(Method method, double am_frequency, int decimation, int block)
      : rate_(kRate / decimation), block_(block), watch(mute, rate_) {
    EmitSettings settings = test::settings_for(2);
    settings.am_frequency = am_frequency;
    emitter_ = make_emitter(method, settings, kRate);
    DeviceInfo device;
    device.sample_rate = rate_;
    device.decimation = decimation;
    device.intensity_per_focus = true;
    chain_ = make_sample_chain(*emitter_, device, {});
    emitter_->obey(mute);
    chain_->obey(mute);
    chain_->show(watch);
    method_ = method;
  }

  /// @param fed whether new plans arrive.
  void play(double seconds, bool fed = true) {
    const auto blocks = static_cast<int>(seconds * rate_ / block_);
    for (int i = 0; i < blocks; ++i) {
      if (fed) plan();
      std::vector<FocusSample> out(static_cast<std::size_t>(2 * block_));
      const test::HeapGuard guard;
      chain_->fill(samples(), out);
      EXPECT_EQ(guard.allocations(), 0U);
      for (int s = 0; s < block_; ++s) {
        const auto at = static_cast<std::size_t>(2 * s);
        sounds.push_back(out[at].intensity > 0.0F || out[at + 1].intensity > 0.0F);
      }
    }
  }
  std::int64_t samples() const { return static_cast<std::int64_t>(sounds.size()); }
  std::vector<SoundChange> changes() {
    std::vector<SoundChange> all;
    while (const SoundChange* change = watch.front()) {
      all.push_back(*change);
      watch.pop();
    }
    return all;
  }
  /// Finds the changes by a search of the samples; silences shorter than `gap` belong to a sound.
  std::vector<std::int64_t> searched(double gap) const {
    std::vector<std::int64_t> found;
    std::int64_t last = -1;
    for (std::int64_t i = 0; i < samples(); ++i) {
      if (!sounds[static_cast<std::size_t>(i)]) continue;
      if (last < 0 || static_cast<double>(i - last) > gap * rate_) {
        if (last >= 0) found.push_back(last + 1);
        found.push_back(i);
      }
      last = i;
    }
    if (last >= 0 && static_cast<double>(samples() - last) > gap * rate_) found.push_back(last + 1);
    return found;
  }

 private:
  void plan() {
    LiftedPlan& plan = emitter_->draft();
    plan.paths.clear();
    plan.foci.clear();
    if (method_ == Method::Am) {
      plan.foci.push_back({Vec3(0.0, 0.01, 0.2), 0.5});
    } else {
      plan.paths.push_back(test::ring(Vec3(0.0, 0.0, 0.2), 0.08, 24, 0.5));
    }
    emitter_->submit();
  }

  double rate_;
  int block_;
  Method method_{};
  std::unique_ptr<Emitter> emitter_;
  std::unique_ptr<SampleChain> chain_;

 public:
  std::shared_ptr<Mute> mute = std::make_shared<Mute>();
  SoundWatch watch;
  std::vector<bool> sounds;
};

struct Case {
  Method method;
  double am_frequency;
  int decimation, block;
};

class SoundWatchOf : public testing::TestWithParam<Case> {};

TEST_P(SoundWatchOf, ReportsTheChangesThatASearchFinds) {
  const Case c = GetParam();
  Output output(c.method, c.am_frequency, c.decimation, c.block);
  Random random(7);
  output.mute->set(MuteReason::Study, true);
  output.play(0.2);
  EXPECT_TRUE(output.changes().empty());
  for (std::uint64_t label = 1; label <= 6; ++label) {
    output.watch.label(label);
    output.mute->set(MuteReason::Study, false);
    output.play(0.3 + 0.1 * random.uniform());
    output.mute->set(MuteReason::Study, true);
    output.watch.label(99);  // the label of the next sound, as when a study has continued
    output.play(0.07 + 0.1 * random.uniform());
  }
  const std::vector<SoundChange> told = output.changes();
  const std::vector<std::int64_t> searched = output.searched(0.05);
  ASSERT_EQ(told.size(), 12U);
  ASSERT_EQ(searched.size(), 12U);
  for (std::size_t i = 0; i < told.size(); ++i) {
    EXPECT_EQ(told[i].sample, searched[i]) << i;
    EXPECT_EQ(told[i].on, i % 2 == 0);
    EXPECT_EQ(told[i].label, i / 2 + 1);
    EXPECT_EQ(told[i].stream, 1);
  }
  EXPECT_EQ(output.watch.lost(), 0);
}

INSTANTIATE_TEST_SUITE_P(
    Emissions, SoundWatchOf,
    testing::Values(Case{Method::Am, 200.0, 1, 40}, Case{Method::Am, 25.0, 1, 40},
                    Case{Method::Am, 100.0, 10, 20}, Case{Method::ProStm, 200.0, 1, 40},
                    Case{Method::ProStm, 200.0, 1, 257}, Case{Method::ProStm, 200.0, 10, 20}));

TEST(SoundWatch, EndsWithoutAMuteIfPlansStopArriving) {
  Output output(Method::ProStm, 200.0, 1, 40);
  output.play(0.3);
  output.play(0.4, false);
  const std::vector<SoundChange> told = output.changes();
  const std::vector<std::int64_t> searched = output.searched(0.05);
  ASSERT_EQ(told.size(), 2U);
  ASSERT_EQ(searched.size(), 2U);
  EXPECT_EQ(told[1].sample, searched[1]);
}

TEST(SoundWatch, EndsAfterTheLastSampleOfADeviceThatStops) {
  Output output(Method::ProStm, 200.0, 1, 40);
  output.play(0.3);
  output.watch.end();
  EXPECT_EQ(output.watch.stream(), 2);
  const std::vector<SoundChange> told = output.changes();
  ASSERT_EQ(told.size(), 2U);
  EXPECT_FALSE(told[1].on);
  EXPECT_EQ(told[1].sample, output.samples());
  EXPECT_EQ(told[1].stream, 1);
}

TEST(SoundWatch, ReportsWhetherAllIsReadAndCountsLostChanges) {
  Output output(Method::ProStm, 200.0, 1, 40);
  output.play(0.1);
  EXPECT_TRUE(output.watch.is_read()) << "there is no reader";
  output.watch.begin_reading();
  EXPECT_FALSE(output.watch.is_read());
  EXPECT_EQ(output.changes().size(), 1U);
  EXPECT_TRUE(output.watch.is_read());
  std::vector<FocusSample> loud(1), silent(1);
  loud[0].intensity = 0.5F;
  SoundWatch watch(output.mute, kRate);
  std::int64_t sample = 0;
  for (int i = 0; i < 200; ++i) {
    watch.look(sample++, loud, 1);
    for (int s = 0; s < 4000; ++s) watch.look(sample++, silent, 1);
  }
  EXPECT_EQ(watch.lost(), 400 - 256);
}

}  // namespace
}  // namespace prostm
