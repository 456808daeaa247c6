/// Cost of one update of the whole pipeline, compared with the paper's arrangement: the computing
/// time from a hand to the samples of the 40 ms that follow, without waiting for a clock.

#include "prostm/core/stage_timer.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "report.hpp"

namespace prostm {
namespace {

constexpr int kWarmUp = 50, kUpdates = 400;  // a cycle of the scripted hand is 500 updates

PipelineSettings settings_of(const std::string& scene, bool papers) {
  PipelineSettings s;
  s.scene = scene;
  s.devices.of<SimulatedArraySettings>().realtime = false;
  if (papers) {
    s.fluid.solver = PressureMethod::Jacobi;
    s.plan.preset = Preset::Paper;
  }
  return s;
}

/// A pipeline and the costs of its updates [ms].
struct Line {
  explicit Line(const PipelineSettings& settings)
      : pipeline(settings, make_scripted_hand(settings.scripted_hand, settings.track)) {}

  void update(bool counts) {
    StageTimer timer;
    double world_time = 0.0;
    while (!pipeline.step(0.02)) world_time += pipeline.contact().world_time;
    const double seconds = timer.seconds();
    if (!counts) return;
    total.add(1e3 * seconds);
    fluid.add(1e3 * (world_time + pipeline.contact().world_time));
    plan.add(1e3 * pipeline.plan().stats.total);
  }

  Pipeline pipeline;
  Distribution total, fluid, plan;
};

std::vector<bench::Row> measure_updates() {
  std::vector<bench::Row> rows;
  for (const char* scene : {"one-plume", "four-plumes"}) {
    Line ours(settings_of(scene, false)), papers(settings_of(scene, true));
    for (int n = 0; n < kWarmUp + kUpdates; ++n) {
      ours.update(n >= kWarmUp);
      papers.update(n >= kWarmUp);
    }
    const std::string name = std::string("pipeline ") + scene + ": ",
                      other = "40 Jacobi sweeps, preset paper";
    rows.push_back(
        {name + "update of 40 ms", "ms", ours.total.summary(), other, papers.total.summary().p50});
    rows.push_back({name + "of it two fluid steps", "ms", ours.fluid.summary(), other,
                    papers.fluid.summary().p50});
    rows.push_back(
        {name + "of it the plan", "ms", ours.plan.summary(), other, papers.plan.summary().p50});
  }
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, prostm::measure_updates);
}
