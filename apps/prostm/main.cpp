/// The command line: parses, calls a command, and turns bad input into one sentence and exit
/// status 2.

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <system_error>

#include "common.hpp"
#include "options.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/recorder.hpp"
#include "prostm/version.hpp"
#include "usage.hpp"

namespace {

using namespace prostm::app;

/// The work that the command line asks for: it begins once all is parsed and files are checked.
struct Work {
  const Files* files = nullptr;  ///< null: none
  std::function<int()> run;
};

/// An option, or a positional, whose value is a file that the command reads.
template <class Value>
CLI::Option* add_input(CLI::App& command, Files& files, const std::string& name, Value& value,
                       const std::string& help) {
  return command.add_option(name, value, help)
      ->type_name("INPUT")
      ->each([&files, name](const std::string& path) { files.reads(name, path); });
}

/// The same, where some values are names of what is built in. @param hint says which of them a file
/// that is not there may stand for.
template <class Value>
CLI::Option* add_input_or_name(CLI::App& command, Files& files, const std::string& name,
                               Value& value, bool (*is_file)(const std::string&),
                               const std::string& help,
                               std::string (*hint)(const std::string&) = nullptr) {
  return command.add_option(name, value, help)
      ->type_name("NAME|INPUT")
      ->each([&files, name, is_file, hint](const std::string& path) {
        if (is_file(path)) files.reads(name, path, hint != nullptr ? hint(path) : std::string());
      });
}

/// An option whose value is a file that the command writes.
template <class Value>
CLI::Option* add_output(CLI::App& command, Files& files, const std::string& name, Value& value,
                        Files::Check check, const std::string& help) {
  return command.add_option(name, value, help)
      ->type_name("OUTPUT")
      ->each([&files, name, check](const std::string& path) { files.writes(name, path, check); });
}

/// One that takes one of a few words.
template <class Value>
CLI::Option* add_name(CLI::App& command, const std::string& name, Value& value,
                      const std::string& help) {
  return command.add_option(name, value, help)->type_name("NAME");
}

void add_json(CLI::App& command, Files& files, std::string& json) {
  add_output(command, files, "--json", json, check_json_output,
             "write the result as JSON; - is standard output");
}

void add_common(CLI::App& command, CommonOptions& o) {
  add_input(command, o.files, "--settings", o.settings_file,
            "settings of any stage, a TOML file (docs/files.md)");
  add_json(command, o.files, o.json);
  command.add_option("--seed", o.seed, "of everything that is drawn at random");
  add_name(command, "--preset", o.preset, "best (default), fast, paper, or paper-valid");
  command.add_option("--paths", o.paths, "focal points, 1 to 8");
  command.add_option("--budget-ms", o.budget_ms,
                     "time for a plan of preset best; 0: a fixed amount of work");
  add_name(command, "--method", o.method,
           "pro-stm (default): paths, or am: foci that stand still, modulated (docs/am.md)");
}

void add_array(CLI::App& command, CommonOptions& o, const std::string& help) {
  add_input_or_name(command, o.files, "--array", o.array, names_json, help);
}

CLI::Option* add_figure(CLI::App& command, CommonOptions& o, const std::string& help) {
  return add_output(command, o.files, "--figure", o.figure, prostm::check_figure, help);
}

/// How the file of a field is read. @param of the option that names the file, unless it is always
/// there.
void add_field_file(CLI::App& command, prostm::FieldFileOptions& o, CLI::Option* of = nullptr) {
  auto* cell = command.add_option("--cell-mm", o.cell_mm, "edge of a cell of a .npy or .png field");
  auto* width = command.add_option("--width-mm", o.width_mm,
                                   "instead: width of the whole .npy or .png field");
  width->excludes(cell);
  auto* invert = command.add_flag("--invert", o.invert, "the .png field is drawn black on white");
  auto* frame = command.add_option("--frame", o.frame, "frame of a .h5 recording");
  frame->capture_default_str();
  if (of == nullptr) return;
  for (CLI::Option* option : {cell, width, invert, frame}) option->needs(of);
}

void add_pipeline(CLI::App& command, CommonOptions& common, std::optional<std::string>& scene,
                  std::string& hand) {
  add_common(command, common);
  add_name(command, "--scene", scene,
           "one-plume (default), two-plumes, three-plumes, four-plumes, or still-air");
  add_input_or_name(
      command, common.files, "--hand", hand, names_recording,
      "a recording (.hands.jsonl, or Leap JSON), scripted, leap://HOST:PORT, openxr, or "
      "page (docs/hands.md)",
      hint_for_hand)
      ->capture_default_str();
  add_input_or_name(command, common.files, "--tracker", common.tracker, names_json,
                    "where the tracker is: centre (default), ultraleap-kit or another kit, or a "
                    "pose file (.json)");
  command.add_option("--grid", common.grid,
                     "cells along each edge of the fluid's box, a multiple of 16");
  add_array(command, common, "usx (default), autd3, or an array file (.json)");
}

/// The page of a run.
void add_view(CLI::App& command, RunOptionsGiven& o) {
  auto* view = command.add_flag("--view", o.view,
                                "serve the page that shows and steers the run (docs/viewing.md)");
  auto* stay = command.add_flag("--stay", o.stay, "go on after --seconds, until Ctrl-C");
  auto* port =
      command.add_option("--view-port", o.view_port,
                         "port of the page, 0 for any; default: 8470, or the next free one");
  auto* address =
      command
          .add_option("--view-address", o.view_address,
                      "address to serve the page on; default: 127.0.0.1, this machine alone")
          ->type_name("ADDRESS");
  auto* tracker_file =
      command
          .add_option("--tracker-file", o.tracker_file,
                      "where the page's calibration saves the tracker's pose, for --tracker")
          ->type_name("OUTPUT")
          ->default_str(kTrackerFile);
  for (CLI::Option* option : {stay, port, address, tracker_file}) option->needs(view);
}

void add_run(CLI::App& app, Work& work) {
  auto* command =
      app.add_subcommand("run", "a hand in smoke, felt through focal-point paths: the main job");
  auto o = std::make_shared<RunOptionsGiven>();
  add_pipeline(*command, o->common, o->scene, o->hand);
  add_name(*command, "--device", o->device,
           "what plays the paths: sim (default), see prostm devices");
  auto* figure = add_figure(*command, o->common, "a picture of one instant (.png or .svg)");
  command->add_option("--figure-at", o->figure_at, "its run time in seconds; default: the middle")
      ->needs(figure);
  command->add_option("--seconds", o->seconds,
                      "of run time; default: the recording's length, or 60");
  auto* realtime = command->add_flag_callback(
      "--realtime", [] {}, "keep the clock's time (default)");
  auto* fast = command->add_flag("--as-fast-as-possible", o->as_fast_as_possible,
                                 "no clock, nothing dropped");
  auto* stepped = command->add_flag("--stepped", o->stepped, "the same on one thread");
  realtime->excludes(fast)->excludes(stepped);
  fast->excludes(stepped);
  add_name(*command, "--switch", o->switch_at,
           "when a new plan takes over: lap (default), at the end of each path's lap, or "
           "now, at the next block");
  add_output(*command, o->common.files, "--record", o->record, prostm::check_recording,
             "record targets, hands and plans (.h5, docs/recordings.md)");
  add_view(*command, *o);
  command->footer(
      "Example:\n  prostm run --scene four-plumes --hand data/wave.hands.jsonl --json "
      "summary.json");
  command->callback([o, &work] {
    // only a page writes it; one that nobody named need not be writable until then
    if (o->view) {
      const auto check = o->tracker_file ? check_pose_output : nullptr;
      o->common.files.writes("--tracker-file", o->tracker_file.value_or(kTrackerFile), check,
                             "--tracker");
    }
    work = {&o->common.files, [o] { return run_command(*o); }};
  });
}

void add_plan(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("plan", "the paths, or foci, for one target field");
  auto o = std::make_shared<PlanOptionsGiven>();
  add_common(*command, o->common);
  add_input(*command, o->common.files, "field", o->field,
            "target field (.json, .npy, .png or .h5; docs/files.md)")
      ->required();
  add_field_file(*command, o->file);
  auto* figure =
      add_figure(*command, o->common,
                 "target, paths (or foci) and field; the six panels of the paper's Fig. 2 for its "
                 "presets (.png or .svg)");
  add_array(*command, o->common,
            "plan with the width that the focus of usx, autd3 or an array file has there");
  add_input(*command, o->common.files, "--beside", o->beside,
            "draw these digitised panels beside ours (JSON)")
      ->needs(figure);
  command->footer(
      "Example:\n  prostm plan data/palm.npy --cell-mm 5 --preset paper --figure palm.png --json "
      "palm.plan.json");
  command->callback([o, &work] { work = {&o->common.files, [o] { return plan_command(*o); }}; });
}

void add_capture(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("capture", "record the target fields of a scene");
  auto o = std::make_shared<CaptureOptionsGiven>();
  add_pipeline(*command, o->common, o->scene, o->hand);
  command->add_option("--frames", o->frames, "fields with pressure on them")->capture_default_str();
  add_output(*command, o->common.files, "--out", o->out, prostm::check_recording,
             "the recording (.h5)")
      ->required();
  command->footer("Example:\n  prostm capture --scene one-plume --frames 500 --out one-plume.h5");
  command->callback([o, &work] { work = {&o->common.files, [o] { return capture_command(*o); }}; });
}

void add_bench(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("bench", "the paper's Table I on recorded fields");
  auto o = std::make_shared<BenchOptionsGiven>();
  add_common(*command, o->common);
  add_input(*command, o->common.files, "files", o->files,
            "recordings (.h5) of prostm capture or prostm run --record")
      ->required();
  command->add_option("--repeats", o->repeats, "runs of each field, of which the median counts")
      ->capture_default_str();
  command->footer("Example:\n  prostm bench one-plume.h5 --json table1.json");
  command->callback([o, &work] { work = {&o->common.files, [o] { return bench_command(*o); }}; });
}

void add_solve(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("solve", "transducer drives for given focal points");
  auto o = std::make_shared<SolveOptionsGiven>();
  add_input(*command, o->files, "foci", o->foci, "focal points and their pressures (docs/files.md)")
      ->required();
  add_input_or_name(*command, o->files, "--array", o->array, names_json,
                    "usx, autd3, or an array file (.json)")
      ->capture_default_str();
  add_name(*command, "--solver", o->solver,
           "superposition, ibp, gs-pat, weighted, eigenvector or lm")
      ->capture_default_str();
  add_json(*command, o->files, o->json);
  command->footer(
      "Example:\n  prostm solve data/foci.json --array autd3 --solver lm --json drives.json");
  command->callback([o, &work] { work = {&o->files, [o] { return solve_command(*o); }}; });
}

void add_field(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("field", "what an array puts on the skin by a plan");
  auto o = std::make_shared<FieldOptionsGiven>();
  add_input(*command, o->common.files, "plan", o->plan, "a plan of prostm plan --json");
  command->add_flag("--widths", o->widths,
                    "instead: how wide a focus of the array is, by height, offset and tilt");
  auto* target =
      add_input(*command, o->common.files, "--field", o->target,
                "the field that was planned, to compare with (.json, .npy, .png or .h5)");
  add_field_file(*command, o->file, target);
  add_array(*command, o->common, "usx (default), autd3, or an array file (.json)");
  add_name(*command, "--solver", o->solver,
           "superposition, ibp, gs-pat, weighted, eigenvector or lm")
      ->capture_default_str();
  command->add_option("--full-scale-pa", o->full_scale_pa,
                      "acoustic pressure of intensity 1, rms; 0: the most that the array can hold "
                      "over the whole loop");
  command->add_flag("--memoryless", o->memoryless, "transducers that follow their drives at once");
  add_input(*command, o->common.files, "--settings", o->common.settings_file,
            "settings of any stage, a TOML file (docs/files.md)");
  add_figure(*command, o->common, "target, envelope, mean and difference (.png or .svg)");
  add_json(*command, o->common.files, o->common.json);
  command->footer(
      "Example:\n  prostm field palm.plan.json --field data/palm.npy --cell-mm 5 --array autd3 "
      "--figure "
      "palm.field.png");
  command->callback([o, &work] { work = {&o->common.files, [o] { return field_command(*o); }}; });
}

void add_devices(CLI::App& app, Work& work) {
  auto* command =
      app.add_subcommand("devices", "what can be driven from here, and why not, for each kind");
  auto o = std::make_shared<DevicesOptionsGiven>();
  add_json(*command, o->files, o->json);
  command->footer("Example:\n  prostm devices");
  command->callback([o, &work] { work = {&o->files, [o] { return devices_command(*o); }}; });
}

void add_settings(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "settings", "every setting of a settings file: its value, bounds and meaning");
  auto o = std::make_shared<SettingsOptionsGiven>();
  add_common(*command, o->common);
  add_name(*command, "name", o->name, "list these alone: a group, a key, or GROUP.KEY");
  command->add_flag("--toml", o->toml, "print a settings file to start from instead")
      ->excludes(command->get_option("--json"));
  command->footer("Example:\n  prostm settings plan\n  prostm settings --toml > my.toml");
  command->callback([o, &work] {
    work = {&o->common.files, [o] { return settings_command(*o); }};
  });
}

void add_help(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("help", "the help page of a command, as --help prints it");
  auto name = std::make_shared<std::string>();
  add_name(*command, "command", *name, "its name; default: all commands in short");
  command->footer("Example:\n  prostm help plan");
  command->callback([name, &app, &work] {
    work = {nullptr, [name, &app] {
              std::fputs(help_page(app, *name).c_str(), stdout);
              return 0;
            }};
  });
}

void add_check(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "check", "whether this machine keeps real time, and with which options; takes 20 s at most");
  auto o = std::make_shared<CheckOptionsGiven>();
  add_json(*command, o->files, o->json);
  command->footer("Example:\n  prostm check");
  command->callback([o, &work] { work = {&o->files, [o] { return check_command(*o); }}; });
}

/// Commands of the design that do not exist yet answer with a sentence, not with a usage error.
void add_unbuilt(CLI::App& app) {
  const std::map<std::string, std::string> commands = {
      {"stim", "the stimuli of earlier studies"},
      {"play", "play a plan, field or samples"},
      {"study", "the perceptual study"},
      {"report", "every table and figure of the paper"}};
  for (const auto& [name, help] : commands) {
    auto* command = app.add_subcommand(name, help + " (not built yet)");
    command->prefix_command();
    command->callback([name = name] {
      throw prostm::InputError("prostm " + name + " is not built yet in this version");
    });
  }
}

/// Parses and runs a command. @return the exit status.
int obey(int argc, char** argv) {
  CLI::App app(
      "prostm: touch in mid-air from pressure fields, by path routing optimisation for ultrasound");
  app.set_version_flag("--version", PROSTM_VERSION);
  app.require_subcommand(1);
  Work work;
  add_run(app, work);
  add_plan(app, work);
  add_capture(app, work);
  add_bench(app, work);
  add_solve(app, work);
  add_field(app, work);
  add_devices(app, work);
  add_settings(app, work);
  add_help(app, work);
  add_check(app, work);
  add_unbuilt(app);
  try {
    if (argc < 2) {
      std::fputs(help_page(app, "").c_str(), stderr);
      return kBadInput;
    }
    app.parse(argc, argv);
    if (work.files != nullptr) {
      work.files->check();
      // a reader of the words that goes must not cost the files
      if (work.files->any_output()) std::signal(SIGPIPE, SIG_IGN);
    }
    return work.run();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    std::fprintf(stderr, "prostm: %s\n", usage_sentence(app, error).c_str());
    return kBadInput;
  } catch (const std::system_error&) {
    // what could not be printed is told at the end
    return std::ferror(stdout) != 0 ? kBadInput : tell(std::current_exception());
  } catch (...) {
    return tell(std::current_exception());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int status = obey(argc, argv);
  try {
    flush(stdout);
  } catch (...) {
    const int unprinted = tell(std::current_exception());
    return status == 0 ? unprinted : status;
  }
  return status;
}
