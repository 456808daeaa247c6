#pragma once
/// HDF5 recordings: target fields, hands, plans and run statistics, for Python, MATLAB and Julia.

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "prostm/plan/planner.hpp"
#include "prostm/stimulus/stimulus_gate.hpp"
#include "prostm/target/target_field.hpp"
#include "prostm/track/hand_frame.hpp"

namespace prostm {

/// A plan of a recording, and what its reconstruction depends on.
struct RecordedPlan {
  Plan plan;
  PlanStats stats;
  double full_scale_pressure = 0.0;            ///< rendered, at intensity 1 [Pa]
  std::array<double, kMaxPatches> sigma = {};  ///< σ that each patch was planned with [m]
};

/// Tries whether a recording could be made there, before the work that fills it. @throws
/// InputError: as check_writable, no ordinary file, or a name that does not end in .h5.
void check_recording(const std::string& path);

/// Writes a recording frame by frame into `path` + ".part.h5" and renames it at close(); flushed
/// every second of data, so that a killed run leaves a file that opens. Earliest HDF5 file format.
/// The layout, units and attributes are in docs/guides/recordings.md.
class Recorder {
 public:
  /// @param settings kept as an attribute. @throws InputError as check_recording.
  Recorder(const std::string& path, const std::vector<SettingsGroup>& settings);
  ~Recorder();  ///< closes like close(), but keeps quiet about errors

  /// Appends a frame: one group entry per target patch, the hands (frame D), and the plan when
  /// there is one (its points and pressures, padded with NaN to kMaxPathPoints), and what a gate
  /// said of the frame, if one did. @throws InputError when the disk is full.
  void append(const TargetFrame& frame, const HandFrame& hands, const RecordedPlan* plan,
              const std::optional<GateResult>& gate = {});
  /// Writes an attribute of the whole recording, e.g. the run's summary.
  void set_attribute(const std::string& name, const std::string& value);
  void close();
  bool open() const;  ///< neither closed nor given up on a full disk

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads the targets and plans of a recording, each when it is asked for.
class RecordingReader {
 public:
  /// @throws InputError: not a recording, truncated, of another version, open for writing.
  explicit RecordingReader(const std::string& path);
  ~RecordingReader();
  int frames() const;
  std::span<const double> times() const;  ///< time of each frame [s]
  /// Returns a text of the whole recording, e.g. "scene"; empty if it is absent.
  std::string attribute(const char* name) const;
  /// @throws InputError for a frame that does not exist or is broken.
  TargetFrame frame(int i) const;
  /// Returns the plan made in a frame, if one was made. @throws InputError as frame() does.
  std::optional<RecordedPlan> plan(int i) const;
  /// Returns what the gate said of a frame; nothing if it said nothing, or if an earlier version
  /// recorded it. @throws InputError as frame() does.
  std::optional<GateResult> gate(int i) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
