/// The options of prostm run, soak and check.

#include "add_options.hpp"
#include "common.hpp"
#include "prostm/core/input_error.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm::app {
namespace {

/// Adds the options of a run's page.
void add_view(Command command, RunOptionsGiven& o) {
  auto view =
      command.add_flag("--view", o.view,
                       "serve a web page that shows and controls the run (docs/guides/viewing.md)");
  auto stay = command.add_flag("--stay", o.stay, "continue after --seconds, until Ctrl-C");
  const auto [port, address, host] = add_address(command, o);
  auto tracker_file =
      command
          .add_option("--tracker-file", o.tracker_file,
                      "where the page's calibration saves the tracker's pose, for --tracker")
          .type_name("OUTPUT")
          .show_default(kTrackerFile);
  for (Option option : {stay, port, address, host, tracker_file}) option.needs(view);
}

/// Only a page writes the tracker's pose, so its default file need not be writable before that.
void expect_tracker_file(RunOptionsGiven& o) {
  if (!o.view) return;
  const auto check = o.tracker_file ? check_pose_output : nullptr;
  o.common.files.writes("--tracker-file", o.tracker_file.value_or(kTrackerFile), check,
                        "--tracker");
}

void add_run(Command app, Work& work) {
  auto command = app.add_command(
      "run", "simulate smoke on a hand (tracked, recorded or scripted) and render it, live");
  auto o = std::make_shared<RunOptionsGiven>();
  add_pipeline(command, o->common, o->scene, o->hand, o->hand_size);
  add_device(command, o->common);
  auto figure = add_figure(command, o->common, "a picture of one instant (.png, .svg or .pdf)");
  command
      .add_option("--figure-at", o->figure_at,
                  "run time of the picture, in seconds; default: half-way")
      .needs(figure);
  command.add_option("--seconds", o->seconds,
                     "duration of the run; default: the recording's length, or 60");
  auto realtime = command.add_default_flag("--realtime", "keep the clock's time (default)");
  auto fast = command.add_flag("--as-fast-as-possible", o->as_fast_as_possible,
                               "run without a clock, dropping nothing");
  auto stepped = command.add_flag("--stepped", o->stepped, "the same on one thread");
  realtime.excludes(fast, stepped);
  fast.excludes(stepped);
  add_name(command, "--switch", o->switch_at,
           "when a new plan takes over: lap (default), at the end of each path's lap, or "
           "now, at the next block");
  add_output(command, o->common.files, "--record", o->record, check_recording,
             "record targets, hands and plans (.h5, docs/guides/recordings.md)");
  add_lock_memory(command, o->lock_memory);
  add_view(command, *o);
  command.footer(
      "Example:\n  prostm run --scene four-plumes --hand data/wave.hands.jsonl --json "
      "summary.json");
  command.callback([o, &work] {
    expect_tracker_file(*o);
    work = {&o->common.files, [o] { return run_command(*o); }};
  });
}

void add_soak(Command app, Work& work) {
  auto command = app.add_command(
      "soak", "endurance test: a long run that reports each dip with its time and cause");
  auto o = std::make_shared<SoakOptionsGiven>();
  RunOptionsGiven& run = o->run;
  add_pipeline(command, run.common, run.scene, run.hand, run.hand_size);
  add_device(command, run.common);
  command.add_option("--minutes", o->minutes, "duration, 0.05 to 1440").show_default();
  command.add_flag("--load", o->load,
                   "load all cores with another process during the middle third");
  add_lock_memory(command, run.lock_memory);
  add_view(command, run);
  command.footer("Example:\n  prostm soak --minutes 0.1 --json soak.json");
  command.callback([o, &work] {
    if (o->run.stay) throw InputError("--stay belongs to prostm run: a soak ends after --minutes");
    expect_tracker_file(o->run);
    work = {&o->run.common.files, [o] { return soak_command(*o); }};
  });
}

void add_check(Command app, Work& work) {
  auto command = app.add_command(
      "check", "whether this machine keeps real time, and with which options; takes 20 s at most");
  auto o = std::make_shared<CheckOptionsGiven>();
  add_name(command, "--scene", o->scene, "scene to check for; default: all that have a stimulus");
  add_json(command, o->files, o->json);
  command.footer("Example:\n  prostm check");
  set_work(command, work, o->files, [o] { return check_command(*o); });
}

}  // namespace

void add_run_commands(Command app, Work& work) {
  add_run(app, work);
  add_soak(app, work);
  add_check(app, work);
}

}  // namespace prostm::app
