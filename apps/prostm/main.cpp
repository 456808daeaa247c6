/// The command line: parses, calls a command, and turns bad input into one sentence and exit
/// status 2.

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <system_error>

#include "add_options.hpp"
#include "common.hpp"
#include "options.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/file/advisory_lock.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/figure/figures.hpp"
#include "prostm/io/recorder.hpp"
#include "usage.hpp"

namespace {

using namespace prostm::app;

/// The page of a run.
void add_view(CLI::App& command, RunOptionsGiven& o) {
  auto* view = command.add_flag("--view", o.view,
                                "serve the page that shows and steers the run (docs/viewing.md)");
  auto* stay = command.add_flag("--stay", o.stay, "go on after --seconds, until Ctrl-C");
  const auto [port, address] = add_address(command, o);
  auto* tracker_file =
      command
          .add_option("--tracker-file", o.tracker_file,
                      "where the page's calibration saves the tracker's pose, for --tracker")
          ->type_name("OUTPUT")
          ->default_str(kTrackerFile);
  for (CLI::Option* option : {stay, port, address, tracker_file}) option->needs(view);
}

/// Only a page writes the tracker's pose; a file that nobody named need not be writable until then.
void expect_tracker_file(RunOptionsGiven& o) {
  if (!o.view) return;
  const auto check = o.tracker_file ? check_pose_output : nullptr;
  o.common.files.writes("--tracker-file", o.tracker_file.value_or(kTrackerFile), check,
                        "--tracker");
}

void add_run(CLI::App& app, Work& work) {
  auto* command =
      app.add_subcommand("run", "a hand in smoke, felt through focal-point paths: the main job");
  auto o = std::make_shared<RunOptionsGiven>();
  add_pipeline(*command, o->common, o->scene, o->hand, o->hand_size);
  add_device(*command, o->common);
  auto* figure = add_figure(*command, o->common, "a picture of one instant (.png, .svg or .pdf)");
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
  add_lock_memory(*command, o->lock_memory);
  add_view(*command, *o);
  command->footer(
      "Example:\n  prostm run --scene four-plumes --hand data/wave.hands.jsonl --json "
      "summary.json");
  command->callback([o, &work] {
    expect_tracker_file(*o);
    work = {&o->common.files, [o] { return run_command(*o); }};
  });
}

void add_plan(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("plan", "the paths, or foci, for one target field");
  auto o = std::make_shared<PlanOptionsGiven>();
  add_common(*command, o->common);
  add_input(*command, o->common.files, "field", o->field,
            "target field (.json, .npy, .npz, .png or .h5, or - for standard input; docs/files.md)")
      ->required();
  add_field_file(*command, o->file);
  auto* figure =
      add_figure(*command, o->common,
                 "target, paths (or foci) and field; the six panels of the paper's Fig. 2 for its "
                 "presets (.png, .svg or .pdf)");
  add_array(*command, o->common,
            "plan with the width that the focus of an array has there: " + prostm::array_choices());
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
  add_pipeline(*command, o->common, o->scene, o->hand, o->hand_size);
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
  add_input_or_name(*command, o->files, "--array", o->array, names_json, prostm::array_choices())
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
  add_array(*command, o->common);
  add_name(*command, "--solver", o->solver,
           "superposition, ibp, gs-pat, weighted, eigenvector or lm")
      ->capture_default_str();
  command->add_option("--full-scale-pa", o->full_scale_pa,
                      "acoustic pressure of intensity 1, rms; 0: the most that the array can hold "
                      "over the whole loop");
  command->add_flag("--memoryless", o->memoryless, "transducers that follow their drives at once");
  command->add_flag("--felt-spectrum", o->felt_spectrum,
                    "also tell what is felt harmonic by harmonic of the loop");
  add_input(*command, o->common.files, "--settings", o->common.settings_file,
            "settings of any stage, a TOML file (docs/files.md)");
  add_figure(*command, o->common, "target, envelope, mean and difference (.png, .svg or .pdf)");
  add_json(*command, o->common.files, o->common.json);
  command->footer(
      "Example:\n  prostm field palm.plan.json --field data/palm.npy --cell-mm 5 --array autd3 "
      "--figure "
      "palm.field.png");
  command->callback([o, &work] { work = {&o->common.files, [o] { return field_command(*o); }}; });
}

void add_levels(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "levels",
      "how loud an array can be, at focal points and at the head, beside caps and limits");
  auto o = std::make_shared<LevelsOptionsGiven>();
  add_array(*command, o->common);
  add_input(*command, o->common.files, "--settings", o->common.settings_file,
            "settings, of which [safety] has the caps (docs/safety.md)");
  add_json(*command, o->common.files, o->common.json);
  command->footer("Example:\n  prostm levels --array autd3");
  command->callback([o, &work] { work = {&o->common.files, [o] { return levels_command(*o); }}; });
}

void add_devices(CLI::App& app, Work& work) {
  auto* command =
      app.add_subcommand("devices", "what can be driven from here, what is found, what is missing");
  auto o = std::make_shared<DevicesOptionsGiven>();
  add_name(*command, "names", o->names,
           "look at these alone, also on other machines: a device with its address, "
           "leap://HOST:PORT, or openxr; default: all that this machine has");
  add_json(*command, o->files, o->json);
  command->add_flag("--budget", o->budget, "what a link to AUTD3 carries: a table, nothing else");
  command->footer("Example:\n  prostm devices");
  command->callback([o, &work] { work = {&o->files, [o] { return devices_command(*o); }}; });
}

void add_selftest(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "selftest", "what is connected, and whether a hand can feel it: asks before it plays");
  auto o = std::make_shared<SelftestOptionsGiven>();
  add_input(*command, o->common.files, "--settings", o->common.settings_file,
            "settings of any stage, a TOML file (docs/files.md)");
  add_json(*command, o->common.files, o->common.json);
  add_device(*command, o->common);
  add_array(*command, o->common,
            prostm::array_choices() + "; default: the device's, or " +
                prostm::array_kinds().front().name);
  add_figure(*command, o->common, "a picture of the array, seen from above (.png, .svg or .pdf)");
  command->add_option("--seconds", o->seconds, "of each figure, 0.2 to 60")->capture_default_str();
  command->add_option("--height-mm", o->height_mm, "of the figures over the array, 50 to 500")
      ->capture_default_str();
  command->add_option("--level", o->level, "largest intensity, 0.05 to 1")->capture_default_str();
  auto* yes = command->add_flag("--yes", o->yes, "play without being asked");
  command->add_flag("--silent", o->silent, "connect, and play nothing")->excludes(yes);
  command->footer("Example:\n  prostm selftest --silent --figure array.png");
  command->callback([o, &work] {
    work = {&o->common.files, [o] { return selftest_command(*o); }};
  });
}

void add_soak(CLI::App& app, Work& work) {
  auto* command =
      app.add_subcommand("soak", "a long run that counts every dip, and says when it was and why");
  auto o = std::make_shared<SoakOptionsGiven>();
  RunOptionsGiven& run = o->run;
  add_pipeline(*command, run.common, run.scene, run.hand, run.hand_size);
  add_device(*command, run.common);
  command->add_option("--minutes", o->minutes, "how long, 0.05 to 1440")->capture_default_str();
  command->add_flag("--load", o->load,
                    "during the middle third, let another process use all cores");
  add_lock_memory(*command, run.lock_memory);
  add_view(*command, run);
  command->footer("Example:\n  prostm soak --minutes 0.1 --json soak.json");
  command->callback([o, &work] {
    if (o->run.stay) throw prostm::InputError("--stay belongs to prostm run: a soak has an end");
    expect_tracker_file(o->run);
    work = {&o->run.common.files, [o] { return soak_command(*o); }};
  });
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
  add_name(*command, "--scene", o->scene, "scene to check for; default: all that have a stimulus");
  add_json(*command, o->files, o->json);
  command->footer("Example:\n  prostm check");
  command->callback([o, &work] { work = {&o->files, [o] { return check_command(*o); }}; });
}

void add_report(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "report", "every table and figure of the paper, computed here: one page; takes ten minutes");
  auto o = std::make_shared<ReportOptionsGiven>();
  command
      ->add_option("--out", o->out,
                   "folder for index.html, report.json and report.pdf; a report that was cut short "
                   "goes on there")
      ->type_name("FOLDER")
      ->required();
  command
      ->add_option("--paper-data", o->paper_data,
                   "folder with the paper's figures as data, fig2.field.json, fig2.json and "
                   "fig4.json; default: " +
                       std::string(kPaperData) + ", if it is there")
      ->type_name("FOLDER");
  command->add_option("--seed", o->seed, "of all that is random")->capture_default_str();
  command->add_flag("--quick", o->quick, "fewer fields, hands and speeds: a minute");
  command->add_flag("--fresh", o->fresh, "make parts anew that are there");
  command->footer("Example:\n  prostm report --quick --out report");
  command->callback([o, &work] { work = {&o->files, [o] { return report_command(*o); }}; });
}

/// Has whole numbers with leading zeros read as decimal: 010 is ten. The parser would read it as
/// octal, so that participant 010 were participant 8.
void read_whole_numbers_as_decimal(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_type_name() != "INT" && option->get_type_name() != "UINT") continue;
    option->transform([](std::string text) {
      const std::size_t sign = text.find_first_of("+-") == 0 ? 1 : 0;
      const bool is_decimal = text.find_first_not_of("0123456789", sign) == std::string::npos;
      while (is_decimal && text.size() > sign + 1 && text[sign] == '0') text.erase(sign, 1);
      return text;
    });
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
    read_whole_numbers_as_decimal(*command);
}

/// Parses and runs a command. @return the exit status.
int obey(int argc, char** argv) {
  prostm::set_lock_warning(warn);
  CLI::App app(
      "prostm: touch in mid-air from pressure fields, by path routing optimisation for ultrasound");
  app.set_version_flag("--version", prostm::version_text());
  app.require_subcommand(1);
  Work work;
  add_run(app, work);
  add_plan(app, work);
  add_capture(app, work);
  add_bench(app, work);
  add_solve(app, work);
  add_field(app, work);
  add_levels(app, work);
  add_devices(app, work);
  add_selftest(app, work);
  add_soak(app, work);
  add_settings(app, work);
  add_help(app, work);
  add_check(app, work);
  add_study(app, work);
  add_report(app, work);
  add_unbuilt(app, "stim", "the stimuli of earlier studies");
  add_unbuilt(app, "play", "play a plan, field or samples");
  read_whole_numbers_as_decimal(app);
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
