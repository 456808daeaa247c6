/// The options of prostm report.

#include "add_options.hpp"
#include "common.hpp"

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
  command.add_flag("--quick", o->quick, "fewer fields, hands and speeds: a minute");
  command.add_flag("--fresh", o->fresh, "make existing parts again");
  command.footer("Example:\n  prostm report --quick --out report");
  set_work(command, work, o->files, [o] { return report_command(*o); });
}

}  // namespace

void add_report_commands(Command app, Work& work) {
  add_report(app, work);
}

}  // namespace prostm::app
