/// The options of prostm field and capture.

#include "add_options.hpp"
#include "common.hpp"
#include "prostm/io/recorder.hpp"

namespace prostm::app {
namespace {

void add_field(Command app, Work& work) {
  auto command =
      app.add_command("field", "simulate a plan on an array: pressure on the skin and percept");
  auto o = std::make_shared<FieldOptionsGiven>();
  add_input(command, o->common.files, "plan", o->plan, "a plan of prostm plan --json");
  command.add_flag("--widths", o->widths,
                   "instead: print the width of the array's focus by height, offset and tilt");
  auto target =
      add_input(command, o->common.files, "--field", o->target,
                "the field that the plan was made for, to compare with (.json, .npy, .png or .h5)");
  add_field_file(command, o->file, target);
  add_array(command, o->common);
  add_name(command, "--solver", o->solver,
           "superposition, ibp, gs-pat, weighted, eigenvector or lm")
      .show_default();
  command.add_option("--full-scale-pa", o->full_scale_pa,
                     "acoustic pressure at intensity 1, rms; 0: the highest that the array can "
                     "sustain over the whole loop");
  command.add_flag("--memoryless", o->memoryless,
                   "ideal transducers that follow their drives at once");
  command.add_flag("--felt-spectrum", o->felt_spectrum,
                   "also print the percept of each harmonic of the loop");
  add_input(command, o->common.files, "--settings", o->common.settings_file,
            "settings of any stage, a TOML file (docs/reference/files.md)");
  add_figure(command, o->common,
             "target, radiation pressure, percept and difference (.png, .svg or .pdf)");
  add_json(command, o->common.files, o->common.json);
  command.footer(
      "Example:\n  prostm field palm.plan.json --field data/palm.npy --cell-mm 5 --array autd3 "
      "--figure "
      "palm.field.png");
  set_work(command, work, o->common.files, [o] { return field_command(*o); });
}

void add_capture(Command app, Work& work) {
  auto command = app.add_command("capture", "record the target fields of a scene");
  auto o = std::make_shared<CaptureOptionsGiven>();
  add_pipeline(command, o->common, o->scene, o->hand, o->hand_size);
  command.add_option("--frames", o->frames, "fields with pressure on them").show_default();
  add_output(command, o->common.files, "--out", o->out, check_recording, "the recording (.h5)")
      .required();
  command.footer("Example:\n  prostm capture --scene one-plume --frames 500 --out one-plume.h5");
  set_work(command, work, o->common.files, [o] { return capture_command(*o); });
}

}  // namespace

void add_field_commands(Command app, Work& work) {
  add_field(app, work);
  add_capture(app, work);
}

}  // namespace prostm::app
