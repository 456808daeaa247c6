// A device of your own, and the samples that it receives.
#include <cstdio>
#include <prostm/prostm.hpp>

#include "two_bumps.hpp"

using namespace prostm;

/// Takes blocks of 20 ms at 4000 samples a second, with one intensity for all focal points.
class PrintedArray final : public Device {
 public:
  PrintedArray() {
    info_ = {.name = "printed", .sample_rate = 4e3, .block_samples = 80, .max_foci = 4};
    info_.loads_segments = true;
    info_.keeps_time = false;  // it plays when pull() is called
    info_.decimation = 10;     // from the 40000 samples a second of an emitter
  }
  DeviceStatus load_segment(std::span<const FocusSample> samples, int foci) override {
    const FocusSample& last = samples.back();
    std::printf("%zu values for %d focal points, the last (%.0f, %.0f, %.0f) mm at %.2f\n",
                samples.size(), foci, 1e3 * last.p_D.x(), 1e3 * last.p_D.y(), 1e3 * last.p_D.z(),
                last.intensity);
    return DeviceStatus::Running;
  }
  const DeviceInfo& info() const override { return info_; }
  DeviceStatus status() const override { return DeviceStatus::Running; }
  std::string problem() const override { return {}; }
  DeviceStatus start(SampleSource&) override { return DeviceStatus::Refused; }  // has no stream
  void stop() override {}
  DeviceStats stats() const override { return {}; }
  std::int64_t samples() const override { return 0; }
  double play_time(std::int64_t) const override { return 0.0; }

 private:
  DeviceInfo info_;
};

int main() {
  TargetFrame frame;
  frame.patches.push_back(two_bumps());
  Plan plan;
  PlanStats stats;
  Planner({}, frame.patches[0].size()).plan(frame, plan, stats);

  const auto device = as_stream(std::make_unique<PrintedArray>());
  EmitSettings emission;
  emission.full_scale_pressure = 2.0;  // pressure played at intensity 1
  const auto emitter = make_emitter(Method::ProStm, emission, device->info().emission_rate());
  lift(plan, frame, emitter->draft());
  emitter->submit();

  // data for the caps on the output of the array, for a head half a metre away
  const auto levels = std::make_shared<const SafetyLevels>(usx_array(), Medium{}, 0.5);
  const auto chain = make_sample_chain(*emitter, device->info(), {.levels = levels});
  device->start(*chain);  // loads the first 20 ms
  device->pull(5);        // plays these and four more blocks: 100 ms without a new plan
  device->stop();
}
