#pragma once
/// Code that the commands share: settings, hands, progress, signals, failures and JSON.

#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "interrupt.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "prostm/acoustics/focus/focus_solver.hpp"
#include "prostm/core/distribution.hpp"
#include "prostm/io/settings_file.hpp"
#include "prostm/pipeline/runner.hpp"
#include "prostm/pipeline/settings.hpp"
#include "prostm/score/score.hpp"
#include "prostm/track/hand_source.hpp"

namespace prostm::app {

/// Returns the defaults, changed by the settings file and then by the options. @throws InputError
/// for bad settings, an output file that the settings name as an input, and an array that
/// contradicts the device.
/// @param plays whether an array plays the plans: the device's own, unless another is given.
PipelineSettings make_settings(const CommonOptions& options,
                               const std::optional<std::string>& scene, bool plays = false);

/// Locks the memory if `--lock-memory` is given, and prints whether that and real-time priority are
/// allowed.
void obey_lock_memory(bool asked, std::FILE* out);

/// Returns a sentence if an array file cannot describe the device's transducers, else nothing.
std::string doubt_of_array(const PipelineSettings& settings);

/// Whether the value of `--array` or `--tracker` is a file, not a built-in name.
bool names_json(const std::string& name);
/// Whether `--hand` names a live tracker.
bool names_tracker(const std::string& hand);
/// Whether `--hand` names a recording, not a built-in source.
bool names_recording(const std::string& hand);
/// Returns the end of a sentence about a missing recording: the source that was probably meant.
std::string hint_for_hand(const std::string& hand);

/// The focus solver that `--solver` names. @throws InputError for a name that is unknown.
FocusMethod solver_of(const std::string& name);

/// Applies `--hand` and `--hand-size` to the settings: with a study hand the jets follow the palm.
/// @throws InputError for the size of another hand.
void settle_hand(const std::string& hand, std::optional<double> size, PipelineSettings& settings);

/// The hands that `--hand` names. A recording starts again at its end.
std::unique_ptr<HandSource> make_hands(const std::string& name, const PipelineSettings& settings);

/// Returns a sentence about a failure.
std::string sentence_of(const std::exception_ptr& failure);
/// Prints that sentence to standard error. @return the exit status of the failure.
int tell(const std::exception_ptr& failure);

/// Prints a warning to standard error.
void warn(const std::string& sentence);
/// Prints warnings about unusual content of a recording of hands.
void warn_of(const HandSource& hands);

/// Runs several actions, each even if others failed.
class Attempts {
 public:
  template <class Function>
  void add(Function&& f) {
    try {
      f();
    } catch (...) {
      if (!first_) first_ = std::current_exception();
    }
  }
  /// @throws the exception of the first action that failed.
  void finish() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

/// Returns the stream for a command's text: standard output, or standard error if JSON goes to
/// standard output.
std::FILE* prose(const std::string& json_option);

/// Prints that an output was written: "wrote palm.png". Prints nothing for "-" or an empty name.
void say_written(std::FILE* out, const std::string& path);

/// Flushes the stream. @throws InputError if it cannot be written.
void flush(std::FILE* out);

/// Writes JSON to the file of `--json`, with the program's version and commit under the key
/// "prostm" of an object; numbers that are not finite become null. Does nothing without the option.
void write_json(const std::string& json_option, nlohmann::ordered_json value);

/// Waits [s].
void pause(double seconds);

nlohmann::ordered_json device_json(const DeviceInfo& device);
nlohmann::ordered_json to_json(const Summary& summary, double unit);

/// A row of a table of metrics; a metric that is missing in all rows has no column.
struct MetricsRow {
  MetricsRow(std::string row, const Metrics& of) : name(std::move(row)), metrics(of) {}
  std::string name;
  const Metrics& metrics;
};
void print_metrics(std::FILE* out, const std::string& heading, const std::vector<MetricsRow>& rows);

/// Prints each as "warning: …".
void print_warnings(std::FILE* out, const std::vector<std::string>& warnings);

/// Formats with three decimals; a value that rounds to zero has no sign.
std::string thousandths(double value);

/// Returns a sentence about the parts of a plan that are chosen by the skin model; empty if none.
std::string felt_words(const PipelineSettings& settings);

/// Checks that the device of the settings can play in a mode. @throws InputError.
void check_mode(const PipelineSettings& settings, RunMode mode);

/// Whether a live tracker never sent a frame.
bool never_came(const std::optional<TrackerStatus>& tracker);

inline constexpr int kNoFrame = 3;   ///< exit status: the tracker never sent a frame
inline constexpr int kBadInput = 2;  ///< exit status, also for files that cannot be written

}  // namespace prostm::app
