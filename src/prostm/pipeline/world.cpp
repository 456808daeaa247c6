#include "prostm/pipeline/world.hpp"

#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/pipeline/scene.hpp"

namespace prostm {
namespace {

class Smoke final : public World {
 public:
  Smoke(const PipelineSettings& settings, WorkerPool& pool)
      : scene_(scene_from_name(settings.scene)),
        settings_(settings.jets),
        waits_for_hand_(settings_.place == JetPlace::Hand),
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
    return {stats.divergence_rms, stats.pressure_error, stats.reset};
  }
  const PressureSource& pressure(double dt) noexcept override {
    pressure_.take(fluid_.pressure(), fluid_.fluid_cells(), dt);
    return pressure_;
  }
  void hear(const HandFrame& hands, const TargetFrame& target, double dt) noexcept override {
    if (waits_for_hand_ && !hands.hands.empty()) {
      blow_at(place_under(palm_of(hands.hands.front())));
      waits_for_hand_ = false;
    }
    changed_ = trim_.update(target, placed_.jets, dt) || changed_;
  }
  void go_on_from(const World& other) override {
    const Fluid* before = other.fluid();
    if (before != nullptr && before->grid() == grid()) fluid_.copy_state(*before);
    const auto* smoke = dynamic_cast<const Smoke*>(&other);
    if (smoke == nullptr || &smoke->scene_ != &scene_) return;
    // a place and gains that were found stay, whatever else was changed
    if (smoke->settings_.place == settings_.place) {
      waits_for_hand_ = smoke->waits_for_hand_;
      blow_at(smoke->place_);
    }
    if (settings_.trim_rate > 0.0) trim_.set_gains(smoke->trim_.gains());
    changed_ = true;
  }
  const Fluid* fluid() const override { return &fluid_; }
  std::optional<PlacedStimulus> stimulus() const override {
    if (scene_.stimulus.maxima == 0) return {};
    const double speed = fluid_.settings().jet_speed;
    return PlacedStimulus{scene_.stimulus.scaled(place_.size, speed), place_};
  }

 private:
  void blow_at(const ScenePlace& place) {
    place_ = place;
    move_to(place, scene_.smoke, placed_);
    changed_ = true;
  }
  /// Takes over a new place and new gains.
  void blow() {
    blown_ = placed_;
    for (std::size_t q = 0; q < blown_.jets.size(); ++q) blown_.jets[q].speed *= trim_.gains()[q];
    fluid_.set_inflow(blown_);
    changed_ = false;
  }

  const Scene& scene_;
  JetSettings settings_;
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
