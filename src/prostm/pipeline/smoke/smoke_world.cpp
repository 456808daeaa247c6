#include "prostm/pipeline/smoke/smoke_world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "prostm/core/units.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/pipeline/smoke/box_follow.hpp"
#include "prostm/pipeline/smoke/scene.hpp"

namespace prostm {
namespace {

constexpr std::array<WorldQuantity, 2> kQuantities = {
    {{.name = "mean_relative_divergence",
      .help = "Mean residual divergence of the fluid's pressure solve, relative.",
      .words = "the solver left {} of the divergence"},
     {.name = "mean_pressure_error",
      .help = "Mean estimated relative error of the fluid's pressure at hands.",
      .words = "an error of about {} % in the pressure at the hand",
      .words_scale = 100.0}}};

/// Splits the pressure: the part of the hands' own movement is computed in still air; the smoke's
/// part is the remainder.
struct PartsApart {
  PartsApart(const PipelineSettings& settings, WorkerPool& pool)
      : still_air(settings.fluid, SmokeInflow(), pool),
        smoke(settings.fluid_pressure, still_air.grid()),
        movement(settings.fluid_pressure, still_air.grid()),
        rest(still_air.grid().cell_count()) {}
  /// Splits the pressure of `all`, the fluid with smoke around the same hands.
  void take(const Fluid& all, double dt) {
    for (FluidPressure* part : {&smoke, &movement}) part->move_to(all.grid().p_DF);
    const std::span<const float> own = still_air.pressure();
    std::transform(all.pressure().begin(), all.pressure().end(), own.begin(), rest.begin(),
                   std::minus<>());
    smoke.take(rest, all.fluid_cells(), dt);
    movement.take(own, all.fluid_cells(), dt);
  }

  Fluid still_air;
  FluidPressure smoke, movement;
  std::vector<float> rest;  // the smoke's part, one value per cell [Pa]
};

class SmokeWorld final : public World {
 public:
  SmokeWorld(const PipelineSettings& settings, WorkerPool& pool)
      : scene_(scene_from_name(settings.scene)),
        settings_(settings.jets),
        waits_for_hand_(settings_.place == JetPlace::Hand),
        fluid_(settings.fluid, scene_.smoke, pool),
        follower_(settings.box, fluid_.grid()),
        pressure_(settings.fluid_pressure, fluid_.grid()),
        placed_(scene_.smoke),
        blown_(scene_.smoke),
        trim_(settings.jets, scene_.smoke.jets.size()),
        part_(settings.fluid_pressure.part) {
    if (part_ == PressurePart::All && !settings.fluid_pressure.parts) return;
    apart_.emplace(settings, pool);
    parts_ = {{{"smoke", &apart_->smoke}, {"movement", &apart_->movement}}};
    changed_ = true;
  }

  const GridShape& grid() const override { return fluid_.grid(); }
  double full_scale_pressure() const override { return scene_.full_scale_pressure; }
  void prepare(double dt) noexcept override {
    time_ += dt;
    if (changed_ || scene_.pulse.depth > 0.0) blow();
    const CellShift shift = follower_.shift(hands_, fluid_.grid());
    fluid_.prepare(dt);
    fluid_.move_box(shift);
    if (!apart_) return;
    apart_->still_air.prepare(dt);
    apart_->still_air.move_box(shift);
  }
  void meet(const HandRaster& raster) noexcept override {
    fluid_.meet(raster);
    if (apart_) apart_->still_air.meet(raster);
  }
  WorldStats settle() noexcept override {
    const FluidStats stats = fluid_.settle();
    const bool reset = apart_ && apart_->still_air.settle().reset;
    return {stats.reset || reset, {stats.divergence_rms, stats.pressure_error}};
  }
  const PressureSource& pressure(double dt) noexcept override {
    pressure_.move_to(fluid_.grid().p_DF);
    pressure_.take(fluid_.pressure(), fluid_.fluid_cells(), dt);
    if (!apart_) return pressure_;
    apart_->take(fluid_, dt);
    return part_ == PressurePart::All     ? pressure_
           : part_ == PressurePart::Smoke ? apart_->smoke
                                          : apart_->movement;
  }
  std::span<const NamedPressure> parts() const noexcept override {
    if (!apart_) return {};
    return parts_;
  }
  void observe_target(const HandFrame& hands, const TargetFrame& target,
                      double dt) noexcept override {
    hands_ = hands;
    if (waits_for_hand_ && !hands.hands.empty()) {
      blow_at(place_under(palm_of(hands.hands.front())));
      waits_for_hand_ = false;
    }
    changed_ = trim_.update(target, placed_.jets, dt) || changed_;
  }
  std::span<const WorldQuantity> quantities() const noexcept override { return kQuantities; }
  SeenRow seen_row(int j, int k) const noexcept override {
    const GridShape& g = fluid_.grid();
    return {fluid_.smoke_row(j, k),
            fluid_.fluid_cells().subspan(g.cell_index(0, j, k), static_cast<std::size_t>(g.nx))};
  }
  void continue_from(const World& other) override {
    const auto* smoke = dynamic_cast<const SmokeWorld*>(&other);
    if (smoke == nullptr) return;
    continue_from(smoke->fluid_);
    if (apart_ && smoke->apart_ && smoke->apart_->still_air.grid() == apart_->still_air.grid())
      apart_->still_air.copy_state(smoke->apart_->still_air);
    if (&smoke->scene_ != &scene_) return;
    // keeps the place and the gains found so far, whatever else has changed
    if (smoke->settings_.place == settings_.place) {
      waits_for_hand_ = smoke->waits_for_hand_;
      blow_at(smoke->place_);
    }
    time_ = smoke->time_;
    if (settings_.trim_rate > 0.0) trim_.set_gains(smoke->trim_.gains());
    changed_ = true;
  }
  std::optional<PlacedStimulus> stimulus() const override {
    if (scene_.stimulus.maxima == 0) return {};
    const double speed = fluid_.settings().jet_speed;
    return PlacedStimulus{scene_.stimulus.scaled(place_.size, speed), place_};
  }

 private:
  /// Copies the air if the grids agree except for their position.
  void continue_from(const Fluid& before) {
    GridShape there = fluid_.grid();
    there.p_DF = before.grid().p_DF;
    if (!(there == before.grid())) return;
    const CellShift by = whole_cells(there.p_DF - fluid_.grid().p_DF, there.cell);
    fluid_.move_box(by);
    fluid_.copy_state(before);
    if (apart_) apart_->still_air.move_box(by);
  }
  void blow_at(const ScenePlace& place) {
    place_ = place;
    move_to(place, scene_.smoke, placed_);
    changed_ = true;
  }
  /// Applies the place, the gains and the pulse to the jets.
  void blow() {
    const ScenePulse& pulse = scene_.pulse;
    const double swell = 1.0 + pulse.depth * std::sin(2.0 * kPi * pulse.rate * time_);
    blown_ = placed_;
    for (std::size_t q = 0; q < blown_.jets.size(); ++q)
      blown_.jets[q].speed *= swell * trim_.gains()[q];
    fluid_.set_inflow(blown_);
    if (apart_) apart_->still_air.set_inflow({{}, 0.0, blown_.viscosity});
    changed_ = false;
  }

  const Scene& scene_;
  JetSettings settings_;
  bool waits_for_hand_;  // before placing the jets under it
  ScenePlace place_;
  Fluid fluid_;
  BoxFollower follower_;
  HandFrame hands_;  // hands of the last target
  FluidPressure pressure_;
  SmokeInflow placed_, blown_;  // placed_: at the place; blown_: also with gains and pulse
  JetTrim trim_;
  PressurePart part_;
  std::optional<PartsApart> apart_;
  std::array<NamedPressure, 2> parts_ = {};  // parts of apart_
  double time_ = 0.0;                        // since the scene began [s]
  bool changed_ = false;  // jets changed since they were last passed to the fluid
};

}  // namespace

bool is_smoke(const PipelineSettings& settings) {
  return settings.world == kSmokeWorld;
}

std::span<const WorldScene> smoke_world_scenes() {
  static const std::vector<WorldScene> kScenes = [] {
    std::vector<WorldScene> all;
    for (const Scene& scene : scenes())
      all.push_back({scene.name, scene.label, scene.full_scale_pressure});
    return all;
  }();
  return kScenes;
}

std::unique_ptr<World> make_smoke_world(const PipelineSettings& settings, WorkerPool& pool) {
  return std::make_unique<SmokeWorld>(settings, pool);
}

}  // namespace prostm
