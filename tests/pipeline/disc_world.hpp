#pragma once
/// A world that prostm does not have: a disc that presses evenly on the skin above the array.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "prostm/pipeline/world_kinds.hpp"

namespace prostm::test {

inline constexpr std::array<WorldScene, 2> kDiscScenes = {
    {{"disc", "A small disc", 0.5}, {"wide-disc", "A wide disc", 0.25}}};
inline constexpr std::array<WorldQuantity, 1> kDiscQuantities = {
    {{.name = "mean_pressed_area_cm2",
      .unit = "cm²",
      .help = "Skin under the disc, on the mean."}}};

class DiscWorld final : public World, public PressureSource {
 public:
  explicit DiscWorld(const PipelineSettings& settings)
      : radius_(settings.scene == kDiscScenes[0].name ? 0.02 : 0.03),
        pressure_(settings.scene == kDiscScenes[0].name ? 0.5 : 0.25) {}

  const GridShape& grid() const override { return grid_; }
  double full_scale_pressure() const override { return pressure_; }
  void meet(const HandRaster&) noexcept override {}
  const PressureSource& pressure(double) noexcept override { return *this; }
  void sample(std::span<const Vec3> p_D, const Vec3&,
              std::span<double> out) const noexcept override {
    std::ranges::transform(p_D, out.begin(), [&](const Vec3& p) {
      return (p - kCentre).head<2>().norm() < radius_ && p.z() < kCentre.z() ? pressure_ : 0.0;
    });
  }
  void observe_target(const HandFrame&, const TargetFrame& target, double) noexcept override {
    area_ = 0.0;
    for (const TargetField& patch : target.patches) {
      const auto pressed = std::ranges::count_if(patch.pressure, [](double p) { return p > 0.0; });
      area_ += 1e4 * patch.cell * patch.cell * static_cast<double>(pressed);
    }
  }
  WorldStats settle() noexcept override { return {false, {area_}}; }
  std::span<const WorldQuantity> quantities() const noexcept override { return kDiscQuantities; }

 private:
  inline static const Vec3 kCentre{0.0, 0.02, 0.23};
  GridShape grid_{64, 64, 64, 0.36 / 64, Vec3(-0.18, -0.18, 0.0)};
  double radius_, pressure_;
  double area_ = 0.0;  // for the last target [cm²]
};

/// Its row for a table of worlds.
inline constexpr WorldKind kDisc = {
    "disc", "a disc that presses evenly",
    []() -> std::span<const WorldScene> { return kDiscScenes; },
    [](const PipelineSettings& settings, WorkerPool&) -> std::unique_ptr<World> {
      return std::make_unique<DiscWorld>(settings);
    }};

}  // namespace prostm::test
