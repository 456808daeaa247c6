/// Cost of a moving hand on the grid and of a step of the smoke with it, and the error of its
/// pressure on the hand against a converged solve.
///
/// usage: fluid_bench [--json FILE]

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "prostm/core/distribution.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/core/worker_pool.hpp"
#include "prostm/fluid/fluid.hpp"
#include "prostm/hand/hand_raster.hpp"
#include "prostm/pipeline/smoke/scene.hpp"
#include "prostm/track/hand_source.hpp"
#include "report.hpp"

namespace {

using prostm::Distribution;
using prostm::Fluid;
using prostm::FluidSettings;
using prostm::HandRaster;
using prostm::Summary;
using prostm::bench::Row;

constexpr int kThreads = 2;
constexpr double kStep = 0.02;  // [s]
constexpr int kHistory = 200;   // compared steps
constexpr int kWarmUp = 50;     // steps before the first measured one
constexpr int kTimedSteps = 300;
constexpr double kHandStart = 4.0;  // [s] into the scripted hand's cycle: it hovers, then lowers
constexpr int kExactCycles = 25;

// Least memory traffic per cell [bytes], each array read or written once per pass. Advection:
// centred velocity 24, trace 24, four fields 44. Pressure: divergence 16, two V-cycles 2 · 64 ·
// 8/7, projection 28, publishing 40.
constexpr double kAdvectionBytes = 92, kPressureBytes = 230;
constexpr double kBytesPerCell = kAdvectionBytes + kPressureBytes;

/// The scripted hand on a fluid's grid, step by step.
class MovingHand {
 public:
  MovingHand(const prostm::GridShape& grid, prostm::WorkerPool& pool)
      : source_(prostm::make_scripted_hand({}, {})), rasteriser_(grid), pool_(pool) {}
  const HandRaster& at(int step) {
    source_->sample(kHandStart + kStep * step, frame_);
    to_device(prostm::default_tracker_pose(), frame_);
    rasteriser_.rasterise(frame_, pool_);
    return rasteriser_.raster();
  }
  /// The cells that the hand of the last step may touch.
  const prostm::CellBox& box() const { return rasteriser_.raster().box; }

 private:
  std::unique_ptr<prostm::HandSource> source_;
  prostm::HandRasteriser rasteriser_;
  prostm::WorkerPool& pool_;
  prostm::HandFrame frame_;
};

FluidSettings multigrid(int cells, int cycles) {
  FluidSettings settings;
  settings.cells = cells;
  settings.cycles = cycles;
  return settings;
}

FluidSettings jacobi(int cells, bool warm) {
  FluidSettings settings;
  settings.cells = cells;
  settings.solver = prostm::PressureMethod::Jacobi;
  settings.jacobi_sweeps = 40;
  settings.jacobi_warm = warm;
  return settings;
}

FluidSettings mgpcg(int cells, int iterations) {
  FluidSettings settings;
  settings.cells = cells;
  settings.solver = prostm::PressureMethod::Mgpcg;
  settings.cg_iterations = iterations;
  return settings;
}

/// Returns the relative L2 error of a's pressure against b's on the fluid cells beside the hand
/// [%]; negative without a hand.
double hand_pressure_error(const Fluid& a, const Fluid& b) {
  const prostm::GridShape& g = a.grid();
  const auto fluid = a.fluid_cells();
  const auto row = static_cast<std::size_t>(g.nx), plane = row * static_cast<std::size_t>(g.ny);
  double error = 0.0, norm = 0.0;
  for (int k = 1; k < g.nz - 1; ++k) {
    for (int j = 1; j < g.ny - 1; ++j) {
      for (int i = 1; i < g.nx - 1; ++i) {
        const std::size_t c = g.cell_index(i, j, k);
        const bool inner = fluid[c - 1] != 0 && fluid[c + 1] != 0 && fluid[c - row] != 0 &&
                           fluid[c + row] != 0 && fluid[c - plane] != 0 && fluid[c + plane] != 0;
        if (fluid[c] == 0 || inner) continue;
        const auto p = static_cast<double>(a.pressure()[c]),
                   exact = static_cast<double>(b.pressure()[c]);
        error += (p - exact) * (p - exact);
        norm += exact * exact;
      }
    }
  }
  return norm > 0.0 ? 100.0 * std::sqrt(error / norm) : -1.0;
}

/// Compares each step of a fluid's own history with a converged solve from the same state.
Summary accuracy(const FluidSettings& settings, const std::string& scene) {
  prostm::WorkerPool pool(kThreads);
  Fluid fluid(settings, prostm::scene_from_name(scene).smoke, pool);
  Fluid exact(multigrid(settings.cells, kExactCycles), prostm::scene_from_name(scene).smoke, pool);
  MovingHand hand(fluid.grid(), pool);
  Distribution errors;
  for (int t = 0; t < kWarmUp + kHistory; ++t) {
    const HandRaster& raster = hand.at(t);
    if (t < kWarmUp) {
      fluid.step(kStep, raster);
      continue;
    }
    exact.copy_state(fluid);
    exact.step(kStep, raster);
    fluid.step(kStep, raster);
    const double error = hand_pressure_error(fluid, exact);
    if (error >= 0.0) errors.add(error);
  }
  return errors.summary();
}

/// Steps of the fluid with one solver and the moving hand.
class TimedFluid {
 public:
  TimedFluid(const FluidSettings& settings, prostm::WorkerPool& pool)
      : fluid_(settings, prostm::scene_from_name("four-plumes").smoke, pool),
        hand_(fluid_.grid(), pool) {}

  void warm_up() {
    while (step_ < kWarmUp) fluid_.step(kStep, hand_.at(step_++));
  }
  void run(int steps) {
    const double gigacells = 1e-9 * std::pow(fluid_.grid().nx, 3);
    for (int t = 0; t < steps; ++t) {
      const prostm::FluidStats stats = fluid_.step(kStep, hand_.at(step_++));
      ms_.add(1e3 * stats.total);
      advection_.add(kAdvectionBytes * gigacells / stats.advect);
      pressure_.add(kPressureBytes * gigacells / stats.solve);
      divergence_.add(stats.divergence_max);
    }
    away_.add(divergence_away());
  }

  Summary ms() const { return ms_.summary(); }
  Summary advection() const { return advection_.summary(); }    // [GB/s]
  Summary pressure() const { return pressure_.summary(); }      // [GB/s]
  Summary divergence() const { return divergence_.summary(); }  // the largest, cells per step
  Summary away() const { return away_.summary(); }  // the same away from hands, jets and sides

 private:
  /// Largest divergence in the region of tools/compare_mantaflow.py: above a seventh of the height,
  /// and some cells away from the hand's heights, the sides and the top.
  double divergence_away() const {
    constexpr int kSides = 4, kHand = 5;
    const int n = fluid_.grid().nx;
    const prostm::CellBox& hand = hand_.box();
    double largest = 0.0;
    for (int k = n / 7; k < n - kSides; ++k) {
      if (!hand.empty() && k >= hand.lower[2] - kHand && k < hand.upper[2] + kHand) continue;
      for (int j = kSides; j < n - kSides; ++j) {
        for (int i = kSides; i < n - kSides; ++i)
          largest = std::max(largest, std::abs(fluid_.divergence(i, j, k)));
      }
    }
    return kStep * largest;
  }

  Fluid fluid_;
  MovingHand hand_;
  int step_ = 0;
  Distribution ms_, advection_, pressure_, divergence_, away_;
};

/// Times steps of the solvers in turn, a few each, so that each finds its own state in the caches.
void add_step_times(int cells, int steps, double bytes_per_second, std::vector<Row>& rows) {
  constexpr int kTurn = 10;
  prostm::WorkerPool pool(kThreads);
  TimedFluid ours(multigrid(cells, FluidSettings{}.cycles), pool), three(multigrid(cells, 3), pool),
      accurate(mgpcg(cells, FluidSettings{}.cg_iterations), pool),
      paper(jacobi(cells, false), pool);
  for (TimedFluid* fluid : {&ours, &three, &accurate, &paper}) fluid->warm_up();
  for (int t = 0; t < steps; t += kTurn) {
    for (TimedFluid* fluid : {&ours, &three, &accurate, &paper}) fluid->run(kTurn);
  }
  const std::string size = std::to_string(cells) + "^3";
  const double floor = 1e3 * kBytesPerCell * std::pow(cells, 3) / bytes_per_second;
  const auto add_solver = [&](const std::string& name, const TimedFluid& fluid,
                              const std::string& other, double other_ms) {
    rows.push_back({"step " + size + " with a hand, " + name, "ms", fluid.ms(), other, other_ms});
    rows.push_back(
        {"largest divergence, " + size + ", " + name, "1/step", fluid.divergence(), "", 0.0});
    rows.push_back({"away from hands, jets and sides, " + size + ", " + name, "1/step",
                    fluid.away(), "", 0.0});
  };
  add_solver("multigrid", ours, "40 Jacobi sweeps", paper.ms().p50);
  add_solver("3 V-cycles", three, "multigrid", ours.ms().p50);
  add_solver("mgpcg", accurate, "multigrid", ours.ms().p50);
  rows.push_back(
      {"step " + size + " against its memory traffic", "ms", ours.ms(), "traffic alone", floor});
  rows.push_back({"traffic of advection, " + size, "GB/s", ours.advection(), "triad",
                  1e-9 * bytes_per_second});
  rows.push_back(
      {"traffic of pressure, " + size, "GB/s", ours.pressure(), "triad", 1e-9 * bytes_per_second});
}

/// Times rasterising the scripted hand on a 64³ grid, alone or with a second one beside and above
/// it.
Summary raster_times(bool two) {
  prostm::WorkerPool pool(kThreads);
  const prostm::Fluid fluid(multigrid(64, 1), prostm::scene_from_name("four-plumes").smoke, pool);
  const auto source = prostm::make_scripted_hand({}, {});
  prostm::HandRasteriser rasteriser(fluid.grid());
  Distribution ms;
  for (int t = 0; t < kWarmUp + kTimedSteps; ++t) {
    prostm::HandFrame frame;
    source->sample(kHandStart + kStep * t, frame);
    to_device(prostm::default_tracker_pose(), frame);
    if (two && !frame.hands.empty()) {
      prostm::Hand other = frame.hands.front();
      ++other.id;
      for (prostm::Vec3& p : frame.hands.front().position) p.x() -= 0.08;
      for (prostm::Vec3& p : other.position) p += prostm::Vec3(0.07, 0.0, 0.02);
      frame.hands.push_back(other);
    }
    const prostm::StageTimer timer;
    rasteriser.rasterise(frame, pool);
    if (t >= kWarmUp) ms.add(1e3 * timer.seconds());
  }
  return ms.summary();
}

/// Measures the bytes per second of y = a·x + z over arrays as large as the fluid's state at 64³.
double triad_rate() {
  prostm::WorkerPool pool(kThreads);
  constexpr int kTasks = 64, kPerTask = 1 << 14;
  std::vector<float> x(kTasks * kPerTask, 1.0F), y(x.size(), 2.0F), z(x.size(), 3.0F);
  double best = 1e9;
  for (int repeat = 0; repeat < 30; ++repeat) {
    const prostm::StageTimer timer;
    pool.run(kTasks, [&](int task) {
      const auto begin = static_cast<std::size_t>(task) * kPerTask;
      for (std::size_t i = begin; i < begin + kPerTask; ++i) y[i] = 0.5F * x[i] + z[i];
    });
    best = std::min(best, timer.seconds());
  }
  return 3.0 * sizeof(float) * static_cast<double>(x.size()) / best;
}

std::vector<Row> measure() {
  std::vector<Row> rows;
  const double rate = triad_rate();
  for (const int cells : {32, 64, 96, 128, 160})
    add_step_times(cells, cells <= 64 ? kTimedSteps : kTimedSteps / 10, rate, rows);
  rows.push_back({"raster 64^3, one hand", "ms", raster_times(false), "", 0.0});
  rows.push_back({"raster 64^3, two hands", "ms", raster_times(true), "", 0.0});
  const Summary cold = accuracy(jacobi(64, false), "one-plume");
  rows.push_back({"hand pressure, 40 Jacobi sweeps cold", "%", cold, "", 0.0});
  rows.push_back({"hand pressure, 40 Jacobi sweeps warm", "%",
                  accuracy(jacobi(64, true), "one-plume"), "", 0.0});
  for (const int cycles : {1, 2, 3}) {
    rows.push_back({"hand pressure, " + std::to_string(cycles) + " V-cycles", "%",
                    accuracy(multigrid(64, cycles), "one-plume"), "40 Jacobi sweeps cold",
                    cold.p50});
  }
  rows.push_back({"hand pressure, mgpcg", "%", accuracy(mgpcg(64, 3), "one-plume"),
                  "40 Jacobi sweeps cold", cold.p50});
  rows.push_back({"hand pressure, default, four plumes", "%",
                  accuracy(FluidSettings{}, "four-plumes"), "", 0.0});
  return rows;
}

}  // namespace

int main(int argc, char** argv) {
  return prostm::bench::run(argc, argv, measure);
}
