#pragma once
/// Log of a long run: faults, their times and likely causes.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "prostm/device/device.hpp"
#include "prostm/pipeline/realtime/machine.hpp"

namespace prostm {

/// Counters of a run at one moment; they never decrease.
struct SoakCounts {
  DeviceStats device;
  std::int64_t skipped_steps = 0;  ///< skipped steps of the world
  std::int64_t skipped_plans = 0;  ///< targets that were never planned
  std::int64_t stalls = 0;         ///< fade-outs for lack of a plan
  std::int64_t limited = 0;        ///< samples that the limiter changed
  std::int64_t hot = 0;            ///< times that the hardware reported overheating
  std::int64_t gone = 0;           ///< times that the device was lost
  std::string problem;             ///< problem of a lost device
};

/// A fault.
struct SoakDip {
  double time = 0.0;       ///< since the start [s]
  int part = 0;            ///< part of the run, 0..2
  std::string what;        ///< name of the counter that increased, for people
  std::int64_t count = 0;  ///< increase
  /// Whether it was covered by the queue, and so cannot be felt.
  bool covered = false;
  std::string cause;  ///< most likely cause
};

/// A third of a run.
struct SoakPart {
  bool loaded = false;          ///< with other work on all cores
  double from = 0.0, to = 0.0;  ///< [s]
  std::int64_t dips = 0, covered = 0;
  double world_rate = 0.0, plan_rate = 0.0;  ///< mean so far [Hz]
};

/// Monitors a run of three parts: quiet, loaded (optional), and quiet. Times are since its start
/// [s].
class SoakLog {
 public:
  /// @param seconds duration of the whole run. @param load whether the middle part is loaded.
  /// @param cores number of cores of the machine.
  SoakLog(double seconds, bool load, int cores);

  int part_at(double time) const;
  /// Whether other work should run.
  bool is_loaded_at(double time) const;

  /// Records the counters. Call it a few hundred times per second: gaps between calls show how long
  /// the program was kept waiting. The first call sets the initial values.
  void count(double time, const SoakCounts& counts);
  /// Records a plan update. @param due time at which the step was due [s]. @param step number of
  /// steps so far. @param updates number of plan updates so far. @param work computing time of the
  /// step and the plan [s]. @param step_time time between steps [s].
  void update(double due, std::int64_t step, std::int64_t updates, double work, double step_time);
  /// Records the use of the machine, and finds the causes of the dips since the previous call. Call
  /// it a few times per second.
  void use(double time, const MachineUse& use);
  /// Finds the causes of the last dips. @param time end of the run [s].
  void end(double time, const MachineUse& use);

  /// Dips whose cause was found, in order of time; at most kMostDips of each part, and as many
  /// covered ones.
  std::span<const SoakDip> dips() const { return dips_; }
  std::int64_t left_out() const { return left_out_; }  ///< dips beyond that limit
  const std::array<SoakPart, 3>& parts() const { return parts_; }
  /// Whether the quiet parts had no dips.
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
  std::vector<SoakDip> dips_, open_;                  // open_: cause not found yet
  std::array<std::array<std::size_t, 2>, 3> kept_{};  // for each part: dips, and covered dips
  std::int64_t left_out_ = 0;

  // evidence since the last use()
  MachineUse use_;
  std::string problem_;
  double used_at_ = 0.0, counted_at_ = 0.0;                          // [s]
  double longest_gap_ = 0.0, longest_work_ = 0.0, step_time_ = 0.0;  // [s]

  struct Mark {
    double due = 0.0;
    std::int64_t step = 0, updates = 0;
  };
  std::array<Mark, 3> first_;  // first update of each part
  std::array<bool, 3> begun_{};
};

}  // namespace prostm
