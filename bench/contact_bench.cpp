/// Cost of making one update's targets from the smoke, as processor time of the one thread that
/// does it: on one moving hand, on two, and on two with interlocked fingers.
///
/// usage: contact_bench [--json FILE]

#include <ctime>
#include <string>
#include <vector>

#include "prostm/contact/skin_contact.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/fluid/fluid_pressure.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/track/hand_source.hpp"
#include "report.hpp"

namespace prostm {
namespace {

constexpr int kCells = 64, kUpdates = 400;
constexpr double kUpdate = 0.04;     // [s]
constexpr double kHandStart = 4.0;   // [s] into the scripted hand's cycle: it hovers, then lowers
constexpr double kFarApart = 0.150;  // distance between the hands [m]
constexpr double kInterlocked = 0.012;

double processor_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

/// Samples the scripted hand; if `apart` [m] is not 0, adds a second one beside it, 20 mm higher.
void sample(HandSource& source, double time, double apart, HandFrame& frame) {
  source.sample(time, frame);
  to_device(default_tracker_pose(), frame);
  if (apart == 0.0 || frame.hands.empty()) return;
  Hand other = frame.hands.front();
  ++other.id;
  for (Vec3& p : frame.hands.front().position) p.x() -= 0.5 * apart;
  for (Vec3& p : other.position) p += Vec3(0.5 * apart, 0.0, 0.02);
  frame.hands.push_back(other);
}

bench::Row contact_times(const std::string& name, double apart, double time_constant) {
  WorkerPool pool(2);
  FluidSettings fluid_settings;
  fluid_settings.cells = kCells;
  Fluid fluid(fluid_settings, scene_from_name("one-plume").smoke, pool);
  HandRasteriser rasteriser(fluid.grid());
  FluidPressureSettings settings;
  settings.time_constant = time_constant;
  FluidPressure pressure(settings, fluid.grid());
  SkinContact contact({}, fluid.grid());
  const auto source = make_scripted_hand({}, {});
  TargetFrame target;
  Distribution ms;
  for (int n = 0; n < kUpdates; ++n) {
    HandFrame frame;
    sample(*source, kHandStart + kUpdate * n, apart, frame);
    rasteriser.rasterise(frame, pool);
    if (n % 20 == 0) fluid.step(0.5 * kUpdate, rasteriser.raster());
    const double start = processor_ms();
    pressure.take(fluid.pressure(), fluid.fluid_cells(), kUpdate);
    contact.extract(pressure, rasteriser.raster(), frame, target);
    if (n > 0) ms.add(processor_ms() - start);
  }
  return {name, "ms", ms.summary(), "", 0.0};
}

std::vector<bench::Row> measure() {
  return {contact_times("contact 64^3, one hand", 0.0, 0.0),
          contact_times("contact 64^3, one hand, smoothed in time", 0.0, 0.1),
          contact_times("contact 64^3, two hands", kFarApart, 0.0),
          contact_times("contact 64^3, two hands interlocked", kInterlocked, 0.0)};
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, prostm::measure);
}
