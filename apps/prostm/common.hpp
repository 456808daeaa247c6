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

/// Defaults, then the settings file, then the options. @throws InputError also for an output that
/// is a file which the settings name, and for an array that contradicts the device.
/// @param plays whether an array is to play what is planned: the device's own, unless another is
/// given.
PipelineSettings make_settings(const CommonOptions& options,
                               const std::optional<std::string>& scene, bool plays = false);

/// Locks the memory where `--lock-memory` asks for it, and says whether that was allowed, and
/// whether real-time priority is.
void obey_lock_memory(bool asked, std::FILE* out);

/// Says where an array file cannot be the transducers of the device; empty where it may be.
std::string doubt_of_array(const PipelineSettings& settings);

/// Whether `--array` or `--tracker` names a file, rather than one that is built in.
bool names_json(const std::string& name);
/// Whether `--hand` names a live tracker.
bool names_tracker(const std::string& hand);
/// Whether `--hand` names a recording, rather than a source that is built in.
bool names_recording(const std::string& hand);
/// The end of a sentence about a recording that is not there: the source that may have been meant.
std::string hint_for_hand(const std::string& hand);

/// The focus solver that `--solver` names. @throws InputError for a name that is unknown.
FocusMethod solver_of(const std::string& name);

/// Settles what `--hand` and `--hand-size` say of the settings: under a study hand the jets go to
/// the palm. @throws InputError for a size of another hand.
void settle_hand(const std::string& hand, std::optional<double> size, PipelineSettings& settings);

/// The hands that `--hand` names. A recording starts again at its end.
std::unique_ptr<HandSource> make_hands(const std::string& name, const PipelineSettings& settings);

/// Says what went wrong.
std::string sentence_of(const std::exception_ptr& failure);
/// Prints that to standard error. @return the exit status it asks for.
int tell(const std::exception_ptr& failure);

/// Prints a warning to standard error.
void warn(const std::string& sentence);
/// Warns of what is unusual in a recording of hands.
void warn_of(const HandSource& hands);

/// Does several things, each whatever became of the others.
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
  /// @throws what the first that failed threw.
  void finish() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

/// Where a command's prose goes: standard output, or standard error when standard output carries
/// the JSON.
std::FILE* prose(const std::string& json_option);

/// Says that an output was written: "wrote palm.png". Says nothing for "-" and for no name.
void say_written(std::FILE* out, const std::string& path);

/// Writes what was printed. @throws InputError when it cannot be.
void flush(std::FILE* out);

/// Writes JSON to what `--json` names, with the program's version and commit in an object's key
/// "prostm"; numbers that are not finite become null. Does nothing if the option is empty.
void write_json(const std::string& json_option, nlohmann::ordered_json value);

/// Waits [s].
void pause(double seconds);

nlohmann::ordered_json device_json(const DeviceInfo& device);
nlohmann::ordered_json to_json(const Summary& summary, double unit);

/// A table of metrics, a row for each of what they are of; a metric that no row knows has no
/// column.
struct MetricsRow {
  MetricsRow(std::string row, const Metrics& of) : name(std::move(row)), metrics(of) {}
  std::string name;
  const Metrics& metrics;
};
void print_metrics(std::FILE* out, const std::string& heading, const std::vector<MetricsRow>& rows);

/// Prints each as "warning: …".
void print_warnings(std::FILE* out, const std::vector<std::string>& warnings);

/// Three decimals; what rounds to zero has no sign.
std::string thousandths(double value);

/// Says what of a plan was chosen by what is felt; empty where that does not count.
std::string felt_words(const PipelineSettings& settings);

/// Checks that the device of the settings can play in a mode. @throws InputError.
void check_mode(const PipelineSettings& settings, RunMode mode);

/// Whether a live tracker never sent anything.
bool never_came(const std::optional<TrackerStatus>& tracker);

inline constexpr int kNoFrame = 3;   ///< exit status: the tracker never sent a frame
inline constexpr int kBadInput = 2;  ///< exit status, also for files that cannot be written

}  // namespace prostm::app
