// A world of another program, in the whole pipeline.
#include <gtest/gtest.h>

#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/pipeline.hpp"

namespace prostm {
namespace {

/// A plate that presses evenly on all skin below it.
class Plate final : public World, public PressureSource {
 public:
  const GridShape& grid() const override { return grid_; }
  double full_scale_pressure() const override { return 2.0; }
  void meet(const HandRaster&) noexcept override {}
  const PressureSource& pressure(double) noexcept override { return *this; }
  void sample(std::span<const Vec3> p_D, const Vec3&,
              std::span<double> out) const noexcept override {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = p_D[i].z() < 0.23 ? 2.0 : 0.0;
  }

 private:
  GridShape grid_{64, 64, 64, 0.36 / 64, Vec3(-0.18, -0.18, 0.0)};
};

TEST(OtherWorld, IsRendered) {
  PipelineSettings settings;
  settings.devices.of<SimulatedArraySettings>().realtime = false;
  Pipeline pipeline(settings, make_scripted_hand(settings.scripted_hand, settings.track),
                    std::make_shared<Mute>(), nullptr, std::make_unique<Plate>());
  double most = 0.0;
  for (int n = 0; n < 150; ++n) {
    if (pipeline.step(0.02) && pipeline.plan().status == PlanStatus::Planned)
      most = std::max(most, max_pressure(pipeline.contact().target.patches.at(0)));
  }
  EXPECT_EQ(most, 2.0);
  EXPECT_TRUE(pipeline.world_stage().world().quantities().empty());
  EXPECT_GT(pipeline.emit_stats().laps_started, 100);
}

}  // namespace
}  // namespace prostm
