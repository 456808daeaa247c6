#pragma once
/// The pressure that an array puts on the skin when it plays a plan.

#include <memory>
#include <vector>

#include "prostm/acoustics/array/array.hpp"
#include "prostm/acoustics/skin/skin_response.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/plan/plan.hpp"
#include "prostm/score/loop_drives.hpp"
#include "prostm/target/target_field.hpp"

namespace prostm::bench {

/// Radiation pressure on a raster over a loop [Pa]; 0 off the skin.
struct Pressed {
  double period = 0.0;           ///< of the loop [s]
  int parts = 0;                 ///< equal parts of the loop, of 0.2 ms
  std::vector<double> pressure;  ///< mean over each part: parts × cells
  std::vector<double> envelope;  ///< largest of all samples of the loop, one per cell

  PressureLoop loop() const { return {period, parts, pressure}; }
};

/// An array that plays plans as `prostm field` does: solver Weighted, emission with its default
/// settings at 40 kHz, transducers with memory. Serves one thread.
class Player {
 public:
  explicit Player(const TransducerArray& array);

  /// Computes the drives. @throws InputError for a plan without pressure, or with a loop that is
  /// too long for its percept to be computed.
  LoopDriveResult play(const Plan& plan, const TargetField& target);
  /// Computes the pressure on a hand that has moved by `shift` in its plane [m].
  Pressed press(const LoopDriveResult& drives, const TargetField& target, const Vec2& shift);

 private:
  Medium medium_;
  TransducerArray array_;
  PackedArray packed_;
  std::unique_ptr<WorkerPool> pool_;
};

}  // namespace prostm::bench
