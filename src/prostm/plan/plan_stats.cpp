#include "prostm/plan/plan_stats.hpp"

#include <array>

namespace prostm {
namespace {

constexpr Quantity<PlanStats> stage(const char* name, double PlanStats::*time, const char* help) {
  return {.name = name,
          .unit = "us",
          .help = help,
          .value = time,
          .better = Better::Less,
          .scale = 1e6,
          .group = "stage_us"};
}

constexpr Quantity<PlanStats> count(const char* group, const char* name, int PlanStats::*number,
                                    const char* help, Better better = Better::Neither) {
  return {
      .name = name, .unit = "", .help = help, .value = number, .better = better, .group = group};
}

// the stages come first
constexpr std::array kStats{
    stage("init", &PlanStats::init, "Finding the skin and its pressure."),
    stage("kmeans", &PlanStats::kmeans, "Clustering."),
    stage("tour", &PlanStats::tour, "The closed tour of the clusters."),
    stage("split", &PlanStats::split, "Splitting the tour."),
    stage("resample", &PlanStats::resample, "Even points along each path."),
    stage("refine", &PlanStats::refine, "Refinement, repair of paths, and pressures."),
    stage("total", &PlanStats::total, "All stages."),
    count("counts", "clusters", &PlanStats::clusters, "Clusters with pressure."),
    count("counts", "lloyd_iterations", &PlanStats::lloyd_iterations,
          "Iterations of the clustering."),
    count("counts", "refine_iterations", &PlanStats::refine_iterations, "Gradient steps."),
    count("counts", "cost_evaluations", &PlanStats::cost_evaluations,
          "Cost evaluations in the refinement."),
    count("counts", "leaves", &PlanStats::leaves,
          "Paths after splitting, before the heaviest are kept."),
    Quantity<PlanStats>{.name = "cost",
                        .unit = "",
                        .help = "Cost of the paper's Eqs. (2)-(5) after refinement.",
                        .value = &PlanStats::cost,
                        .better = Better::Less,
                        .group = "counts"},
    count("violations", "long_paths", &PlanStats::long_paths,
          "Paths longer than the limit by > 0.5 mm.", Better::Less),
    count("violations", "crossings", &PlanStats::crossings,
          "Pairs of segments that cross, within and between paths.", Better::Less),
};

}  // namespace

template <>
std::span<const Quantity<PlanStats>> quantities<PlanStats>() {
  return kStats;
}

std::span<const Quantity<PlanStats>, kPlanStages> plan_stages() {
  return std::span(kStats).first<kPlanStages>();
}

}  // namespace prostm
