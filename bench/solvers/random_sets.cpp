#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/core/random.hpp"
#include "solvers/solver_tables.hpp"

namespace prostm::bench {
namespace {

constexpr int kMostFoci = 32;
constexpr double kApart = 5e-3;  // least distance of two focal points [m]
constexpr std::array kBounds = {5.0, 8.0, 11.0, 15.0, 20.0, 30.0};  // bin edges, distance [mm]
constexpr std::array kCounts = {1, 3, 5, 9, 17, 33};                // bin edges, focal points

struct Method {
  const char* name;
  FocusSettings settings;
};
const std::array kMethods = {Method{"superposition", {.method = FocusMethod::Superposition}},
                             Method{"IBP", {.method = FocusMethod::Ibp}},
                             Method{"GS-PAT", {.method = FocusMethod::GsPat}},
                             Method{"eigenvector", {.method = FocusMethod::Eigenvector}},
                             Method{"weighted", {.method = FocusMethod::Weighted}},
                             Method{"LM", {.method = FocusMethod::LevenbergMarquardt}}};

/// Errors of shares by distance, and power by number of focal points.
struct Outcome {
  std::array<std::vector<double>, kBounds.size()> errors;
  std::array<Distribution, kCounts.size() - 1> power;
};

std::vector<Vec3> random_foci(Random& random, int count) {
  std::vector<Vec3> foci;
  while (static_cast<int>(foci.size()) < count) {
    const Vec3 p(random.uniform(-0.06, 0.06), random.uniform(-0.06, 0.06),
                 random.uniform(0.15, 0.25));
    const bool far = std::all_of(foci.begin(), foci.end(),
                                 [&](const Vec3& other) { return (p - other).norm() > kApart; });
    if (far) foci.push_back(p);
  }
  return foci;
}

/// Returns the distance to the nearest other focal point [mm]; 1000 for a single one.
double distance_of(const std::vector<Vec3>& foci, std::size_t m) {
  double least = 1.0;
  for (std::size_t other = 0; other < foci.size(); ++other) {
    if (other == m) continue;
    least = std::min(least, (foci[m] - foci[other]).norm());
  }
  return 1e3 * least;
}

template <class Bounds, class Value>
std::size_t bin_of(const Bounds& bounds, Value value) {
  const auto above = std::upper_bound(bounds.begin(), bounds.end(), value);
  return static_cast<std::size_t>(above - bounds.begin()) - 1;
}

void add_set(Random& random, std::array<Outcome, kMethods.size()>& outcomes) {
  const int count = 1 + random.below(kMostFoci);
  const std::vector<Vec3> foci = random_foci(random, count);
  const Propagation g = propagation_to(usx_array(), Medium{}, foci);
  const Eigen::VectorXd alone = g.cwiseAbs().rowwise().sum();
  const Eigen::VectorXd target = alone.cwiseProduct(
      Eigen::VectorXd::NullaryExpr(count, [&] { return random.uniform(0.25, 1.0); }));
  for (std::size_t k = 0; k < kMethods.size(); ++k) {
    const FocusSolution solution = solve_foci(g, target, kMethods[k].settings);
    const Eigen::VectorXd errors = focus_errors(solution, target).cwiseAbs();
    for (std::size_t m = 0; m < foci.size(); ++m) {
      outcomes[k].errors[bin_of(kBounds, distance_of(foci, m))].push_back(
          errors[static_cast<Eigen::Index>(m)]);
    }
    const Eigen::ArrayXd shares = solution.level * target.array() / alone.array();
    outcomes[k].power[bin_of(kCounts, count)].add(shares.square().sum());
  }
}

}  // namespace

void print_random_sets(int sets) {
  Random random(1);
  std::array<Outcome, kMethods.size()> outcomes;
  for (int i = 0; i < sets; ++i) add_set(random, outcomes);

  fmt::print(
      "\n{} random sets of 1 to {} focal points, amplitudes 0.25 to 1 at full drive.\n"
      "Error of a share, %, median and 95th percentile, by the distance to the nearest other\n"
      "focal point, mm; then power, the sum of (p/p alone)^2, by the number of focal points\n",
      sets, kMostFoci);
  fmt::print("{:<14}", "");
  for (std::size_t b = 0; b < kBounds.size(); ++b) {
    const std::string to = b + 1 < kBounds.size() ? fmt::format("{:g}", kBounds[b + 1]) : "";
    fmt::print("{:>14}", fmt::format("{:g}-{}", kBounds[b], to));
  }
  for (std::size_t b = 0; b + 1 < kCounts.size(); ++b) {
    fmt::print("{:>7}", fmt::format("{}-{}", kCounts[b], kCounts[b + 1] - 1));
  }
  fmt::print("\n");
  for (std::size_t k = 0; k < kMethods.size(); ++k) {
    fmt::print("{:<14}", kMethods[k].name);
    for (const auto& errors : outcomes[k].errors) {
      fmt::print("{:>14}", fmt::format("{:.1f} {:.1f}", 100.0 * quantile(errors, 0.5),
                                       100.0 * quantile(errors, 0.95)));
    }
    for (const Distribution& power : outcomes[k].power)
      fmt::print("{:>7.2f}", power.summary().mean);
    fmt::print("\n");
  }
  fmt::print("{:<14}", "focal points");
  for (const auto& errors : outcomes[0].errors) fmt::print("{:>14}", errors.size());
  fmt::print("\n");
}

}  // namespace prostm::bench
