#pragma once
/// A run that is steered while it goes: what is asked of it, what it answers, and how it is.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "prostm/core/latest.hpp"
#include "prostm/core/spsc_ring.hpp"
#include "prostm/pipeline/controls.hpp"
#include "prostm/pipeline/snapshot.hpp"
#include "prostm/track/calibration_guide.hpp"
#include "prostm/track/hand_source.hpp"
#include "prostm/track/live/page_hand.hpp"

namespace prostm {

/// Asked by an onlooker, done between two steps.
struct LiveCommand {
  enum class Kind : std::uint8_t {
    Set,        ///< a control
    Configure,  ///< all settings
    Play,
    Pause,
    Step,        ///< pauses, and goes on by one plan update
    Seek,        ///< of the recording
    TrackerPose  ///< where the tracker stands
  } kind = Kind::Play;
  std::uint32_t sender = 0;  ///< who gets the answer
  int control = 0;           ///< of Set: its place in run_controls()
  double value = 0.0;        ///< of Set, or the time of Seek [s]
  Pose X_DT = Pose::Identity();
  std::shared_ptr<const LiveSettings> settings = {};  ///< of Configure
};

/// Why something that was asked for was not done.
struct LiveRefusal {
  std::uint32_t sender = 0;
  std::string sentence;
};

/// How a run stands.
struct LiveState {
  LiveSettings settings;
  bool playing = true;
  double recording_length = 0.0;         ///< of the hands' recording, 0 without one [s]
  std::optional<TrackerStatus> tracker;  ///< of hands that are tracked live
  Pose X_DT = Pose::Identity();          ///< where the tracker stands
};

/// The hand-off between one onlooker's thread and the thread that runs the pipeline. Neither waits.
class LiveControl {
 public:
  // ---- the onlooker's thread ----
  /// False when too much waits already.
  bool ask(const LiveCommand& command) { return commands_.push(command); }
  bool next_refusal(LiveRefusal& out) { return refusals_.pop(out); }
  bool refresh() { return state_.refresh(); }
  const LiveState& state() const { return state_.value(); }

  // ---- the running thread ----
  bool pending() { return commands_.front() != nullptr; }
  bool next(LiveCommand& out) { return commands_.pop(out); }
  /// When too many wait already it is lost.
  void refuse(std::uint32_t sender, std::string sentence) {
    refusals_.push({sender, std::move(sentence)});
  }
  void publish(const LiveState& state) {
    state_.draft() = state;
    state_.publish();
  }

 private:
  SpscRing<LiveCommand> commands_{256};
  SpscRing<LiveRefusal> refusals_{64};
  Latest<LiveState> state_;
};

/// The link through which a run is watched and steered; outlives the run.
struct LiveLink {
  Snapshots snapshots;
  LiveControl control;
  LiveSettings settings;                                  ///< at the start
  std::shared_ptr<Mute> mute = std::make_shared<Mute>();  ///< that the pipeline was made with
  std::shared_ptr<PageHand> page_hand;
  HandSwitch* hands = nullptr;  ///< those of the pipeline
  /// Hands by the name of their source, behind the page's. @throws InputError.
  std::function<std::unique_ptr<HandSwitch>(const std::string& source, const PipelineSettings&)>
      make_hands;
  /// Writes a new pose of the tracker. @throws InputError.
  std::function<void(const Calibration&)> save_pose;
  std::string pose_file;  ///< that save_pose writes
};

}  // namespace prostm
