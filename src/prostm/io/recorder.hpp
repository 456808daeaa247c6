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

/// A plan of a recording, with the parameters of its reconstruction.
struct RecordedPlan {
  Plan plan;
  PlanStats stats;
  double full_scale_pressure = 0.0;            ///< rendered pressure at intensity 1 [Pa]
  std::array<double, kMaxPatches> sigma = {};  ///< σ used for planning each patch [m]
};

/// Checks early that a recording can be made at `path`. @throws InputError: as check_writable(),
/// not an ordinary file, or a name that does not end in .h5.
void check_recording(const std::string& path);

/// Writes a recording frame by frame into `path` + ".part.h5" and renames it at close(); flushed
/// after every second of data, so that a killed run leaves a readable file. Uses the earliest HDF5
/// file format. Layout, units and attributes are described in docs/guides/recordings.md.
class Recorder {
 public:
  /// @param settings stored as an attribute. @throws InputError as check_recording.
  Recorder(const std::string& path, const std::vector<SettingsGroup>& settings);
  ~Recorder();  ///< closes like close(), but ignores errors

  /// Appends a frame: one entry per target patch, the hands (in D), the plan, if any (points and
  /// pressures, padded with NaN to kMaxPathPoints), and the gate's verdict, if any. @throws
  /// InputError if the disk is full.
  void append(const TargetFrame& frame, const HandFrame& hands, const RecordedPlan* plan,
              const std::optional<GateResult>& gate = {});
  /// Writes an attribute of the whole recording, e.g. the run's summary.
  void set_attribute(const std::string& name, const std::string& value);
  void close();
  bool open() const;  ///< neither closed nor stopped by a full disk

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads the targets and plans of a recording on request.
class RecordingReader {
 public:
  /// @throws InputError: not a recording, truncated, of another version, open for writing.
  explicit RecordingReader(const std::string& path);
  ~RecordingReader();
  int frames() const;
  std::span<const double> times() const;  ///< time of each frame [s]
  /// Returns a text attribute of the recording, e.g. "scene"; empty if absent.
  std::string attribute(const char* name) const;
  /// Returns the target of a frame. @throws InputError for a frame that does not exist or is
  /// damaged.
  TargetFrame frame(int i) const;
  /// Returns the plan made in a frame, if any. @throws InputError as frame().
  std::optional<RecordedPlan> plan(int i) const;
  /// Returns the gate's verdict on a frame; nothing if there was none, or in recordings of earlier
  /// versions. @throws InputError as frame().
  std::optional<GateResult> gate(int i) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace prostm
