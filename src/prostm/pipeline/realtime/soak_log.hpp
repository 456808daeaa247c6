#pragma once
/// Long runs: what went wrong in them, when, and the likely cause.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prostm/device/device.hpp"
#include "prostm/pipeline/realtime/machine.hpp"

namespace prostm {

/// Counters of a run at one moment. All of them only grow.
struct SoakCounts {
  DeviceStats device;
  std::int64_t skipped_steps = 0;  ///< of the world
  std::int64_t skipped_plans = 0;  ///< targets that were not planned
  std::int64_t stalls = 0;         ///< fade-outs because no plan came
  std::int64_t limited = 0;        ///< samples that the limiter changed
  std::int64_t hot = 0;            ///< times that the hardware said it was too hot
  std::int64_t gone = 0;           ///< times that the device was lost
  std::string problem;             ///< of a device that is lost
};

/// Something that went wrong.
struct SoakDip {
  double time = 0.0;       ///< since the start [s]
  int part = 0;            ///< of the run, 0..2
  std::string what;        ///< the counter that grew, for people
  std::int64_t count = 0;  ///< by how much
  /// Whether it is a close call: the queue covered it, and nothing can be felt of it.
  bool covered = false;
  std::string cause;  ///< the most likely one
};

/// A third of a run.
struct SoakPart {
  bool loaded = false;          ///< beside other work on all cores
  double from = 0.0, to = 0.0;  ///< [s]
  std::int64_t dips = 0, covered = 0;
  double world_rate = 0.0, plan_rate = 0.0;  ///< so far [Hz]
};

/// Follows a run of three parts: quiet, loaded or not, and quiet. Times are since its start [s].
class SoakLog {
 public:
  /// @param seconds of the whole run.  @param load whether the part in the middle is loaded.
  /// @param cores of the machine.
  SoakLog(double seconds, bool load, int cores);

  int part_at(double time) const;
  /// Whether other work is to run.
  bool is_loaded_at(double time) const;

  /// The counters, a few hundred times a second: the time between two calls tells how long the
  /// program had to wait. The first call says where they begin.
  void count(double time, const SoakCounts& counts);
  /// A plan update. @param step how many the world made.  @param due of the step [s].
  /// @param updates how many plan updates there were.  @param work of the step, and of the plan
  /// [s].  @param step_time from one step to the next [s].
  void update(double due, std::int64_t step, std::int64_t updates, double work, double step_time);
  /// How the machine was used so far, a few times a second: tells the causes of the dips since the
  /// call before.
  void use(double time, const MachineUse& use);
  /// Tells the causes of the last dips. @param time when the run ended [s].
  void end(double time, const MachineUse& use);

  /// Those with a cause, in the order of time; at most kMostDips of a part, and as many close
  /// calls.
  std::span<const SoakDip> dips() const { return dips_; }
  std::int64_t left_out() const { return left_out_; }  ///< dips and close calls beyond that
  const std::array<SoakPart, 3>& parts() const { return parts_; }
  /// Whether no dip was in a quiet part.
  bool is_quiet_clean() const;

  static constexpr std::size_t kMostDips = 10'000;

 private:
  void add(double time, const std::string& what, std::int64_t more, bool covered);
  std::string cause_of(const SoakDip& dip, double seconds, const MachineUse& use) const;
  void forget_evidence();

  const double settle_;  // [s]
  const int cores_;
  std::array<SoakPart, 3> parts_;
  bool counting_ = false;
  SoakCounts counts_;
  std::vector<SoakDip> dips_, open_;                  // open: without a cause yet
  std::array<std::array<std::size_t, 2>, 3> kept_{};  // of each part: dips, and close calls
  std::int64_t left_out_ = 0;

  // evidence since the last look at the machine
  MachineUse use_;
  std::string problem_;
  double used_at_ = 0.0, counted_at_ = 0.0;                          // [s]
  double longest_gap_ = 0.0, longest_work_ = 0.0, step_time_ = 0.0;  // [s]

  struct Mark {
    double due = 0.0;
    std::int64_t step = 0, updates = 0;
  };
  std::array<Mark, 3> first_;  // update of each part
  std::array<bool, 3> begun_{};
};

}  // namespace prostm
