#include <fmt/core.h>

#include "prostm/acoustics/focus/live_focus_solver.hpp"
#include "prostm/core/random.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/fields/moving_foci.hpp"
#include "solvers/solver_tables.hpp"
#include "solvers/textbook_gs_pat.hpp"

namespace prostm::bench {
namespace {

constexpr double kSample = 25e-6;  // sample period at 40 kHz [s]
constexpr int kSets = 50;          // solved one after the other in a measurement
constexpr int kRounds = 200;

struct Sets {
  std::vector<std::vector<LiveFocus>> live;
  std::vector<std::vector<Eigen::Vector3f>> positions;
  std::vector<std::vector<float>> amplitudes;
};

/// Makes consecutive samples of moving focal points.
Sets make_sets(int foci) {
  const fields::MovingFoci moving(1, foci, foci > 8 ? 8e-3 : 25e-3);
  Sets sets;
  for (int i = 0; i < kSets; ++i) {
    sets.live.emplace_back();
    sets.positions.emplace_back();
    sets.amplitudes.emplace_back();
    for (int f = 0; f < foci; ++f) {
      const Eigen::Vector3f p = moving.position(f, i * kSample).cast<float>();
      const auto amplitude = static_cast<float>(moving.amplitude(f, i * kSample));
      sets.live.back().push_back({p, amplitude});
      sets.positions.back().push_back(p);
      sets.amplitudes.back().push_back(amplitude);
    }
  }
  return sets;
}

/// One live method, timed.
struct Timed {
  const char* name;
  LiveFocusSolver solver;
  Distribution micros = Distribution();
};

}  // namespace

void measure_speed(std::vector<Row>& rows) {
  fmt::print("\nSolutions on one core, 256 transducers: from positions to drives\n");
  fmt::print("{:>5} {:<24} {:>10} {:>14} {:>22}\n", "foci", "", "p50, us", "solutions/s",
             "real time at 40 kHz");
  const TransducerArray array = usx_array();
  const Medium air;
  for (const int foci : {1, 2, 4, 8, 16, 32}) {
    const Sets sets = make_sets(foci);
    TextbookGsPat textbook(array, air, foci);
    const auto solver = [&](FocusMethod method, int iterations) {
      return LiveFocusSolver(array, air, {.method = method, .iterations = iterations});
    };
    std::vector<Timed> live;
    live.push_back({"GS-PAT, 20 iterations", solver(FocusMethod::GsPat, 20)});
    live.push_back({"weighted, 1 a sample", solver(FocusMethod::Weighted, 1)});
    live.push_back({"superposition", solver(FocusMethod::Superposition, 1)});
    Distribution plain;
    for (int round = 0; round < kRounds; ++round) {
      StageTimer timer;
      for (int i = 0; i < kSets; ++i) {
        const auto s = static_cast<std::size_t>(i);
        textbook.solve(sets.positions[s], sets.amplitudes[s], 20);
      }
      plain.add(1e6 * timer.lap() / kSets);
      for (Timed& one : live) {
        timer.restart();
        for (const auto& set : sets.live) one.solver.solve(set);
        one.micros.add(1e6 * timer.seconds() / kSets);
      }
    }
    const auto print = [&](const char* name, const Summary& s) {
      fmt::print("{:>5} {:<24} {:>10.2f} {:>14.0f} {:>22.2f}\n", foci, name, s.p50, 1e6 / s.p50,
                 1e6 * kSample / s.p50);
    };
    print("GS-PAT, textbook", plain.summary());
    for (const Timed& one : live) {
      print(one.name, one.micros.summary());
      rows.push_back({fmt::format("solvers/{}, {} foci", one.name, foci), "us",
                      one.micros.summary(), "GS-PAT, textbook", plain.summary().p50});
    }
  }
}

}  // namespace prostm::bench
