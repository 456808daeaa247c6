/// What the emission costs per block, and whether the simulated array is fed in time, alone and on
/// a busy machine.
///
/// usage: emit_bench [--json FILE]

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/distribution.hpp"
#include "core/random.hpp"
#include "core/stage_timer.hpp"
#include "core/units.hpp"
#include "device/simulated_array.hpp"
#include "emit/path_emitter.hpp"

namespace {

using prostm::Summary;
using prostm::Vec3;

constexpr int kFoci = 4;
constexpr double kRate = 40e3;      // [Hz]
constexpr std::size_t kBlock = 40;  // samples
constexpr int kBlocksPerPlan = 40;  // 25 plans a second

/// Four loops of 140 mm in 100 points, at places that drift by `drift` [m] a plan.
void make_plan(prostm::Random& random, std::vector<Vec3>& centres, double drift,
               prostm::LiftedPlan& plan) {
  plan.paths.clear();
  ++plan.id;
  for (Vec3& centre : centres) {
    centre += drift * Vec3(random.normal(), random.normal(), 0.0);
    plan.paths.emplace_back();
    prostm::LiftedPath& path = plan.paths.back();
    path.speed = 7.0;
    for (int i = 0; i < 100; ++i) {
      const double a = 2.0 * prostm::kPi * i / 100.0;
      path.p_D.push_back(centre +
                         0.140 / (2.0 * prostm::kPi) * Vec3(std::cos(a), std::sin(a), 0.0));
      path.pressure.push_back(0.6 + 0.4 * std::cos(a));
    }
  }
}

prostm::EmitSettings emit_settings() {
  prostm::EmitSettings settings;
  settings.foci = kFoci;
  settings.full_scale_pressure = 1.0;
  return settings;
}

std::vector<Vec3> centres() {
  std::vector<Vec3> out;
  for (int i = 0; i < kFoci; ++i) out.emplace_back(0.05 * (i - 1.5), 0.0, 0.2);
  return out;
}

/// Cost of fill() [s], of blocks with a new plan and of the others.
void measure_fill(Summary& steady, Summary& with_plan) {
  prostm::PathEmitter emitter(emit_settings(), kRate);
  std::vector<prostm::FocusSample> block(kBlock * kFoci);
  prostm::Random random(1);
  std::vector<Vec3> places = centres();
  prostm::Distribution without, with;
  std::int64_t first = 0;
  for (int plan = 0; plan < 2000; ++plan) {
    make_plan(random, places, 2e-3, emitter.draft());
    emitter.submit();
    for (int k = 0; k < kBlocksPerPlan; ++k) {
      const prostm::StageTimer timer;
      emitter.fill(first, block);
      (k == 0 ? with : without).add(timer.seconds());
      first += static_cast<std::int64_t>(kBlock);
    }
  }
  steady = without.summary();
  with_plan = with.summary();
}

/// Ten seconds in real time with 25 plans a second, beside `busy` threads that never sleep.
prostm::DeviceStats stream(unsigned busy) {
  std::atomic<bool> done{false};
  std::vector<std::jthread> load;
  for (unsigned i = 0; i < busy; ++i) {
    load.emplace_back([&] {
      while (!done.load(std::memory_order_relaxed)) {
      }
    });
  }
  prostm::SimulatedArray array(prostm::SimulatedArraySettings(), prostm::usx_array(),
                               prostm::Medium());
  prostm::PathEmitter emitter(emit_settings(), kRate);
  prostm::Random random(1);
  std::vector<Vec3> places = centres();
  array.start(emitter);
  for (int plan = 0; plan < 250; ++plan) {
    make_plan(random, places, 2e-3, emitter.draft());
    emitter.submit();
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
  }
  array.stop();
  done = true;
  return array.stats();
}

std::string row(const char* name, const char* unit, const Summary& s, double scale) {
  fmt::print("{:<28} {:>8} {:>10} {:>10.2f} {:>10.2f} {:>10.2f}\n", name, unit, s.n, scale * s.p50,
             scale * s.p99, scale * s.max);
  return fmt::format(
      R"({{"name":"{}","unit":"{}","n":{},"p50":{},"p99":{},"max":{},"baseline":null,"baseline_p50":null,"ratio":null}})",
      name, unit, s.n, scale * s.p50, scale * s.p99, scale * s.max);
}

std::string row(const char* name, std::int64_t blocks, std::int64_t count) {
  fmt::print("{:<28} {:>8} {:>10} {:>10} {:>10} {:>10}\n", name, "blocks", blocks, "", "", count);
  return fmt::format(
      R"({{"name":"{}","unit":"blocks","n":{},"p50":null,"p99":null,"max":{},"baseline":null,"baseline_p50":null,"ratio":null}})",
      name, blocks, count);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 1 && !(argc == 3 && std::strcmp(argv[1], "--json") == 0)) {
    fmt::print(stderr, "emit_bench takes --json FILE and nothing else\n");
    return 2;
  }
  fmt::print("{:<28} {:>8} {:>10} {:>10} {:>10} {:>10}\n", "name", "unit", "n", "p50", "p99",
             "max");

  // cost of a block of 40 samples of 4 focal points
  Summary steady, with_plan;
  measure_fill(steady, with_plan);
  std::string json = "[" + row("fill", "us", steady, 1e6);
  json += ",\n" + row("fill with a new plan", "us", with_plan, 1e6);

  // late and missed blocks of ten seconds
  const prostm::DeviceStats idle = stream(0);
  json += ",\n" + row("late, idle", idle.blocks, idle.late_blocks);
  json += ",\n" + row("missed, idle", idle.blocks, idle.missed_blocks);
  const prostm::DeviceStats busy = stream(std::thread::hardware_concurrency());
  json += ",\n" + row("late, all cores busy", busy.blocks, busy.late_blocks);
  json += ",\n" + row("missed, all cores busy", busy.blocks, busy.missed_blocks);

  if (argc == 3) {
    std::ofstream file(argv[2]);
    file << json << "]\n";
    file.close();
    if (!file) {
      fmt::print(stderr, "cannot write {}\n", argv[2]);
      return 2;
    }
  }
  return 0;
}
