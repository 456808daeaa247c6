#pragma once
/// The world that the hands meet: smoke, or anything else that presses on them.

#include <memory>
#include <optional>

#include "prostm/contact/pressure_source.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/hand/hand_raster.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/target/target_field.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// How a step went.
struct WorldStats {
  double divergence = 0.0;  ///< of a fluid: rms that is left, over that before its pressure solve
  /// of a fluid: estimated error of its pressure beside hands, relative (F16)
  double pressure_error = 0.0;
  bool reset = false;  ///< it went wrong (a number was not finite), and began anew at rest
};

/// Steps in three parts, so that the hands may come late: prepare, meet, settle, in this order and
/// on one thread. Nothing of it throws or allocates once it is made.
class World {
 public:
  virtual ~World() = default;
  /// On which hands are rasterised and their skin is looked for. Its corner may move by whole cells
  /// in prepare(), and nothing else of it ever changes.
  virtual const GridShape& grid() const = 0;
  /// The pressure of a target that maps to full output [Pa].
  virtual double full_scale_pressure() const = 0;

  /// Does the part of a step of dt that needs no hands [s].
  virtual void prepare(double dt) noexcept { static_cast<void>(dt); }
  /// The hands, made for grid(), are there.
  virtual void meet(const HandRaster& raster) noexcept = 0;
  /// Returns the pressure on the skin now. @param dt since the last call [s].
  virtual const PressureSource& pressure(double dt) noexcept = 0;
  /// The parts of that pressure, where they are known apart. @pre pressure() was called.
  virtual std::optional<PressureParts> parts() const { return {}; }
  /// Hears what the hands got, before settle(). @param target made from pressure().  @param dt
  /// since the last call [s].
  virtual void hear(const HandFrame& hands, const TargetFrame& target, double dt) noexcept {
    static_cast<void>(hands), static_cast<void>(target), static_cast<void>(dt);
  }
  /// Does the rest of the step, for which nobody waits.
  virtual WorldStats settle() noexcept { return {}; }

  /// Goes on from where another world is, as far as the two are alike. @pre between steps.
  virtual void go_on_from(const World& other) { static_cast<void>(other); }
  /// Where the scene is, and the pressure that it is meant to make there; none for a world that is
  /// no stimulus.
  virtual std::optional<PlacedStimulus> stimulus() const { return {}; }
  /// The smoke, where there is some.
  virtual const Fluid* fluid() const { return nullptr; }
};

/// The smoke of the settings' scene. @param pool outlives it.
/// @throws std::invalid_argument with a sentence.
std::unique_ptr<World> make_smoke(const PipelineSettings& settings, WorkerPool& pool);

}  // namespace prostm
