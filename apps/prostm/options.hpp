#pragma once
/// The options of the command line, one struct per command.

#include <optional>
#include <string>
#include <vector>

#include "files.hpp"
#include "prostm/io/array_file.hpp"
#include "prostm/io/field/field_file.hpp"
#include "prostm/study/analysis/analysis.hpp"
#include "prostm/study/analysis/model_study.hpp"
#include "prostm/study/analysis/percepts.hpp"
#include "prostm/study/analysis/study_power.hpp"

namespace prostm::app {

/// Options of every command that runs a stage. An unset optional keeps the value of the settings
/// file, or the default.
struct CommonOptions {
  Files files;  ///< all files of the command line
  std::string settings_file;
  std::string json;  ///< file, "-" for standard output, empty for none
  std::string figure;
  std::optional<int> seed;
  std::optional<std::string> method, preset, array, tracker, device, world;
  std::optional<int> paths;
  std::optional<double> budget_ms;
  std::optional<int> grid;
};

inline constexpr const char* kTrackerFile = "prostm-tracker.json";  ///< unless one is given

struct RunOptionsGiven {
  CommonOptions common;
  std::optional<std::string> scene;
  std::string hand = "scripted";
  std::optional<double> hand_size;
  std::optional<double> seconds, figure_at;
  bool as_fast_as_possible = false, stepped = false;
  std::string record;
  std::optional<std::string> switch_at;
  bool lock_memory = false;
  bool view = false, stay = false;
  std::optional<std::string> view_address;
  std::vector<std::string> view_hosts;
  std::optional<int> view_port;
  std::optional<std::string> tracker_file;  ///< written by the page's calibration
};

struct PlanOptionsGiven {
  CommonOptions common;
  std::string field;
  FieldFileOptions file;  ///< how `field` is read
  std::string beside;     ///< digitised figure to draw beside the panels
};

struct CaptureOptionsGiven {
  CommonOptions common;
  std::optional<std::string> scene;
  std::string hand = "scripted";
  std::optional<double> hand_size;
  int frames = 500;
  std::string out;
};

struct BenchOptionsGiven {
  CommonOptions common;
  std::vector<std::string> files;
  int repeats = 3;
};

struct SolveOptionsGiven {
  Files files;
  std::string foci;
  std::string array = prostm::array_kinds().front().name;
  std::string solver = "weighted";
  std::string json;
};

struct FieldOptionsGiven {
  CommonOptions common;  ///< settings file, array, JSON and figure
  std::string plan;
  std::string target;     ///< the field that the plan was made for; empty: no target
  FieldFileOptions file;  ///< how `target` is read
  std::string solver = "weighted";
  double full_scale_pa = 0.0;
  bool memoryless = false;
  bool felt_spectrum = false;  ///< print the percept of each harmonic
  bool widths = false;         ///< print widths of a focus instead of the field of a plan
};

struct LevelsOptionsGiven {
  CommonOptions common;  ///< settings file, array and JSON
};

struct DevicesOptionsGiven {
  Files files;
  std::vector<std::string> names;  ///< what to probe; empty: everything on this machine
  std::string json;
  bool budget = false;
};

struct SelftestOptionsGiven {
  CommonOptions common;      ///< device, array, settings file, JSON and figure
  double seconds = 4.0;      ///< duration of each figure
  double height_mm = 150.0;  ///< height of the figures above the array
  double level = 1.0;        ///< largest intensity
  bool yes = false;          ///< play without being asked
  bool silent = false;       ///< play nothing
};

struct SoakOptionsGiven {
  RunOptionsGiven run;
  double minutes = 30.0;
  bool load = false;  ///< load all cores during the middle third
};

struct SettingsOptionsGiven {
  CommonOptions common;
  std::string name;   ///< a group, a key, or group.key; empty: all
  bool toml = false;  ///< print a settings file
};

struct CheckOptionsGiven {
  Files files;
  std::optional<std::string> scene;  ///< nothing: every scene with a stimulus
  std::string json;
};

struct StudyRunOptionsGiven {
  RunOptionsGiven run;  ///< hand, device, settings and pages
  std::string protocol;
  std::string participant;         ///< number
  std::string replaces;            ///< the participant whom this one replaces; empty: none
  std::string folder = "answers";  ///< of the response files
  bool resume = false;
  bool take_over = false;            ///< replace a lock file of another machine
  std::optional<int> rehearse;       ///< trials, 0: all; nothing: people answer
  bool as_fast_as_possible = false;  ///< rehearse with a simulated clock, without pages
  std::vector<std::string> markers;  ///< addresses that receive markers
};

struct StudyCheckOptionsGiven {
  CommonOptions common;
  std::string protocol;
};

struct StudyStatusOptionsGiven {
  Files files;
  std::vector<std::string> answers = {"answers"};  ///< folders and response files
  std::string json;
};

struct AnalyseOptionsGiven {
  Files files;
  std::vector<std::string> answers;
  std::string json, figure;
  std::string tidy;                 ///< file for the answers
  std::optional<std::string> ties;  ///< of paired comparisons
  ReadingSettings reading;
  AnalysisSettings settings;
};

struct PowerOptionsGiven {
  Files files;
  std::string json;
  std::string methods = "between";
  std::optional<double> first, second;  ///< assumed shares of right answers
  std::optional<int> trials;            ///< of each participant with each method
  std::optional<double> correlation, alike;
  StudyDesign design;
  std::optional<int> participants;  ///< per method, or in total
  int studies = 2000;
  std::uint64_t seed = 1;
};

inline constexpr const char* kPaperData = "../shared/data/paper";

struct SimulateOptionsGiven {
  Files files;
  std::string json, answers;
  std::optional<std::string> paper_data;  ///< folder of fig4.json
  std::string preset = "paper";
  StudyShape shape;
  int studies = 1000;
  int hands = 6;
  int grid = 64;
  int seed = 1;
  double noise = 1.0;          ///< factor on the observers' own noise
  double sound = kStudySound;  ///< acoustic pressure at intensity 1 [Pa, rms]; not an option
};

struct ReportOptionsGiven {
  Files files;
  std::string out;                        ///< folder
  std::optional<std::string> paper_data;  ///< folder of fig2.field.json, fig2.json and fig4.json
  int seed = 2026;
  bool quick = false, fresh = false;
};

struct ExperimentsOptionsGiven {
  Files files;
  std::vector<std::string> names;  ///< experiments; empty: all
  std::string set;                 ///< fit or held-out; empty: both
  std::string model, readout;      ///< empty: all
  std::string fit;                 ///< file for the fitted parameters; empty: predict
  bool leave_one_out = false;      ///< fit without each paper in turn
  bool variations = false;         ///< the paper's study in variations
  std::string json, figure;
};

/// Each returns the exit status of the program; bad input is thrown as InputError or
/// std::invalid_argument. The files that the options name have been checked.
int run_command(const RunOptionsGiven& options);
int plan_command(const PlanOptionsGiven& options);
int capture_command(const CaptureOptionsGiven& options);
int bench_command(const BenchOptionsGiven& options);
int solve_command(const SolveOptionsGiven& options);
int field_command(const FieldOptionsGiven& options);
int levels_command(const LevelsOptionsGiven& options);
int devices_command(const DevicesOptionsGiven& options);
int selftest_command(const SelftestOptionsGiven& options);
int soak_command(const SoakOptionsGiven& options);
int settings_command(const SettingsOptionsGiven& options);
int check_command(const CheckOptionsGiven& options);
int study_check_command(const StudyCheckOptionsGiven& options);
int study_run_command(const StudyRunOptionsGiven& options);
int study_status_command(const StudyStatusOptionsGiven& options);
int analyse_command(const AnalyseOptionsGiven& options);
int power_command(const PowerOptionsGiven& options);
int simulate_command(const SimulateOptionsGiven& options);
int experiments_command(const ExperimentsOptionsGiven& options);
int report_command(const ReportOptionsGiven& options);

}  // namespace prostm::app
