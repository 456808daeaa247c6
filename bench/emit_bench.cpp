/// Cost of the emission per block, and whether the simulated array is fed in time on an idle and on
/// a busy machine.
///
/// usage: emit_bench [--json FILE]

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "prostm/core/distribution.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/core/units.hpp"
#include "prostm/device/detail/slot_encoder.hpp"
#include "prostm/device/safety/sample_chain.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/emit/detail/path_emitter.hpp"
#include "prostm/fields/moving_foci.hpp"
#include "report.hpp"

namespace prostm {
namespace {

using bench::Row;

constexpr int kFoci = 4;
constexpr double kRate = 40e3;      // [Hz]
constexpr std::size_t kBlock = 40;  // samples
constexpr int kBlocksPerPlan = 40;  // 25 plans a second

/// Makes four loops of 140 mm in 100 points each; their centres drift by `drift` [m] per plan.
void make_plan(Random& random, std::vector<Vec3>& centres, double drift, LiftedPlan& plan) {
  plan.paths.clear();
  ++plan.id;
  for (Vec3& centre : centres) {
    centre += drift * Vec3(random.normal(), random.normal(), 0.0);
    plan.paths.emplace_back();
    LiftedPath& path = plan.paths.back();
    path.speed = 7.0;
    for (int i = 0; i < 100; ++i) {
      const double a = 2.0 * kPi * i / 100.0;
      path.p_D.push_back(centre + 0.140 / (2.0 * kPi) * Vec3(std::cos(a), std::sin(a), 0.0));
      path.pressure.push_back(0.6 + 0.4 * std::cos(a));
    }
  }
}

/// Makes four foci whose places drift in the same way.
void make_foci(Random& random, std::vector<Vec3>& centres, double drift, LiftedPlan& plan) {
  plan.foci.clear();
  ++plan.id;
  for (Vec3& centre : centres) {
    centre += drift * Vec3(random.normal(), random.normal(), 0.0);
    plan.foci.push_back({centre, 0.6});
  }
}

EmitSettings emit_settings() {
  EmitSettings settings;
  settings.foci = kFoci;
  settings.full_scale_pressure = 1.0;
  return settings;
}

std::vector<Vec3> centres() {
  std::vector<Vec3> out;
  for (int i = 0; i < kFoci; ++i) out.emplace_back(0.05 * (i - 1.5), 0.0, 0.2);
  return out;
}

/// Measures the cost of fill() [µs], separately for blocks with a new plan and for the others.
template <class MakePlan>
void measure_fill(Method method, const MakePlan& make, Distribution& without, Distribution& with) {
  const auto emitter = make_emitter(method, emit_settings(), kRate);
  std::vector<FocusSample> block(kBlock * kFoci);
  Random random(1);
  std::vector<Vec3> places = centres();
  std::int64_t first = 0;
  for (int plan = 0; plan < 2000; ++plan) {
    make(random, places, 2e-3, emitter->draft());
    emitter->submit();
    for (int k = 0; k < kBlocksPerPlan; ++k) {
      const StageTimer timer;
      emitter->fill(first, block);
      (k == 0 ? with : without).add(1e6 * timer.seconds());
      first += static_cast<std::int64_t>(kBlock);
    }
  }
}

/// Measures the time of the chain to a device per sample of 4 focal points [ns], from the time of
/// blocks: the emission alone, with a limiter that knows no array, and with the full limiter.
void add_limiter_rows(std::vector<Row>& rows) {
  const auto levels = std::make_shared<const SafetyLevels>(usx_array(), Medium{}, 0.5);
  SafetySettings low;
  low.mean_radiation_pressure = 100.0;
  const std::pair<const char*, SampleLimits> kinds[] = {
      {"emission and a limiter without levels", {}},
      {"emission and the limiter", {.levels = levels}},
      {"emission and the limiter at a cap", {.caps = low, .levels = levels}}};
  const auto measure = [](Emitter& emitter, SampleSource& source) {
    Distribution ns;
    std::vector<FocusSample> block(kBlock * kFoci);
    Random random(1);
    std::vector<Vec3> places = centres();
    std::int64_t first = 0;
    for (int plan = 0; plan < 2000; ++plan) {
      make_plan(random, places, 2e-3, emitter.draft());
      emitter.submit();
      for (int k = 0; k < kBlocksPerPlan; ++k) {
        const StageTimer timer;
        source.fill(first, block);
        if (k > 0) ns.add(1e9 * timer.seconds() / static_cast<double>(kBlock));
        first += static_cast<std::int64_t>(kBlock);
      }
    }
    return ns.summary();
  };
  PathEmitter alone(emit_settings(), kRate);
  rows.push_back({"a sample: emission alone", "ns", measure(alone, alone), "", 0.0});
  for (const auto& [name, limits] : kinds) {
    PathEmitter emitter(emit_settings(), kRate);
    SampleChain chain(emitter, limits);
    rows.push_back({std::string("a sample: ") + name, "ns", measure(emitter, chain), "", 0.0});
  }
  Distribution made;  // [ms]
  for (int i = 0; i < 20; ++i) {
    const StageTimer timer;
    const FocusLevels table(usx_array());
    made.add(1e3 * timer.seconds());
  }
  rows.push_back({"table of levels, usx", "ms", made.summary(), "", 0.0});
}

/// Measures the time for AUTD3's slots per sample of 4 moving focal points [us], which lasts 150
/// us; in turn with transducers with memory, and without memory as at 1 Hz.
void add_slot_rows(std::vector<Row>& rows) {
  constexpr double kSlotRate = 40e3 / 6.0;  // [Hz]
  const std::array units{autd3_middle()};
  SlotEncoder with(units, Medium{}, {.foci = kFoci, .sample_rate = kSlotRate});
  SlotEncoder without(units, Medium{}, {.foci = kFoci, .sample_rate = 1.0});
  const fields::MovingFoci moving(1, kFoci, 0.03);
  std::array<SlotWord, 2 * kFoci> words;
  Distribution with_memory, without_memory;
  for (int s = 0; s < 40'000; ++s) {
    std::array<FocusSample, kFoci> sample;
    for (int f = 0; f < kFoci; ++f) {
      const double time = s / kSlotRate;
      sample[static_cast<std::size_t>(f)] = {moving.position(f, time).cast<float>(),
                                             static_cast<float>(moving.amplitude(f, time))};
    }
    for (const auto& [encoder, us] :
         {std::pair(&with, &with_memory), {&without, &without_memory}}) {
      const StageTimer timer;
      encoder->encode(sample, words);
      us->add(1e6 * timer.seconds());
    }
  }
  rows.push_back({"slots of AUTD3", "us", with_memory.summary(), "", 0.0});
  rows.push_back({"slots of AUTD3, no memory", "us", without_memory.summary(), "", 0.0});
}

/// Streams for ten seconds in real time, 25 plans a second, with `busy` threads that never sleep.
DeviceStats stream(unsigned busy) {
  std::atomic<bool> done{false};
  std::vector<std::jthread> load;
  for (unsigned i = 0; i < busy; ++i) {
    load.emplace_back([&] {
      while (!done.load(std::memory_order_relaxed)) {
      }
    });
  }
  SimulatedArray array(SimulatedArraySettings(), usx_array(), Medium());
  PathEmitter emitter(emit_settings(), kRate);
  Random random(1);
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

/// Adds the cost of a block of 40 samples of 4 focal points.
void add_fill_rows(std::vector<Row>& rows) {
  Distribution steady, with_plan, foci;  // [µs]
  measure_fill(Method::ProStm, make_plan, steady, with_plan);
  // a new plan takes over in whichever block has a zero of the envelope
  measure_fill(Method::Am, make_foci, foci, foci);
  rows.push_back({"fill", "us", steady.summary(), "", 0.0});
  rows.push_back({"fill with a new plan", "us", with_plan.summary(), "", 0.0});
  rows.push_back({"fill, am, new plans among them", "us", foci.summary(), "", 0.0});
}

/// Counts how many of the 10,000 blocks of ten seconds are late or missed.
void add_stream_rows(unsigned busy, const std::string& load, std::vector<Row>& rows) {
  const DeviceStats stats = stream(busy);
  Distribution late, missed;
  late.add(static_cast<double>(stats.late_blocks));
  missed.add(static_cast<double>(stats.missed_blocks));
  rows.push_back({"late in 10 s, " + load, "blocks", late.summary(), "", 0.0});
  rows.push_back({"missed in 10 s, " + load, "blocks", missed.summary(), "", 0.0});
}

std::vector<Row> measure_emission() {
  std::vector<Row> rows;
  add_fill_rows(rows);
  add_limiter_rows(rows);
  add_slot_rows(rows);
  add_stream_rows(0, "idle", rows);
  add_stream_rows(std::thread::hardware_concurrency(), "all cores busy", rows);
  return rows;
}

}  // namespace
}  // namespace prostm

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, prostm::measure_emission);
}
