#include "prostm/plan/detail/fit/search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prostm::planning {
namespace {

constexpr float kFelt = 0.2F;   // share of the maximum from which a cell needs to be covered
constexpr double kWidth = 1.5;  // width of the area that a path of full length covers, in σ
constexpr float kLost = 1.4F;   // factor of cost over the target's norm that triggers new starts
constexpr float kPoor = 0.1F;   // cost over that norm above which the previous paths are dropped
constexpr int kFewestEvaluations = 8;  // fewest worth a start, a kick or the fine cells
// part of a budget kept in reserve against slight overruns: a share, and its maximum [s]
constexpr double kSpareShare = 0.045, kSpareTime = 2e-4;
constexpr int kSpare = 2;             // evaluations kept in reserve, since their time varies
constexpr int kLeastEvaluations = 4;  // least evaluations of a start that must be made
// largest share of a budget for the finish, on finer cells or on those of the search
constexpr double kFinishShare = 0.35, kSameShare = 0.15;
constexpr double kWarmShare = 0.5;  // largest share of a budget for the previous paths
constexpr int kFewestStops = 14, kMoreStops = 7;

Vec2 centroid(const Loops& loops, int path) {
  Vec2 sum = Vec2::Zero();
  for (int i = 0; i < loops.samples; ++i) sum += loops.point(i, path);
  return sum / loops.samples;
}

/// Draws another path, with a preference for near ones; returns `first` if it is the only path.
int draw_neighbour(const Loops& loops, int first, Random& random) {
  const Vec2 from = centroid(loops, first);
  int chosen = first;
  double least = std::numeric_limits<double>::max();
  for (int k = 0; k < loops.paths; ++k) {
    const double distance = (centroid(loops, k) - from).norm() * random.uniform(0.5, 1.0);
    if (k == first || distance >= least) continue;
    least = distance;
    chosen = k;
  }
  return chosen;
}

/// Copies the paths of `from` except one.
void copy_without(const Loops& from, int missing, Loops& out) {
  out.reset(from.samples, from.paths - 1);
  for (int k = 0; k < out.paths; ++k) {
    for (int i = 0; i < out.samples; ++i)
      out.set_point(i, k, from.point(i, k < missing ? k : k + 1));
  }
}

}  // namespace

Search::Search(std::size_t max_cells, const FitSettings& fit, const SearchSettings& settings)
    : settings_(settings),
      coarse_(max_cells),
      fine_(max_cells),
      initial_(std::min(max_cells, 8 * CellTiles::kMaxTiles)),
      descent_(std::min(max_cells, CellTiles::kMaxTiles), settings.samples, fit),
      random_(settings.seed) {}

void Search::set_sigma(double sigma) {
  FitSettings& fit = descent_.settings();
  fit.reconstruction.sigma = fit.shape.spacing = static_cast<float>(sigma);
}

void Search::set_bounds(const PlayBounds& bounds) {
  PlayBounds& searched = descent_.settings().reconstruction.bounds;
  searched = bounds;
  if (!settings_.counts_steepness) searched.slope.fill(kAnySlope);
}

void Search::set_target(const TargetField& target, double maximum, double budget) {
  timer_.restart();
  budget_ = budget - std::min(kSpareShare * budget, kSpareTime);
  coarse_.set(target, maximum, settings_.coarse_width);
  needed_ = needed_paths();
  has_fine_ = settings_.fine_width < settings_.coarse_width && needed_ <= settings_.fine_paths;
  if (has_fine_) fine_.set(target, maximum, settings_.fine_width);
  share_budget();
}

/// Time of one evaluation [s].
double Search::evaluation_time(const CellTiles& cells) const {
  return tile_time_ * static_cast<double>(cells.tiles().size());
}

/// Reserves time for the finish.
void Search::share_budget() {
  if (budget_ <= 0.0) return;
  const bool finer = fine().tiles().size() > coarse_.tiles().size();
  const double most = (finer ? kFinishShare : kSameShare) * budget_;
  finish_fine_ = most >= kFewestEvaluations * evaluation_time(fine());
  const double finish = settings_.final_evaluations * evaluation_time(finish_cells());
  search_end_ = finish_end() - std::min(finish, finish_fine_ ? most : 0.5 * most);
}

/// Returns how many evaluations of a start or a kick the remaining time allows; 0 if too few to be
/// worthwhile.
int Search::affordable(int evaluations) const {
  if (budget_ <= 0.0) return evaluations;
  const double left = (search_end_ - timer_.seconds()) / evaluation_time(coarse_);
  return left < kFewestEvaluations
             ? 0
             : static_cast<int>(std::min(left, static_cast<double>(evaluations)));
}

/// Runs the descent and times it. @param end time at which it must end, if there is a budget [s].
int Search::descend(const CellTiles& cells, int evaluations, double end, Fit& fit) {
  const double start = timer_.seconds();
  const Deadline deadline{budget_ > 0.0 ? &timer_ : nullptr, end - evaluation_time(cells)};
  const int used = descent_.run(cells, fit, evaluations, deadline);
  const double each =
      (timer_.seconds() - start) / (used * static_cast<double>(cells.tiles().size()));
  tile_time_ = updated_mean(tile_time_, each);
  return used;
}

StartSettings Search::draw_start(int paths) {
  StartSettings start;
  start.paths = paths;
  start.stops = kFewestStops + random_.below(kMoreStops);
  start.region_passes = settings_.region_passes;
  start.stop_passes = settings_.stop_passes;
  start.most_length = static_cast<double>(descent_.settings().shape.most_length[0]);
  return start;
}

/// Returns the number of paths needed for the area with significant pressure; more would share the
/// same small contact.
int Search::needed_paths() const {
  double area = 0.0;
  for (std::size_t t = 0; t < coarse_.tiles().size(); ++t) {
    const CellTile& tile = coarse_.tiles()[t];
    for (std::size_t c = 0; c < 8; ++c) {
      if (tile.pressure[c] < kFelt) continue;
      area += static_cast<double>(tile.weight[c] / coarse_.mean_weight(t, c) * kUnitArea);
    }
  }
  const FitSettings& fit = descent_.settings();
  const double served = kWidth * static_cast<double>(fit.reconstruction.sigma) *
                        static_cast<double>(fit.shape.most_length[0]);
  return std::clamp(static_cast<int>(std::ceil(area / served)), 1, kMaxPaths);
}

/// @param most maximum number of evaluations per start.
int Search::try_starts(int paths, int starts, int most, float hysteresis, Fit& best) {
  if (starts == 0) return 0;
  int used = 0;
  const int needed = std::min(needed_, paths);
  if (needed == 1) most = std::max(most, settings_.small_evaluations);
  initial_.set(coarse_, static_cast<float>(settings_.weak));
  for (int start = 0; start < starts; ++start) {
    int evaluations = affordable(most);
    double end = search_end_;
    // if there are no paths worth keeping, at least one start is made
    const bool is_poor =
        start == 0 && best.cost > kPoor * static_cast<float>(coarse_.square_norm());
    if (is_poor && evaluations < kLeastEvaluations) {
      evaluations = std::min(kLeastEvaluations, most);
      end = std::numeric_limits<double>::infinity();
    }
    if (evaluations == 0) break;
    // first with the maximum number of paths, then with each number from needed_ up
    const int count = start == 0 ? paths : needed + (start - 1) % (paths - needed + 1);
    initial_.make(draw_start(count), settings_.samples, random_, trial_.loops);
    used += descend(coarse_, evaluations, end, trial_);
    if (trial_.cost < best.cost - hysteresis) {
      best = trial_;
      hysteresis = 0.0F;
    }
  }
  return used;
}

int Search::try_kicks(Fit& best) {
  int used = 0;
  for (int kick = 0; kick < settings_.kicks || budget_ > 0.0; ++kick) {
    const int evaluations = affordable(settings_.kick_evaluations);
    if (evaluations == 0) break;
    const int first = random_.below(best.loops.paths);
    const int second = random_.below(3) == 0 ? first : draw_neighbour(best.loops, first, random_);
    const int count = first == second ? 1 : 2;

    // re-initialise them on the cells that are nearest to them
    descent_.solve(coarse_, best);
    ++used;
    const std::uint32_t owners =
        (1U << static_cast<unsigned>(first)) | (1U << static_cast<unsigned>(second));
    initial_.set(coarse_, static_cast<float>(settings_.weak), descent_.fits(), best.loops.lanes,
                 owners);
    if (initial_.size() == 0) continue;
    initial_.make(draw_start(count), settings_.samples, random_, laid_);
    if (laid_.paths < count) continue;
    trial_ = best;
    for (int i = 0; i < best.loops.samples; ++i) {
      trial_.loops.set_point(i, first, laid_.point(i, 0));
      if (count == 2) trial_.loops.set_point(i, second, laid_.point(i, 1));
    }
    used += descend(coarse_, evaluations, search_end_, trial_);
    if (trial_.cost < best.cost) best = trial_;
  }
  return used;
}

/// Sets `out` to the paths of `from` without the one whose removal costs least. @return evaluations
/// used.
int Search::remove_path(const Fit& from, Fit& out) {
  float least = std::numeric_limits<float>::max();
  for (int missing = 0; missing < from.loops.paths; ++missing) {
    copy_without(from.loops, missing, without_.loops);
    descent_.evaluate(coarse_, without_);
    if (without_.cost >= least) continue;
    least = without_.cost;
    out = without_;
  }
  return from.loops.paths;
}

/// If the field needs fewer paths, removes paths while that lowers the cost.
int Search::try_fewer(Fit& best) {
  int used = 0;
  if (settings_.fewer_evaluations == 0) return used;
  while (best.loops.paths > needed_) {
    const int evaluations = affordable(best.loops.paths + settings_.fewer_evaluations);
    if (evaluations <= best.loops.paths) break;
    used += remove_path(best, trial_);
    used += descend(coarse_, evaluations - best.loops.paths, search_end_, trial_);
    if (trial_.cost >= best.cost) break;
    best = trial_;
  }
  return used;
}

int Search::run(int paths, bool continues, Fit& best) {
  int used = 0;
  const auto norm = static_cast<float>(coarse_.square_norm());
  if (!continues) {
    random_ = Random(settings_.seed);
    best.cost = reached_ = std::numeric_limits<float>::max();
    used += try_starts(paths, settings_.starts, settings_.start_evaluations, 0.0F, best);
  } else {
    // leave time to try something new in every plan
    const int all = affordable(std::numeric_limits<int>::max());
    const int few = std::min(static_cast<int>(kWarmShare * all), all - kFewestEvaluations - kSpare);
    used += descend(coarse_, std::clamp(few, 2, settings_.warm_evaluations), search_end_, best);
    // start from scratch if the target has changed more than the paths can follow. The cost is
    // compared with the least since the last such start, not only with the previous plan's, or a
    // slow degradation would go undetected
    const bool lost = best.cost > std::min(kLost * reached_, kPoor) * norm;
    if (lost) reached_ = std::numeric_limits<float>::max();
    // as many evaluations as the present paths had, since the starts are compared with these
    const int most = std::max(settings_.start_evaluations, settings_.warm_evaluations);
    const float margin = static_cast<float>(settings_.hysteresis) * best.cost;
    used += try_starts(paths, lost ? settings_.starts : settings_.warm_starts, most, margin, best);
  }
  // before the kicks, which use up the rest of a budget
  used += try_fewer(best);
  const float before = best.cost;
  used += try_kicks(best);
  if (best.cost < before) used += try_fewer(best);
  reached_ = std::min(reached_, best.cost / norm);
  return used;
}

int Search::follow(Fit& fit) {
  const int used = descend(coarse_, settings_.warm_evaluations, search_end_, fit);
  reached_ = fit.cost / static_cast<float>(coarse_.square_norm());
  return used;
}

void Search::solve(const PlayBounds& bounds, Fit& fit) {
  ReconstructionSettings& settings = descent_.settings().reconstruction;
  const ReconstructionSettings searched = settings;
  settings.bounds = bounds;
  // keep the smoothing per length of path constant
  settings.smoothing *=
      static_cast<float>(fit.loops.samples) / static_cast<float>(settings_.samples);
  descent_.solve(fine(), fit);
  settings = searched;
}

void Search::learn_ending(double seconds) {
  ending_deviation_ = updated_mean(ending_deviation_, std::abs(seconds - ending_time_));
  ending_time_ = updated_mean(ending_time_, seconds);
}

int Search::finish(const std::array<float, kMaxPaths>& most_length, Fit& fit) {
  const std::array<float, kMaxPaths> unbound = descent_.settings().shape.most_length;
  descent_.settings().shape.most_length = most_length;
  int evaluations = settings_.final_evaluations;
  if (budget_ > 0.0) {
    const double left = (finish_end() - timer_.seconds()) / evaluation_time(finish_cells());
    evaluations = std::clamp(static_cast<int>(left), 1, evaluations);
  }
  const int used = evaluations > 0 ? descend(finish_cells(), evaluations, finish_end(), fit) : 0;
  descent_.settings().shape.most_length = unbound;
  return used;
}

}  // namespace prostm::planning
