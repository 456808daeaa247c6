#include "prostm/plan/detail/fit/phases.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prostm::planning {
namespace {

constexpr double kAhead = 0.040;       // horizon of the cost: the time until the next plan [s]
constexpr float kLeastSquare = 1e-3F;  // added to squared distances so that costs are finite [mm²]
constexpr int kSearches = 4, kMostSweeps = 20;
constexpr float kRounding = 1e-5F;  // relative difference of costs that counts as equal
constexpr double kReach = 6.0;      // largest distance from a kept start to its new loop [mm]
constexpr float kGain = 1.1F;       // factor in distance that justifies new starts

/// Returns d^−8 for d².
float nearness(float square) {
  const float inverse = 1.0F / (square + kLeastSquare);
  const float fourth = inverse * inverse;
  return fourth * fourth;
}

}  // namespace

void EvenLap::set(const Loops& loops, int path) {
  samples = loops.samples;
  arcs = std::min(samples, kMostArcs);
  double area = 0.0, length = 0.0;
  for (int i = 0; i < samples; ++i) {
    const Vec2 a = loops.point(i, path), b = loops.point((i + 1) % samples, path);
    // relative to the first sample, so that the area does not depend on the position
    const Vec2 u = a - loops.point(0, path), v = b - a;
    area += u.x() * v.y() - u.y() * v.x();
    length += v.norm();
  }
  reversed = area < 0.0;

  // visit the samples in the order in which the focal point passes them
  const LapStart order{0, reversed};
  const double per_length = length > 0.0 ? arcs / length : 0.0;
  double at = 0.0;
  int arc = 0;
  for (int i = 0; i < samples; ++i) {
    const int sample = order.sample(i, samples);
    const Vec2 a = loops.point(sample, path);
    const Vec2 b = loops.point(order.sample((i + 1) % samples, samples), path);
    const double step = (b - a).norm() * per_length;
    passed[static_cast<std::size_t>(sample)] = at;
    for (; arc < arcs && (arc <= at + step || i + 1 == samples); ++arc) {
      const double share = step > 0.0 ? std::min((arc - at) / step, 1.0) : 0.0;
      const Vec2 p = a + share * (b - a);
      for (const int place : {arc, arc + arcs}) {
        x[static_cast<std::size_t>(place)] = static_cast<float>(p.x());
        y[static_cast<std::size_t>(place)] = static_cast<float>(p.y());
      }
    }
    at += step;
  }
}

int EvenLap::nearest_arc(int sample) const {
  return static_cast<int>(std::lround(passed[static_cast<std::size_t>(sample)])) % arcs;
}

int EvenLap::nearest_sample(int arc) const {
  int nearest = 0;
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i < samples; ++i) {
    const double apart = std::abs(passed[static_cast<std::size_t>(i)] - arc);
    const double around = std::min(apart, arcs - apart);
    if (around >= least) continue;
    least = around;
    nearest = i;
  }
  return nearest;
}

/// Computes the costs of the pair (a, b) as a function of the arcs by which a is ahead of b at the
/// start. @param gained laps that a gains on b.
void PhaseCosts::add_pair(const EvenLap& a, const EvenLap& b, double gained, Row& ahead,
                          Row& behind) const {
  const auto n = static_cast<std::size_t>(arcs_);
  // at constant lead: sum over one lap
  Row lap{};
  for (std::size_t i = 0; i < n; ++i) {
    const float* const ax = &a.x[i];
    const float* const ay = &a.y[i];
    for (std::size_t lead = 0; lead < n; ++lead) {
      const float dx = ax[lead] - b.x[i], dy = ay[lead] - b.y[i];
      lap[lead] += nearness(dx * dx + dy * dy);
    }
  }
  std::copy_n(lap.begin(), n, lap.begin() + static_cast<std::ptrdiff_t>(n));

  // sum over the leads that occur while a gains on b
  Row mean{};
  for (std::size_t moment = 0; moment < n; ++moment) {
    const double laps = (static_cast<double>(moment) + 0.5) / arcs_ * gained;
    const auto shift = static_cast<std::size_t>((laps - std::floor(laps)) * arcs_);
    for (std::size_t lead = 0; lead < n; ++lead) mean[lead] += lap[lead + shift];
  }
  mean[n] = mean[0];
  for (std::size_t lead = 0; lead < n; ++lead) {
    ahead[lead] = ahead[n + lead] = mean[lead];
    behind[lead] = behind[n + lead] = mean[n - lead];
  }
}

void PhaseCosts::set(std::span<const EvenLap> laps, std::span<const double> periods) {
  paths_ = laps.size();
  arcs_ = paths_ > 0 ? laps[0].arcs : 0;
  for (std::size_t k = 0; k < paths_; ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      const double gained = kAhead / periods[k] - kAhead / periods[j];
      add_pair(laps[k], laps[j], gained, row(k, j), row(j, k));
    }
  }
}

float PhaseCosts::total(std::span<const int> arc) const {
  float sum = 0.0F;
  for (std::size_t k = 0; k < paths_; ++k) {
    for (std::size_t j = 0; j < k; ++j) {
      sum += row(k, j)[static_cast<std::size_t>(arcs_ + arc[k] - arc[j])];
    }
  }
  return sum;
}

void PhaseCosts::descend(std::span<int> arc, std::span<const bool> free) const {
  const auto n = static_cast<std::size_t>(arcs_);
  bool lowers = true;
  for (int sweep = 0; lowers && sweep < kMostSweeps; ++sweep) {
    lowers = false;
    for (std::size_t k = 0; k < paths_; ++k) {
      if (!free[k]) continue;
      std::array<float, static_cast<std::size_t>(EvenLap::kMostArcs)> cost{};
      for (std::size_t j = 0; j < paths_; ++j) {
        if (j == k) continue;
        const float* const from = &row(k, j)[static_cast<std::size_t>(arcs_ - arc[j])];
        for (std::size_t a = 0; a < n; ++a) cost[a] += from[a];
      }
      // search the index of the minimum only if needed, since the branches of that search are hard
      // to predict
      float least = cost[0];
      for (std::size_t a = 1; a < n; ++a) least = std::min(least, cost[a]);
      if (least >= (1.0F - kRounding) * cost[static_cast<std::size_t>(arc[k])]) continue;
      arc[k] = static_cast<int>(std::find(cost.begin(), cost.end(), least) - cost.begin());
      lowers = true;
    }
  }
}

void PhaseCosts::search(std::span<int> arc) const {
  std::array<bool, kMaxPaths> free;
  free.fill(true);
  free[0] = false;  // only differences count
  float least = std::numeric_limits<float>::max();
  for (int search = 0; search < kSearches; ++search) {
    std::array<int, kMaxPaths> trial{};
    for (std::size_t k = 0; k < paths_; ++k) {
      trial[k] = static_cast<int>(k) * search * arcs_ / kSearches % arcs_;
    }
    descend(std::span<int>(trial).first(paths_), free);
    const float cost = total(trial);
    if (cost >= (1.0F - kRounding) * least) continue;
    least = cost;
    std::copy_n(trial.begin(), paths_, arc.begin());
  }
}

/// Finds the arcs of the last plan's starts on the loops near them; all other loops are new.
/// @return whether there is any such loop.
bool Phases::find_kept(const Loops& loops, std::span<int> arc, std::span<bool> is_new) const {
  bool any = false;
  for (int k = 0; k < loops.paths; ++k) {
    double least = kReach * kReach;
    for (const Vec2& start : before_) {
      for (int i = 0; i < loops.samples; ++i) {
        const double square = (loops.point(i, k) - start).squaredNorm();
        if (square >= least) continue;
        least = square;
        arc[static_cast<std::size_t>(k)] = laps_[static_cast<std::size_t>(k)].nearest_arc(i);
        is_new[static_cast<std::size_t>(k)] = false;
        any = true;
      }
    }
  }
  return any;
}

LapStarts Phases::choose(const Loops& loops, std::span<const double> periods) {
  for (int k = 0; k < loops.paths; ++k) laps_[static_cast<std::size_t>(k)].set(loops, k);
  costs_.set(laps(loops.paths), periods);

  std::array<int, kMaxPaths> found{}, kept{};
  std::array<bool, kMaxPaths> is_new;
  is_new.fill(true);
  costs_.search(found);
  if (find_kept(loops, kept, is_new)) {
    costs_.descend(kept, is_new);
    const float gain2 = kGain * kGain, gain4 = gain2 * gain2;
    if (gain4 * gain4 * costs_.total(found) > costs_.total(kept)) found = kept;
  }

  LapStarts starts;
  before_.clear();
  for (int k = 0; k < loops.paths; ++k) {
    const EvenLap& lap = laps_[static_cast<std::size_t>(k)];
    starts.push_back({lap.nearest_sample(found[static_cast<std::size_t>(k)]), lap.reversed});
    before_.push_back(loops.point(starts.back().first, k));
  }
  return starts;
}

}  // namespace prostm::planning
