#include "felt/played.hpp"

#include <stdexcept>

#include "prostm/core/input_error.hpp"
#include "prostm/emit/loop_samples.hpp"
#include "prostm/score/felt.hpp"
#include "prostm/score/plan_percept.hpp"

namespace prostm::bench {
namespace {

constexpr double kRate = 40e3;  // sample rate [Hz]

}  // namespace

Player::Player(const TransducerArray& array)
    : array_(array), packed_(array, medium_), pool_(std::make_unique<WorkerPool>(1)) {}

LoopDriveResult Player::play(const Plan& plan, const TargetField& target) {
  TargetFrame frame;
  frame.patches.push_back(target);
  LoopDriveResult drives;
  try {
    const LoopSamples loop = plan_loop(plan, frame, EmitSettings(), kRate);
    if (!is_felt(target, loop))
      throw InputError("a plan's loop is too long for its percept to be computed");
    loop_drives(
        array_, medium_, loop, {}, [](int, int) { return true; }, drives);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
  return drives;
}

Pressed Player::press(const LoopDriveResult& drives, const TargetField& target, const Vec2& shift) {
  SkinSurface skin = skin_surface(target);
  const Vec3 moved = target.X_DP.linear() * Vec3(shift.x(), shift.y(), 0.0);
  for (Vec3& p : skin.points.p_D) p += moved;
  Pressed out;
  const auto samples = static_cast<int>(drives.output.cols());
  out.period = samples / kRate;
  out.parts = samples / kLoopUnit;
  const LoopPressure found = loop_pressure(
      packed_, medium_, LoopBasis(packed_, drives.output, *pool_), skin.points, out.parts, *pool_);
  const auto parts = static_cast<std::size_t>(out.parts);
  out.pressure.assign(parts * target.size(), 0.0);
  out.envelope.assign(target.size(), 0.0);
  for (std::size_t m = 0; m < skin.cell.size(); ++m) {
    out.envelope[skin.cell[m]] = static_cast<double>(found.envelope[m]);
    for (std::size_t k = 0; k < parts; ++k) {
      out.pressure[k * target.size() + skin.cell[m]] =
          static_cast<double>(found.frame[m * parts + k]);
    }
  }
  return out;
}

}  // namespace prostm::bench
