/// The options of prostm report.

#include "add_options.hpp"
#include "common.hpp"
#include "prostm/figure/figures.hpp"

namespace prostm::app {
namespace {

void add_report(Command app, Work& work) {
  auto command = app.add_command(
      "report", "every table and figure of the paper, computed here: one page; takes ten minutes");
  auto o = std::make_shared<ReportOptionsGiven>();
  command
      .add_option(
          "--out", o->out,
          "folder for index.html, report.json and report.pdf; a report that was interrupted "
          "is resumed there")
      .type_name("FOLDER")
      .required();
  command
      .add_option("--paper-data", o->paper_data,
                  "folder with the paper's figures as data, fig2.field.json, fig2.json and "
                  "fig4.json; default: " +
                      std::string(kPaperData) + ", if it is there")
      .type_name("FOLDER");
  command.add_option("--seed", o->seed, "random seed").show_default();
  command.add_flag("--quick", o->quick, "fewer fields, hands, targets and speeds: one minute");
  command.add_flag("--fresh", o->fresh, "make existing parts again");
  command.footer("Example:\n  prostm report --quick --out report");
  set_work(command, work, o->files, [o] { return report_command(*o); });
}

void add_experiments(Command app, Work& work) {
  auto command = app.add_command(
      "experiments",
      "published experiments with people, and what models of touch predict for them");
  auto o = std::make_shared<ExperimentsOptionsGiven>();
  const Option names =
      command.add_option("names", o->names, "experiments by name; default: all").type_name("NAME");
  const Option set =
      add_name(command, "--set", o->set, "only the experiments of this set: fit or held-out");
  add_name(command, "--model", o->model, "only this percept model; default: all");
  add_name(command, "--readout", o->readout, "only this readout: template or category");
  const Option fit =
      add_output(command, o->files, "--fit", o->fit, check_json_output,
                 "fit the observers to the experiments of the set fit, and write their parameters")
          .excludes(names, set);
  const Option without =
      command
          .add_flag("--leave-one-out", o->leave_one_out,
                    "fit without each paper of the set fit in turn, and print what moves")
          .excludes(names, set, fit);
  const Option variations =
      command
          .add_flag("--variations", o->variations,
                    "simulate the paper's study in variations that could explain its result; takes "
                    "up to an hour")
          .excludes(names, set, fit, without);
  add_json(command, o->files, o->json);
  command.option("--json").excludes(fit);
  add_output(command, o->files, "--figure", o->figure, check_figure,
             "draw published and predicted numbers, a chart for each experiment")
      .excludes(fit, without, variations);
  command.footer("Example:\n  prostm experiments howard-2023 --model peak");
  set_work(command, work, o->files, [o] { return experiments_command(*o); });
}

}  // namespace

void add_report_commands(Command app, Work& work) {
  add_experiments(app, work);
  add_report(app, work);
}

}  // namespace prostm::app
