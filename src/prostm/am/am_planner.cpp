#include "prostm/am/am_planner.hpp"

#include <algorithm>
#include <array>
#include <boost/container/static_vector.hpp>
#include <memory>

#include "prostm/am/am_pressures.hpp"
#include "prostm/am/detail/felt_foci.hpp"
#include "prostm/core/require.hpp"
#include "prostm/core/stage_timer.hpp"
#include "prostm/plan/clustering.hpp"
#include "prostm/plan/patches.hpp"
#include "prostm/target/pressure_share.hpp"

namespace prostm {

using namespace planning;

namespace {

// share of the highest pressure below which pressure counts as 0, so that weighted means do not
// underflow
constexpr double kLeastShare = 1e-12;

using Places = boost::container::static_vector<Vec2, kMaxPaths>;

/// (B1): repeatedly picks the cell of highest pressure that lies farther than `apart` from all
/// picked ones; ties go to the first in the raster. Picks fewer than `count` if no cell is left.
/// @param maximum the target's largest pressure.
Places greedy_start(const TargetField& target, int count, double apart, double maximum) {
  Places places;
  while (static_cast<int>(places.size()) < count) {
    double highest = kLeastShare;
    std::size_t best = target.size();
    for (std::size_t i = 0; i < target.size(); ++i) {
      const double share = pressure_share(target.pressure[i], maximum);
      if (target.skin[i] == 0 || !(share > highest)) continue;
      const Vec2 x = target.position(i);
      const bool free = std::all_of(places.begin(), places.end(), [&](const Vec2& place) {
        return (x - place).squaredNorm() > apart * apart;
      });
      if (!free) continue;
      highest = share;
      best = i;
    }
    if (best == target.size()) break;
    places.push_back(target.position(best));
  }
  return places;
}

template <class Settings, class Visitor>
void list(Settings& s, Visitor& v) {
  v.field({"foci", "", 1, kMaxPaths, "largest number of focal points (N)"}, s.foci);
  v.field({"sigma", "m", 1e-3, 0.1, "fall-off of a focal point"}, s.sigma);
  v.field({"lloyd_iterations", "", 1, 1'000'000, "largest number of iterations of the k-means"},
          s.lloyd_iterations);
  v.field({"felt_weight", "", 0, 1,
           "weight of the percept when pressures and phases are chosen; 0: off"},
          s.felt_weight);
}

}  // namespace

void AmSettings::visit(SettingsReader& v) const {
  list(*this, v);
}
void AmSettings::visit(SettingsWriter& v) {
  list(*this, v);
}

void validate(const AmSettings& settings) {
  require_bounds(settings);
  require_between("frequency", settings.frequency, 25.0, 1e4, "Hz");
  validate(settings.widths);
}

struct AmPlanner::Scratch {
  Scratch(const AmSettings& s, std::size_t cells)
      : settings(s),
        max_cells(cells),
        kmeans(cells),
        felt(s.felt_weight > 0.0 ? std::make_unique<FeltFoci>(s) : nullptr) {}

  void plan_patch(const TargetField& target, int patch, int foci, double maximum, Plan& plan,
                  PlanStats& stats);

  AmSettings settings;
  std::size_t max_cells;
  WeightedKMeans kmeans;
  std::unique_ptr<FeltFoci> felt;  // null if felt_weight is 0
  Clusters clusters;
};

/// Appends at most `foci` foci for one patch. @pre maximum, the target's largest pressure, is > 0.
void AmPlanner::Scratch::plan_patch(const TargetField& target, int patch, int foci, double maximum,
                                    Plan& plan, PlanStats& stats) {
  StageTimer timer;
  kmeans.clear();
  for (std::size_t i = 0; i < target.size(); ++i) {
    const double weight = target.skin[i] != 0 ? pressure_share(target.pressure[i], maximum) : 0.0;
    if (weight > kLeastShare) kmeans.add(target.position(i), weight);
  }
  const Places start = greedy_start(target, foci, settings.sigma, maximum);
  stats.init += timer.lap();

  stats.lloyd_iterations +=
      kmeans.run_from({start.data(), start.size()}, settings.lloyd_iterations, clusters);
  stats.clusters += static_cast<int>(clusters.centre.size());
  stats.kmeans += timer.lap();

  FocalPoints own;
  for (const Vec2& x : clusters.centre) own.push_back({patch, x, 0.0});
  set_pressures(target, settings.sigma, own);
  if (felt && !own.empty()) felt->choose(target, maximum, own);
  for (const FocalPoint& focus : own) plan.foci.push_back(focus);
  stats.refine += timer.lap();
}

AmPlanner::AmPlanner(const AmSettings& settings, std::size_t max_cells) {
  validate(settings);
  scratch_ = std::make_unique<Scratch>(settings, max_cells);
}
AmPlanner::~AmPlanner() = default;
AmPlanner::AmPlanner(AmPlanner&&) noexcept = default;
AmPlanner& AmPlanner::operator=(AmPlanner&&) noexcept = default;

const AmSettings& AmPlanner::settings() const {
  return scratch_->settings;
}

PlanStatus AmPlanner::plan(const TargetField& target, Plan& plan, PlanStats& stats) noexcept {
  StageTimer timer;
  plan.clear();
  stats = {};
  const double maximum = highest_pressure(target, scratch_->max_cells);
  if (maximum < 0.0) return PlanStatus::InvalidTarget;
  if (maximum > 0.0) {
    scratch_->plan_patch(target, 0, scratch_->settings.foci, maximum, plan, stats);
  }
  stats.total = timer.seconds();
  return plan.empty() ? PlanStatus::EmptyTarget : PlanStatus::Planned;
}

PlanStatus AmPlanner::plan(const TargetFrame& frame, Plan& plan, PlanStats& stats) noexcept {
  StageTimer timer;
  plan.clear();
  stats = {};
  PatchPressures maximum{}, pressure{};
  for (std::size_t i = 0; i < frame.patches.size(); ++i) {
    maximum[i] = highest_pressure(frame.patches[i], scratch_->max_cells);
    if (maximum[i] < 0.0) return PlanStatus::InvalidTarget;
    pressure[i] = total_pressure(frame.patches[i]);
  }
  const std::array<int, kMaxPatches> share = share_out(pressure, scratch_->settings.foci);
  for (std::size_t i = 0; i < frame.patches.size(); ++i) {
    if (share[i] == 0) continue;
    scratch_->plan_patch(frame.patches[i], static_cast<int>(i), share[i], maximum[i], plan, stats);
  }
  stats.total = timer.seconds();
  return plan.empty() ? PlanStatus::EmptyTarget : PlanStatus::Planned;
}

}  // namespace prostm
