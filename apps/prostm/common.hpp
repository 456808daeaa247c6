#pragma once
/// What the commands share: settings, hands, progress, Ctrl-C, and JSON.

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "acoustics/focus_solver.hpp"
#include "core/distribution.hpp"
#include "io/settings_file.hpp"
#include "options.hpp"
#include "pipeline/settings.hpp"
#include "score/score.hpp"
#include "track/hand_source.hpp"

namespace prostm::app {

/// Defaults, then the settings file, then the options. @throws InputError also for an output that
/// is a file which the settings name.
PipelineSettings make_settings(const CommonOptions& options,
                               const std::optional<std::string>& scene);

/// Whether `--array` or `--tracker` names a file, rather than one that is built in.
bool names_json(const std::string& name);
/// Whether `--hand` names a recording, rather than a source that is built in.
bool names_recording(const std::string& hand);

/// The focus solver that `--solver` names. @throws InputError for a name that is unknown.
FocusMethod solver_of(const std::string& name);

/// All settings as {"pipeline": {…}, "plan": {…}, …}.
std::string settings_json(PipelineSettings settings);

/// The hands that `--hand` names. `duration` gets the recording's length, or infinity [s].
std::unique_ptr<HandSource> make_hands(const std::string& name, const PipelineSettings& settings,
                                       double& duration);

/// From construction on, Ctrl-C (SIGINT) and SIGTERM only set a flag; a second one ends the program
/// at once.
class Interrupt {
 public:
  Interrupt();
  bool requested() const;
};

/// One line on a terminal, rewritten a few times a second; silent elsewhere.
class Progress {
 public:
  explicit Progress(std::string what) : what_(std::move(what)) {}
  ~Progress();
  void show(double done, double all, const char* unit);
  /// A line that stays, above the one that is rewritten.
  void say(std::FILE* out, const std::string& line);

 private:
  void clear();

  std::string what_;
  double last_ = -1.0;
  bool shown_ = false;
};

/// Where a command's prose goes: standard output, or standard error when standard output carries
/// the JSON.
std::FILE* prose(const std::string& json_option);

/// Writes JSON to what `--json` names; numbers that are not finite become null. Nothing when it
/// names nothing.
void write_json(const std::string& json_option, const nlohmann::ordered_json& value);

nlohmann::ordered_json to_json(const Summary& summary, double unit);
nlohmann::ordered_json to_json(const Metrics& metrics);

inline constexpr int kInterrupted = 130;  ///< exit status after Ctrl-C

}  // namespace prostm::app
