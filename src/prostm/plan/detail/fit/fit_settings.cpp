#include "prostm/plan/detail/fit/fit_settings.hpp"

#include <algorithm>

#include "prostm/plan/detail/pressure_raster.hpp"

namespace prostm::planning {
namespace {

constexpr double kFastWidth = 6.0;      // width of the cells of preset fast [mm]
constexpr double kFastFineWidth = 4.0;  // width of the cells for its pressures [mm]
constexpr int kFastEvaluations = 2, kFastWarmEvaluations = 4, kFastSmallEvaluations = 4;
constexpr int kFastFinePaths = 1;  // most paths of a target that is small enough for finer cells
constexpr int kFastRegionPasses = 3, kFastStopPasses = 2;
constexpr int kPieces = 2;  // pieces per segment in plans of preset best

}  // namespace

FitSettings fit_settings(const PlanSettings& s) {
  FitSettings fit;
  fit.reconstruction.sigma = static_cast<float>(kMmPerMetre * s.sigma);
  fit.reconstruction.weight_coverage = static_cast<float>(s.fit_coverage);
  fit.shape.weight_length = static_cast<float>(s.fit_length);
  fit.shape.weight_spacing = static_cast<float>(s.fit_spacing);
  fit.shape.weight_bending = static_cast<float>(s.fit_bending);
  fit.shape.spacing = static_cast<float>(kMmPerMetre * s.sigma);
  fit.shape.least_length =
      static_cast<float>(kMmPerMetre * std::min(s.least_length, s.max_length()));
  fit.shape.most_length.fill(static_cast<float>(kMmPerMetre * s.max_length()));
  return fit;
}

SearchSettings search_settings(const PlanSettings& s) {
  SearchSettings search;
  search.samples = s.moved_samples();
  search.weak = s.weak_pressure;
  search.seed = static_cast<std::uint64_t>(s.seed);
  search.hysteresis = s.fit_hysteresis;
  if (s.traits().search == PathSearch::Short) {
    search.starts = 1;
    search.kicks = search.warm_starts = 0;
    search.fewer_evaluations = 0;
    search.start_evaluations = kFastEvaluations;
    search.small_evaluations = kFastSmallEvaluations;
    search.warm_evaluations = kFastWarmEvaluations;
    search.final_evaluations = 0;
    search.region_passes = kFastRegionPasses;
    search.stop_passes = kFastStopPasses;
    search.coarse_width = kFastWidth;
    search.fine_width = kFastFineWidth;
    search.fine_paths = kFastFinePaths;
    search.counts_steepness = false;
    return search;
  }
  search.starts = s.fit_starts;
  search.kicks = s.fit_kicks;
  return search;
}

int pieces_of(const PlanSettings& s) {
  return s.traits().halves_segments && kPieces * s.moved_samples() <= kMaxPathPoints ? kPieces : 1;
}

}  // namespace prostm::planning
