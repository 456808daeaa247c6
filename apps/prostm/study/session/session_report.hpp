#pragma once
/// The report of a session that has ended.

#include <array>
#include <cstdio>

#include "prostm/pipeline/runner.hpp"
#include "prostm/study/session/response_file.hpp"
#include "prostm/study/session/session.hpp"
#include "run/run_quality.hpp"

namespace prostm::app {

/// Plans of the stimuli of a session, those of paths and those of stationary foci.
class SessionPlans {
 public:
  void offer(const WorldFrame& contact, const PlanFrame& plan) {
    if (plan.status != PlanStatus::Planned) return;
    const Method kind = plan.plan.foci.empty() ? Method::ProStm : Method::Am;
    plans_[static_cast<std::size_t>(kind)].offer(contact, plan);
  }
  /// Prints their quality, which takes about a second for each of the two.
  /// @param settings of the session; those of the output are the protocol's.
  void print_quality(std::FILE* out, PipelineSettings settings, const Protocol& protocol) const;

 private:
  std::array<PlanSample, 2> plans_;  // by Method
};

/// Prints answers, strengths, what the machine missed, and how strongly the stimuli are felt.
void print_session(std::FILE* out, const StudySession& session, const ResponseFile& file,
                   const RunSummary& summary, const SessionPlans& plans,
                   const PipelineSettings& settings);

/// Writes what could not yet be written. @throws InputError: answers are lost.
void require_written(StudySession& session, double time);

}  // namespace prostm::app
