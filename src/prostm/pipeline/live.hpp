#pragma once
/// Live control of a run: commands, refusals and state.

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

/// A viewer's command, executed between two steps.
struct LiveCommand {
  enum class Kind : std::uint8_t {
    Set,        ///< sets a control
    Configure,  ///< replaces all settings
    Play,
    Pause,
    Step,        ///< pauses, and advances by one plan update
    Seek,        ///< moves within the recording
    TrackerPose  ///< sets the pose of the tracker
  } kind = Kind::Play;
  std::uint32_t sender = 0;  ///< the viewer to answer
  int control = 0;           ///< for Set: index in run_controls()
  double value = 0.0;        ///< for Set; for Seek, the time [s]
  Pose X_DT = Pose::Identity();
  std::shared_ptr<const LiveSettings> settings = {};  ///< for Configure
};

/// The reason why a command was refused.
struct LiveRefusal {
  std::uint32_t sender = 0;
  std::string sentence;
};

/// State of a run.
struct LiveState {
  LiveSettings settings;
  bool playing = true;
  double recording_length = 0.0;         ///< length of the hands' recording [s]; 0 without one
  std::optional<TrackerStatus> tracker;  ///< status, if hands are tracked live
  Pose X_DT = Pose::Identity();          ///< pose of the tracker
};

/// Passes data between one viewer's thread and the thread that runs the pipeline, without blocking
/// either.
class LiveControl {
 public:
  // ---- the viewer's thread ----
  /// Queues a command. False if the queue is full.
  bool ask(const LiveCommand& command) { return commands_.push(command); }
  bool next_refusal(LiveRefusal& out) { return refusals_.pop(out); }
  bool refresh() { return state_.refresh(); }
  const LiveState& state() const { return state_.value(); }

  // ---- the running thread ----
  bool pending() { return commands_.front() != nullptr; }
  bool next(LiveCommand& out) { return commands_.pop(out); }
  /// Queues a refusal; dropped if the queue is full.
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
  LiveSettings settings;                                  ///< initial settings
  std::shared_ptr<Mute> mute = std::make_shared<Mute>();  ///< the pipeline's mute
  std::shared_ptr<PageHand> page_hand;
  HandSwitch* hands = nullptr;  ///< the pipeline's hands
  /// Makes hands from the name of their source; the page's hand takes precedence. @throws
  /// InputError.
  std::function<std::unique_ptr<HandSwitch>(const std::string& source, const PipelineSettings&)>
      make_hands;
  /// Writes a new pose of the tracker. @throws InputError.
  std::function<void(const Calibration&)> save_pose;
  std::string pose_file;  ///< written by save_pose
};

}  // namespace prostm
