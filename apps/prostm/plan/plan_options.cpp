/// The options of prostm plan and solve.

#include "add_options.hpp"
#include "common.hpp"

namespace prostm::app {
namespace {

void add_plan(Command app, Work& work) {
  auto command = app.add_command("plan", "the paths, or foci, for one target field");
  auto o = std::make_shared<PlanOptionsGiven>();
  add_common(command, o->common);
  add_input(command, o->common.files, "field", o->field,
            "target field (.json, .npy, .npz, .png or .h5, or - for standard input; "
            "docs/reference/files.md)")
      .required();
  add_field_file(command, o->file);
  auto figure =
      add_figure(command, o->common,
                 "target, paths (or foci) and field; the six panels of the paper's Fig. 2 for its "
                 "presets (.png, .svg or .pdf)");
  add_array(command, o->common, "plan with the focus width of an array: " + array_choices());
  add_input(command, o->common.files, "--beside", o->beside,
            "draw these digitised panels beside ours (JSON)")
      .needs(figure);
  command.footer(
      "Example:\n  prostm plan data/palm.npy --cell-mm 5 --preset paper --figure palm.png --json "
      "palm.plan.json");
  set_work(command, work, o->common.files, [o] { return plan_command(*o); });
}

void add_solve(Command app, Work& work) {
  auto command = app.add_command("solve", "transducer drives for given focal points");
  auto o = std::make_shared<SolveOptionsGiven>();
  add_input(command, o->files, "foci", o->foci,
            "focal points and their pressures (docs/reference/files.md)")
      .required();
  add_input_or_name(command, o->files, "--array", o->array, names_json, array_choices())
      .show_default();
  add_name(command, "--solver", o->solver,
           "superposition, ibp, gs-pat, weighted, eigenvector or lm")
      .show_default();
  add_json(command, o->files, o->json);
  command.footer(
      "Example:\n  prostm solve data/foci.json --array autd3 --solver lm --json drives.json");
  set_work(command, work, o->files, [o] { return solve_command(*o); });
}

}  // namespace

void add_plan_commands(Command app, Work& work) {
  add_plan(app, work);
  add_solve(app, work);
}

}  // namespace prostm::app
