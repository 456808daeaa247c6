#include "prostm/pipeline/world.hpp"

#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/pipeline/scene.hpp"

namespace prostm {
namespace {

class Smoke final : public World {
 public:
  Smoke(const PipelineSettings& settings, WorkerPool& pool)
      : scene_(scene_from_name(settings.scene)),
        waits_for_hand_(settings.jets.place == JetPlace::Hand),
        fluid_(settings.fluid, scene_.smoke, pool),
        pressure_(settings.fluid_pressure, fluid_.grid()),
        placed_(scene_.smoke),
        blown_(scene_.smoke),
        trim_(settings.jets, scene_.smoke.jets.size()) {}

  const GridShape& grid() const override { return fluid_.grid(); }
  double full_scale_pressure() const override { return scene_.full_scale_pressure; }
  void prepare(double dt) noexcept override {
    if (changed_) blow();
    fluid_.prepare(dt);
  }
  void meet(const HandRaster& raster) noexcept override { fluid_.meet(raster); }
  WorldStats settle() noexcept override {
    const FluidStats stats = fluid_.settle();
    return {stats.divergence_rms, stats.reset};
  }
  const PressureSource& pressure(double dt) noexcept override {
    pressure_.take(fluid_.pressure(), fluid_.fluid_cells(), dt);
    return pressure_;
  }
  void hear(const HandFrame& hands, const TargetFrame& target, double dt) noexcept override {
    if (waits_for_hand_ && !hands.hands.empty()) {
      place_ = place_under(palm_of(hands.hands.front()));
      placed_ = placed(scene_.smoke, place_);
      waits_for_hand_ = false;
      changed_ = true;
    }
    changed_ = trim_.update(target, placed_.jets, dt) || changed_;
  }
  void go_on_from(const World& other) override {
    const Fluid* before = other.fluid();
    if (before != nullptr && before->grid() == grid()) fluid_.copy_state(*before);
  }
  const Fluid* fluid() const override { return &fluid_; }
  const ScenePlace* place() const override { return &place_; }

 private:
  /// Takes over a new place and new gains.
  void blow() {
    blown_ = placed_;
    for (std::size_t q = 0; q < blown_.jets.size(); ++q) blown_.jets[q].speed *= trim_.gains()[q];
    fluid_.set_inflow(blown_);
    changed_ = false;
  }

  const Scene& scene_;
  bool waits_for_hand_;  // to blow under it
  ScenePlace place_;
  Fluid fluid_;
  FluidPressure pressure_;
  SmokeInflow placed_, blown_;  // under the hand, and with the trim's gains
  JetTrim trim_;
  bool changed_ = false;  // since the fluid was told
};

}  // namespace

std::unique_ptr<World> make_smoke(const PipelineSettings& settings, WorkerPool& pool) {
  return std::make_unique<Smoke>(settings, pool);
}

}  // namespace prostm
