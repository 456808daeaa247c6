#include <fmt/core.h>

#include <array>
#include <cmath>
#include <complex>

#include "prostm/acoustics/field/propagation.hpp"
#include "prostm/acoustics/focus/live_focus_solver.hpp"
#include "prostm/core/units.hpp"
#include "prostm/fields/moving_foci.hpp"
#include "solvers/solver_tables.hpp"

namespace prostm::bench {
namespace {

constexpr double kRate = 40e3;  // [Hz]
constexpr int kSamples = 800, kStreams = 10;
constexpr int kStride = 8;  // between samples whose pressures are evaluated

/// The requested amplitudes: as the focal points move, or all 1.
enum class Ask { AsTheyMove, All };

struct Streamed {
  Distribution error;         ///< largest error of a share in a sample [%]
  Distribution each, sum;     ///< (p/p alone)² of each focal point, and their Σ
  std::vector<double> steps;  ///< phase steps of the drives between samples [°]
};

std::vector<LiveFocus> at_sample(const fields::MovingFoci& moving, int sample, Ask ask) {
  const double time = sample / kRate;
  std::vector<LiveFocus> foci;
  for (int f = 0; f < moving.count(); ++f) {
    const double amplitude = ask == Ask::All ? 1.0 : moving.amplitude(f, time);
    foci.push_back({moving.position(f, time).cast<float>(), static_cast<float>(amplitude)});
  }
  return foci;
}

Eigen::VectorXcd drives_of(const LiveFocusSolver& solver) {
  Eigen::VectorXcd q(static_cast<Eigen::Index>(solver.drive().columns()));
  for (std::size_t n = 0; n < solver.drive().columns(); ++n) {
    q[static_cast<Eigen::Index>(n)] = solver.drive().at(0, n);
  }
  return q;
}

/// Evaluates the pressures of the drives by (A1) in double precision.
void add_pressures(const std::vector<LiveFocus>& foci, const Eigen::VectorXcd& q, Streamed& out) {
  const auto count = static_cast<Eigen::Index>(foci.size());
  std::vector<Vec3> points;
  Eigen::VectorXd a(count);
  for (const LiveFocus& focus : foci) {
    a[static_cast<Eigen::Index>(points.size())] = static_cast<double>(focus.amplitude);
    points.push_back(focus.p_D.cast<double>());
  }
  const Propagation g = propagation_to(usx_array(), Medium{}, points);
  const Eigen::VectorXd y = (g * q).cwiseAbs().cwiseQuotient(g.cwiseAbs().rowwise().sum());
  const double level = a.dot(y) / a.squaredNorm();
  out.error.add(100.0 * (y.cwiseQuotient(level * a).array() - 1.0).abs().maxCoeff());
  out.sum.add(y.squaredNorm());
  for (const double share : y) out.each.add(share * share);
}

/// Follows streams of focal points on loops whose centres are at least `apart` [m] apart.
Streamed follow(const LiveFocusSettings& settings, int count, double apart, Ask ask) {
  Streamed out;
  for (int stream = 0; stream < kStreams; ++stream) {
    const fields::MovingFoci moving(static_cast<std::uint64_t>(stream), count, apart);
    LiveFocusSolver solver(usx_array(), Medium{}, settings);
    Eigen::VectorXcd before;
    for (int i = 0; i < kSamples; ++i) {
      const std::vector<LiveFocus> foci = at_sample(moving, i, ask);
      solver.solve(foci);
      const Eigen::VectorXcd q = drives_of(solver);
      for (Eigen::Index n = 0; n < before.size(); ++n) {
        out.steps.push_back(std::abs(std::arg(q[n] * std::conj(before[n]))) * 180.0 / kPi);
      }
      before = q;
      if (i % kStride == 0) add_pressures(foci, q, out);
    }
  }
  return out;
}

struct Method {
  const char* name;
  LiveFocusSettings settings;
};
const std::array kMethods = {
    Method{"GS-PAT", {.method = FocusMethod::GsPat, .iterations = 20, .warm = false}},
    Method{"GS-PAT, warm", {.method = FocusMethod::GsPat, .iterations = 20}},
    Method{"superposition", {.method = FocusMethod::Superposition}},
    Method{"weighted, 20, cold", {.iterations = 20, .warm = false}}, Method{"weighted", {}}};

}  // namespace

void measure_streams(std::vector<Row>& rows) {
  fmt::print(
      "\nStreams at 40 kHz: focal points at up to 7 m/s on loops of up to 140 mm whose middles are "
      "at\n"
      "least so far apart. The largest error of a share in a sample; the sum of (p/p alone)^2; "
      "the\n"
      "step of a drive's phase from one sample to the next, degrees\n"
      "{:>5} {:>6} {:<20} {:>9} {:>9} {:>7} {:>10} {:>10} {:>10}\n",
      "foci", "mm", "", "mean, %", "p99, %", "power", "step p50", "p99", "p99.9");
  for (const auto& [count, apart] : {std::pair{4, 0.05}, std::pair{4, 0.03}, std::pair{8, 0.02}}) {
    double gs_pat = 0.0;
    for (const Method& method : kMethods) {
      const Streamed s = follow(method.settings, count, apart, Ask::AsTheyMove);
      const Summary error = s.error.summary();
      fmt::print("{:>5} {:>6.0f} {:<20} {:>9.2f} {:>9.1f} {:>7.2f} {:>10.1f} {:>10.1f} {:>10.1f}\n",
                 count, 1e3 * apart, method.name, error.mean, error.p99, s.sum.summary().mean,
                 quantile(s.steps, 0.5), quantile(s.steps, 0.99), quantile(s.steps, 0.999));
      if (&method == &kMethods.front()) gs_pat = error.p50;
      rows.push_back({fmt::format("solvers/{}, {} foci {:.0f} mm, error of a share", method.name,
                                  count, 1e3 * apart),
                      "%", error, kMethods.front().name, gs_pat});
    }
  }
}

void print_power_and_rounding() {
  fmt::print(
      "\nEqual focal points, all that the array has: radiation pressure of each over that of one\n"
      "alone, mean; their sum, mean and deviation in time; with phases rounded to 256 and to 16 "
      "steps; superposed\n"
      "{:>5} {:>9} {:>9} {:>9} {:>9} {:>9} {:>12}\n",
      "foci", "mean", "sum", "deviation", "256: sum", "16: sum", "superposed");
  for (int count = 1; count <= 8; ++count) {
    const auto run = [&](const LiveFocusSettings& settings) {
      return follow(settings, count, 0.03, Ask::All);
    };
    const Streamed any = run({});
    fmt::print("{:>5} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>9.3f} {:>12.3f}\n", count,
               any.each.summary().mean, any.sum.summary().mean, any.sum.summary().deviation,
               run({.phase_levels = 256}).sum.summary().mean,
               run({.phase_levels = 16}).sum.summary().mean,
               run({.method = FocusMethod::Superposition}).sum.summary().mean);
  }
}

}  // namespace prostm::bench
