/// The command line: parses, calls a command, and turns bad input into one sentence and exit
/// status 2.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <memory>
#include <stdexcept>

#include "core/input_error.hpp"
#include "options.hpp"

namespace {

using namespace prostm::app;

constexpr int kBadInput = 2;

void only(CLI::App& command, const std::string& option, const std::string& built,
          const std::string& unbuilt, const std::string& help) {
  command.add_option_function<std::string>(
      option,
      [=](const std::string& value) {
        if (value == built) return;
        throw prostm::InputError(
            option + " " + value + " is " +
            (unbuilt.find(value) != std::string::npos ? "not built yet" : "unknown") +
            "; this version has " + built);
      },
      help + " [" + built + "]");
}

void add_common(CLI::App& command, CommonOptions& o) {
  command.add_option("--settings", o.settings_file,
                     "settings of any stage, a TOML file (docs/files.md)");
  command.add_option("--json", o.json, "write the result as JSON; - is standard output");
  command.add_option("--seed", o.seed, "of everything that is drawn at random");
  command.add_option("--preset", o.preset, "best (default), fast, paper, or paper-valid");
  command.add_option("--paths", o.paths, "focal points, 1 to 8");
  command.add_option("--budget-ms", o.budget_ms,
                     "time for a plan of preset best; 0: a fixed amount of work");
  command.add_option(
      "--method", o.method,
      "pro-stm (default): paths, or am: foci that stand still, modulated (docs/am.md)");
}

void add_pipeline(CLI::App& command, CommonOptions& common, std::optional<std::string>& scene,
                  std::string& hand) {
  add_common(command, common);
  command.add_option("--scene", scene,
                     "one-plume (default), two-plumes, three-plumes, four-plumes, or still-air");
  command
      .add_option(
          "--hand", hand,
          "a recording (.hands.jsonl, or Leap JSON), scripted, leap://HOST:PORT, openxr, or "
          "page (docs/hands.md)")
      ->capture_default_str();
  command.add_option(
      "--tracker", common.tracker,
      "where the tracker is: centre (default), ultraleap-kit, or a pose file (.json)");
  command.add_option("--grid", common.grid,
                     "cells along each edge of the fluid's box, a multiple of 16");
  command.add_option("--array", common.array, "usx (default), autd3, or an array file (.json)");
}

void add_run(CLI::App& app, int& status) {
  auto* command =
      app.add_subcommand("run", "a hand in smoke, felt through focal-point paths: the main job");
  auto o = std::make_shared<RunOptionsGiven>();
  add_pipeline(*command, o->common, o->scene, o->hand);
  only(*command, "--device", "sim", "autd3 ultraleap stream", "what plays the paths");
  command->add_option("--figure", o->common.figure, "a picture of one instant (.png or .svg)");
  command->add_option("--figure-at", o->figure_at, "its run time in seconds; default: the middle");
  command->add_option("--seconds", o->seconds,
                      "of run time; default: the recording's length, or 60");
  auto* realtime = command->add_flag_callback(
      "--realtime", [] {}, "keep the clock's time (default)");
  auto* fast = command->add_flag("--as-fast-as-possible", o->as_fast_as_possible,
                                 "no clock, nothing dropped");
  auto* stepped = command->add_flag("--stepped", o->stepped, "the same on one thread");
  realtime->excludes(fast)->excludes(stepped);
  fast->excludes(stepped);
  command->add_option(
      "--switch", o->switch_at,
      "when a new plan takes over: lap (default), at the end of each path's lap, or "
      "now, at the next block");
  command->add_option("--record", o->record,
                      "record targets, hands and plans (.h5, docs/recordings.md)");
  command->add_flag("--view", o->view,
                    "serve the page that shows and steers the run (docs/viewing.md)");
  command->add_flag("--stay", o->stay, "go on after --seconds, until Ctrl-C; needs --view");
  command->add_option("--view-port", o->view_port,
                      "port of the page, 0 for any; default: 8470, or the next free one");
  command->add_option("--view-address", o->view_address,
                      "address to serve the page on; default: 127.0.0.1, this machine alone");
  command
      ->add_option("--tracker-file", o->tracker_file,
                   "where the page's calibration saves the tracker's pose, for --tracker")
      ->capture_default_str();
  command->footer(
      "Example:\n  prostm run --scene four-plumes --hand me.hands.jsonl --seconds 60 --json "
      "summary.json");
  command->callback([o, &status] { status = run_command(*o); });
}

void add_plan(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("plan", "the paths, or foci, for one target field");
  auto o = std::make_shared<PlanOptionsGiven>();
  add_common(*command, o->common);
  command->add_option("field", o->field, "target field: .json, .npy, .png or .h5 (docs/files.md)")
      ->required();
  command->add_option("--cell-mm", o->cell_mm, "edge of a cell of a .npy or .png field");
  command->add_option("--frame", o->frame, "frame of a .h5 recording")->capture_default_str();
  command->add_option(
      "--figure", o->common.figure,
      "target, paths (or foci) and field; the six panels of the paper's Fig. 2 for its "
      "presets (.png or .svg)");
  command->add_option(
      "--array", o->common.array,
      "plan with the width that the focus of usx, autd3 or an array file has there");
  command->add_option("--beside", o->beside, "draw these digitised panels beside ours (JSON)");
  command->footer(
      "Example:\n  prostm plan palm.npy --cell-mm 5 --preset paper --figure palm.png --json "
      "palm.plan.json");
  command->callback([o, &status] { status = plan_command(*o); });
}

void add_capture(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("capture", "record the target fields of a scene");
  auto o = std::make_shared<CaptureOptionsGiven>();
  add_pipeline(*command, o->common, o->scene, o->hand);
  command->add_option("--frames", o->frames, "fields with pressure on them")->capture_default_str();
  command->add_option("--out", o->out, "the recording (.h5)")->required();
  command->footer("Example:\n  prostm capture --scene one-plume --frames 500 --out one-plume.h5");
  command->callback([o, &status] { status = capture_command(*o); });
}

void add_bench(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("bench", "the paper's Table I on recorded fields");
  auto o = std::make_shared<BenchOptionsGiven>();
  add_common(*command, o->common);
  command->add_option("files", o->files, "recordings (.h5) of prostm capture or run --record")
      ->required();
  command->add_option("--repeats", o->repeats, "runs of each field, of which the median counts")
      ->capture_default_str();
  command->footer("Example:\n  prostm bench one-plume.h5 four-plumes.h5 --json table1.json");
  command->callback([o, &status] { status = bench_command(*o); });
}

void add_solve(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("solve", "transducer drives for given focal points");
  auto o = std::make_shared<SolveOptionsGiven>();
  command->add_option("foci", o->foci, "focal points and their pressures (docs/files.md)")
      ->required();
  command->add_option("--array", o->array, "usx, autd3, or an array file (.json)")
      ->capture_default_str();
  command
      ->add_option("--solver", o->solver, "superposition, ibp, gs-pat, weighted, eigenvector or lm")
      ->capture_default_str();
  command->add_option("--json", o->json, "write the drives as JSON; - is standard output");
  command->footer(
      "Example:\n  prostm solve foci.json --array autd3 --solver lm --json drives.json");
  command->callback([o, &status] { status = solve_command(*o); });
}

void add_field(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("field", "what an array puts on the skin by a plan");
  auto o = std::make_shared<FieldOptionsGiven>();
  command->add_option("plan", o->plan, "a plan of prostm plan --json");
  command->add_flag("--widths", o->widths,
                    "instead: how wide a focus of the array is, by height, offset and tilt");
  command->add_option("--field", o->target,
                      "the field that was planned, to compare with (.json, .npy, .png or .h5)");
  command->add_option("--cell-mm", o->cell_mm, "edge of a cell of a .npy or .png field");
  command->add_option("--frame", o->frame, "frame of a .h5 recording")->capture_default_str();
  command->add_option("--array", o->common.array, "usx (default), autd3, or an array file (.json)");
  command
      ->add_option("--solver", o->solver, "superposition, ibp, gs-pat, weighted, eigenvector or lm")
      ->capture_default_str();
  command->add_option("--full-scale-pa", o->full_scale_pa,
                      "acoustic pressure of intensity 1, rms; 0: the most that the array can hold "
                      "over the whole loop");
  command->add_flag("--memoryless", o->memoryless, "transducers that follow their drives at once");
  command->add_option("--settings", o->common.settings_file,
                      "settings of any stage, a TOML file (docs/files.md)");
  command->add_option("--figure", o->common.figure,
                      "target, envelope, mean and difference (.png or .svg)");
  command->add_option("--json", o->common.json, "write the result as JSON; - is standard output");
  command->footer(
      "Example:\n  prostm field palm.plan.json --field palm.npy --cell-mm 5 --array autd3 --figure "
      "palm.field.png");
  command->callback([o, &status] { status = field_command(*o); });
}

void add_devices(CLI::App& app, int& status) {
  auto* command =
      app.add_subcommand("devices", "what can be driven from here, and why not, for each kind");
  auto json = std::make_shared<std::string>();
  command->add_option("--json", *json, "write the result as JSON; - is standard output");
  command->footer("Example:\n  prostm devices");
  command->callback([json, &status] { status = devices_command(*json); });
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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "prostm: touch in mid-air from pressure fields, by path routing optimisation for ultrasound");
  app.set_version_flag("--version", PROSTM_VERSION);
  app.require_subcommand(1);
  int status = 0;
  add_run(app, status);
  add_plan(app, status);
  add_capture(app, status);
  add_bench(app, status);
  add_solve(app, status);
  add_field(app, status);
  add_devices(app, status);
  add_unbuilt(app);
  try {
    app.parse(argc, argv);
    return status;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    std::fprintf(stderr, "prostm: %s; see prostm --help\n", error.what());
    return kBadInput;
  } catch (const prostm::InputError& error) {
    std::fprintf(stderr, "prostm: %s\n", error.what());
    return kBadInput;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "prostm: %s\n", error.what());
    return kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "prostm: unexpected: %s\n", error.what());
    return 1;
  }
}
