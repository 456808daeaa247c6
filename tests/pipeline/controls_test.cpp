/// The table of controls, and pipelines whose settings change between steps.

#include "prostm/pipeline/controls.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "pipeline/simulated.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/device/simulated/simulated_array.hpp"
#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/snapshot.hpp"

namespace prostm {
namespace {

LiveSettings small_settings() {
  LiveSettings s;
  s.pipeline.fluid.cells = 32;
  s.pipeline.devices.of<SimulatedArraySettings>().realtime = false;
  s.pipeline.devices.of<SimulatedArraySettings>().history = 0.1;
  s.pipeline.scripted_hand.still = true;
  s.source = "scripted";
  s.sources = {"scripted", "page"};
  return s;
}

Pipeline pipeline_of(const LiveSettings& s) {
  return Pipeline(s.pipeline, make_scripted_hand(s.pipeline.scripted_hand, s.pipeline.track));
}

TEST(Controls, HaveDistinctIdsAndHelpTexts) {
  std::set<std::string_view> ids;
  for (const RunControl& c : run_controls()) {
    SCOPED_TRACE(c.id);
    EXPECT_TRUE(ids.insert(c.id).second);
    EXPECT_FALSE(c.group.empty() || c.label.empty() || c.help.empty());
    EXPECT_LT(c.low, c.high);
    EXPECT_GT(c.step, 0.0);
    EXPECT_EQ(c.choices.empty(), c.kind != ControlKind::Choice);
    EXPECT_EQ(&run_controls()[static_cast<std::size_t>(control_index(c.id))], &c);
  }
  EXPECT_EQ(control_index("no such"), -1);
}

// a value can be read back, and the defaults lie within the bounds
TEST(Controls, ReturnTheValueSet) {
  for (const RunControl& c : run_controls()) {
    SCOPED_TRACE(c.id);
    LiveSettings s = small_settings();
    EXPECT_GE(c.get(s), c.low);
    EXPECT_LE(c.get(s), c.high);
    for (const double value : {c.low, c.high}) {
      const auto place = static_cast<std::size_t>(value);
      if (c.available != nullptr && !c.available(s, place)) continue;
      c.set(s, value);
      EXPECT_NEAR(c.get(s), value, 1e-9);
    }
  }
}

TEST(Controls, AcceptTheRightKindOfValueWithinBounds) {
  const LiveSettings s = small_settings();
  const auto number_of = [&](const char* id, const ControlValue& value) {
    return control_number(run_controls()[static_cast<std::size_t>(control_index(id))], value, s);
  };
  EXPECT_EQ(number_of("gain", 2.0), 2.0);
  EXPECT_EQ(number_of("prediction", true), 1.0);
  EXPECT_EQ(number_of("method", std::string("am")), 1.0);
  EXPECT_THROW(number_of("gain", 99.0), InputError);
  EXPECT_THROW(number_of("gain", true), InputError);
  EXPECT_THROW(number_of("gain", std::string("2")), InputError);
  EXPECT_THROW(number_of("paths", 2.5), InputError);
  EXPECT_THROW(number_of("prediction", 1.0), InputError);
  EXPECT_THROW(number_of("method", std::string("AM")), InputError);
  EXPECT_THROW(number_of("method", 1.0), InputError);
  EXPECT_NO_THROW(number_of("source", std::string("page")));
  EXPECT_THROW(number_of("source", std::string("leap")), InputError) << "there is no tracker";
}

// sets every control to both of its bounds in a running pipeline
TEST(Controls, APipelineTakesEveryOneBetweenSteps) {
  LiveSettings s = small_settings();
  Pipeline pipeline = pipeline_of(s);
  for (int i = 0; i < 4; ++i) pipeline.step(0.02);
  for (const RunControl& c : run_controls()) {
    SCOPED_TRACE(c.id);
    for (const double value : {c.low, c.high}) {
      LiveSettings wanted = s;
      c.set(wanted, value);
      ASSERT_NO_THROW(pipeline.reconfigure(wanted.pipeline));
    }
    ASSERT_NO_THROW(pipeline.reconfigure(s.pipeline));
  }
  pipeline.step(0.02);
  EXPECT_EQ(pipeline.contact().step, 5);
}

/// Results of 0.1 s of a run: the samples played, and the last plan.
struct Outcome {
  std::vector<FocusSample> played;
  Plan plan;
};

/// Returns the outcome until 1.5 s of a run that gets the settings `wanted` at 1.3 s. Its device
/// restarts there in any case, so that samples are comparable.
Outcome outcome_of(const LiveSettings& from, LiveSettings wanted) {
  Pipeline pipeline = pipeline_of(from);
  for (int i = 0; i < 65; ++i) pipeline.step(0.02);
  wanted.pipeline.emit.stall_time *= 1.01;
  pipeline.reconfigure(wanted.pipeline);
  for (int i = 0; i < 10; ++i) pipeline.step(0.02);
  const SimulatedArray& device = test::simulated(pipeline);
  return {device.read_back(device.samples() - 4000, 4000), pipeline.plan().plan};
}

double mean_pressure(const FocalPath& path) {
  return std::accumulate(path.pressure.begin(), path.pressure.end(), 0.0) /
         static_cast<double>(path.pressure.size());
}

/// Returns the largest differences of two runs, in the samples' intensities and positions, and in
/// paths' pressures [1, m, Pa].
double difference(const Outcome& one, const Outcome& other) {
  const std::vector<FocusSample>&a = one.played, &b = other.played;
  if (a.size() != b.size() || one.plan.paths.size() != other.plan.paths.size()) return 1.0;
  double most = 0.0;
  for (std::size_t k = 0; k < one.plan.paths.size(); ++k)
    most = std::max(
        most, std::abs(mean_pressure(one.plan.paths[k]) - mean_pressure(other.plan.paths[k])));
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(a[i].intensity - b[i].intensity)));
    for (int axis = 0; axis < 3; ++axis)
      most = std::max(most, std::abs(static_cast<double>(a[i].p_D[axis] - b[i].p_D[axis])));
  }
  return most;
}

// every control changes the plan or its emission, except the source of hands, their prediction,
// which the source handles, and quantities computed in addition to the plan
TEST(Controls, EachChangesThePlanOrTheOutput) {
  for (const Method method : {Method::ProStm, Method::Am}) {
    LiveSettings s = small_settings();
    s.pipeline.method = method;
    s.pipeline.scripted_hand.still = false;
    const Outcome as_it_was = outcome_of(s, s);
    EXPECT_EQ(difference(as_it_was, outcome_of(s, s)), 0.0) << "runs must be repeatable";
    for (const RunControl& c : run_controls()) {
      if (c.group == "Hand" || c.id == "parts" || !c.enabled(s)) continue;
      LiveSettings wanted = s;
      c.set(wanted, c.get(s) == c.low ? c.high : c.low);
      EXPECT_GT(difference(as_it_was, outcome_of(s, wanted)), 1e-4)
          << name_of(method) << ": " << c.id;
    }
  }
}

const RunControl& control_of(const char* id) {
  return run_controls()[static_cast<std::size_t>(control_index(id))];
}

// otherwise a page's change would be rejected
TEST(Controls, EveryPresetIsAccepted) {
  for (const Preset preset :
       {Preset::Paper, Preset::PaperValid, Preset::Best, Preset::Fast, Preset::Felt}) {
    LiveSettings s = small_settings();
    Pipeline pipeline = pipeline_of(s);
    control_of("preset").set(s, static_cast<double>(preset));
    EXPECT_NO_THROW(pipeline.reconfigure(s.pipeline));
    EXPECT_EQ(control_of("strength_weight").enabled(s), preset == Preset::Felt);
    EXPECT_FALSE(control_of("am_felt_weight").enabled(s));
  }
}

// a new plan is in step from the next update on, and no longer with another preset
TEST(Controls, ThePresetCanBeChangedInARun) {
  LiveSettings s = small_settings();
  Pipeline pipeline = pipeline_of(s);
  for (int i = 0; i < 65; ++i) pipeline.step(0.02);
  for (const Preset preset : {Preset::Felt, Preset::Fast, Preset::Felt}) {
    control_of("preset").set(s, static_cast<double>(preset));
    pipeline.reconfigure(s.pipeline);
    while (!pipeline.step(0.02)) {
    }
    ASSERT_EQ(pipeline.plan().status, PlanStatus::Planned);
    EXPECT_EQ(pipeline.plan().plan.loop > 0.0, preset == Preset::Felt);
  }
}

TEST(Controls, TheFeltWeightOfAmDelaysFoci) {
  LiveSettings s = small_settings();
  Pipeline pipeline = pipeline_of(s);
  for (int i = 0; i < 65; ++i) pipeline.step(0.02);
  control_of("method").set(s, static_cast<double>(Method::Am));
  const auto late = [&] {
    pipeline.reconfigure(s.pipeline);
    while (!pipeline.step(0.02)) {
    }
    const FocalPoints& foci = pipeline.plan().plan.foci;
    return std::any_of(foci.begin(), foci.end(), [](const FocalPoint& f) { return f.phase > 0.0; });
  };
  EXPECT_FALSE(late());
  control_of("am_felt_weight").set(s, 0.9);
  EXPECT_TRUE(late());
}

TEST(Controls, BothPartsOfThePressureCanBeTurnedOnAndOff) {
  LiveSettings s = small_settings();
  Pipeline pipeline = pipeline_of(s);
  const RunControl& parts = control_of("parts");
  for (const double on : {0.0, 1.0, 0.0}) {
    parts.set(s, on);
    pipeline.reconfigure(s.pipeline);
    for (int i = 0; i < 10; ++i) pipeline.step(0.02);
    const TargetField& target = pipeline.contact().target.patches.at(0);
    EXPECT_EQ(target.smoke.size(), on > 0.0 ? target.size() : 0U);
    EXPECT_EQ(target.movement.size(), target.smoke.size());
  }
}

std::vector<float> smoke_of(const World& world) {
  std::vector<float> out;
  for (int k = 0; k < world.grid().nz; ++k) {
    for (int j = 0; j < world.grid().ny; ++j) {
      const auto row = world.seen_row(j, k).density;
      out.insert(out.end(), row.begin(), row.end());
    }
  }
  return out;
}

TEST(Reconfigure, ChangesThePlanAndKeepsTheSmoke) {
  LiveSettings s = small_settings();
  Pipeline pipeline = pipeline_of(s);
  for (int i = 0; i < 60; ++i) pipeline.step(0.02);
  ASSERT_EQ(pipeline.plan().status, PlanStatus::Planned);
  ASSERT_GT(pipeline.plan().plan.paths.size(), 2U);
  const std::int64_t blocks = pipeline.device_stats().blocks;
  const std::int64_t updates = pipeline.plan().id;
  const auto smoke = [&] { return smoke_of(pipeline.world_stage().world()); };
  const std::vector<float> before = smoke();

  s.pipeline.plan.paths = 2;
  s.pipeline.fluid.jet_speed = 0.5;
  pipeline.reconfigure(s.pipeline);
  EXPECT_EQ(smoke(), before);
  while (!pipeline.step(0.02)) {
  }
  EXPECT_EQ(pipeline.plan().id, updates + 1);
  EXPECT_LE(pipeline.plan().plan.paths.size(), 2U);
  EXPECT_GE(pipeline.device_stats().blocks, blocks) << "counters continue";

  s.pipeline.method = Method::Am;
  pipeline.reconfigure(s.pipeline);
  pipeline.step(0.02);
  EXPECT_FALSE(pipeline.plan().plan.foci.empty());
}

TEST(Reconfigure, RebuildsOnAnyDifferenceAndNotWithoutOne) {
  const LiveSettings s = small_settings();
  Pipeline pipeline = pipeline_of(s);
  for (int i = 0; i < 20; ++i) pipeline.step(0.02);
  const std::int64_t played = pipeline.device().samples();
  pipeline.reconfigure(s.pipeline);
  EXPECT_EQ(pipeline.device().samples(), played) << "nothing is rebuilt";
  PipelineSettings other = s.pipeline;
  other.plan.gain *= 1.0 + 1e-9;
  pipeline.reconfigure(other);
  EXPECT_EQ(pipeline.device().samples(), 0) << "another planner and emitter";
}

TEST(Reconfigure, ARejectedChangeLeavesEverythingUnchanged) {
  const LiveSettings s = small_settings();
  Pipeline pipeline = pipeline_of(s);
  for (int i = 0; i < 40; ++i) pipeline.step(0.02);
  PipelineSettings bad = s.pipeline;
  bad.plan.speed = 1000.0;
  EXPECT_THROW(pipeline.reconfigure(bad), std::invalid_argument);
  bad = s.pipeline;
  bad.scene = "no such";
  EXPECT_THROW(pipeline.reconfigure(bad), std::invalid_argument);
  SimulatedFaults faults;
  faults.refuse = true;
  test::simulated(pipeline).set_faults(faults);
  EXPECT_EQ(pipeline.device().status(), DeviceStatus::Running);
  test::simulated(pipeline).set_faults({});
  bool planned = false;
  for (int i = 0; i < 4; ++i) planned = pipeline.step(0.02) || planned;
  EXPECT_TRUE(planned);
  EXPECT_EQ(pipeline.plan().status, PlanStatus::Planned);
  EXPECT_EQ(pipeline.device().status(), DeviceStatus::Running);
}

TEST(VolumeView, AveragesBlocks) {
  for (const int cells : {32, 33, 48, 64, 80, 96, 100, 131}) {
    SCOPED_TRACE(cells);
    WorkerPool pool(1);
    PipelineSettings settings;
    settings.scene = "four-plumes";
    settings.fluid.cells = cells;
    const std::unique_ptr<World> world = make_world(settings, pool);
    HandRasteriser hands(world->grid());
    hands.rasterise({}, pool);
    for (int i = 0; i < 10; ++i) {
      world->prepare(0.02);
      world->meet(hands.raster());
      world->settle();
    }
    VolumeView view;
    view_volume(*world, view);
    ASSERT_LE(view.n, kVolumeViewCells);
    EXPECT_GT(view.n, kVolumeViewCells / 2);
    EXPECT_NEAR(view.edge, settings.fluid.width, 1e-12);
    const auto edge = [&](int i) { return i * cells / view.n; };
    const auto cell_mean = [&](int i, int j, int k) {
      double sum = 0.0, count = 0.0;
      for (int z = edge(k); z < edge(k + 1); ++z)
        for (int y = edge(j); y < edge(j + 1); ++y)
          for (int x = edge(i); x < edge(i + 1); ++x, ++count)
            sum += static_cast<double>(world->seen_row(y, z).density[static_cast<std::size_t>(x)]);
      return 255.0 * sum / count;
    };
    int brightest = 0;
    for (int k = 0; k < view.n; k += 3) {
      for (int j = 0; j < view.n; ++j) {
        for (int i = 0; i < view.n; ++i) {
          const int value = view.density[static_cast<std::size_t>((k * view.n + j) * view.n + i)];
          EXPECT_NEAR(value, std::min(cell_mean(i, j, k), 255.0), 0.51);
          brightest = std::max(brightest, value);
        }
      }
    }
    EXPECT_GT(brightest, 50);
  }
}

}  // namespace
}  // namespace prostm
