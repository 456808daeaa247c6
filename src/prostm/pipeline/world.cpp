#include "prostm/pipeline/world.hpp"

#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/pipeline/scene.hpp"

namespace prostm {
namespace {

class Smoke final : public World {
 public:
  Smoke(const PipelineSettings& settings, WorkerPool& pool)
      : scene_(scene_from_name(settings.scene)),
        fluid_(settings.fluid, scene_.smoke, pool),
        pressure_(settings.fluid_pressure, fluid_.grid()) {}

  const GridShape& grid() const override { return fluid_.grid(); }
  double full_scale_pressure() const override { return scene_.full_scale_pressure; }
  void prepare(double dt) noexcept override { fluid_.prepare(dt); }
  void meet(const HandRaster& raster) noexcept override { fluid_.meet(raster); }
  WorldStats settle() noexcept override {
    const FluidStats stats = fluid_.settle();
    return {stats.divergence_rms, stats.reset};
  }
  const PressureSource& pressure(double dt) noexcept override {
    pressure_.take(fluid_.pressure(), fluid_.fluid_cells(), dt);
    return pressure_;
  }
  void go_on_from(const World& other) override {
    const Fluid* before = other.fluid();
    if (before != nullptr && before->grid() == grid()) fluid_.copy_state(*before);
  }
  const Fluid* fluid() const override { return &fluid_; }

 private:
  const Scene& scene_;
  Fluid fluid_;
  FluidPressure pressure_;
};

}  // namespace

std::unique_ptr<World> make_smoke(const PipelineSettings& settings, WorkerPool& pool) {
  return std::make_unique<Smoke>(settings, pool);
}

}  // namespace prostm
