#pragma once
/// A rehearsal with a simulated clock: smoke, planner and array advance step by step, as fast as
/// the machine computes them.

#include <memory>
#include <optional>

#include "prostm/pipeline/pipeline.hpp"
#include "prostm/pipeline/snapshot.hpp"
#include "prostm/study/session/rehearsal.hpp"
#include "prostm/study/session/session.hpp"

namespace prostm {

/// Presents the stimuli of a session on the caller's thread. Without pages: whatever the protocol
/// needs of the participant's page is met.
class SteppedRehearsal {
 public:
  /// @param mute the pipeline's. @param now the time at which the session began. All must outlive
  /// this. @pre the device does not keep its own time.
  SteppedRehearsal(Pipeline& pipeline, std::shared_ptr<Mute> mute, StudySession& session,
                   Rehearsal rehearsal, const StudySight& now);
  SteppedRehearsal(const SteppedRehearsal&) = delete;
  SteppedRehearsal& operator=(const SteppedRehearsal&) = delete;

  /// Computes one step. @return whether it included a plan, see Pipeline::plan(). @throws
  /// std::invalid_argument: a stimulus of the protocol cannot be played.
  bool step();
  /// Whether the trials are answered, or one cannot begin.
  bool is_done() const { return session_.closed() || rehearsal_.is_done(); }
  double time() const { return pipeline_.time(); }  ///< simulated [s]

 private:
  void take_plan();
  StudySight sight();
  void present(const StudyWanted& wanted);

  Pipeline& pipeline_;
  std::shared_ptr<Mute> mute_;
  StudySession& session_;
  Rehearsal rehearsal_;
  const StudySight began_;
  Snapshots snapshots_;
  RenderedPlan rendered_;
  std::optional<StudyWanted> presented_;
  std::shared_ptr<const PipelineSettings> settings_;  // for presented_
  double rendered_force_ = 0.0;                       // of the newest plan [N]
};

}  // namespace prostm
