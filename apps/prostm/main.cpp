/// The command line: parses, calls a command, and turns bad input into one sentence and exit
/// status 2.

#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "add_options.hpp"
#include "command_line.hpp"
#include "common.hpp"
#include "options.hpp"
#include "prostm/commit.hpp"
#include "prostm/core/file/advisory_lock.hpp"

namespace {

using namespace prostm::app;

void add_settings(Command app, Work& work) {
  auto command = app.add_command(
      "settings", "list the settings of a settings file, with defaults, bounds and meanings");
  auto o = std::make_shared<SettingsOptionsGiven>();
  add_common(command, o->common);
  add_name(command, "name", o->name, "list only these: a group, a key, or GROUP.KEY");
  command.add_flag("--toml", o->toml, "print a settings file to start from instead")
      .excludes(command.option("--json"));
  command.footer("Example:\n  prostm settings plan\n  prostm settings --toml > my.toml");
  set_work(command, work, o->common.files, [o] { return settings_command(*o); });
}

void add_help(Command app, Work& work) {
  auto command = app.add_command("help", "the help page of a command, as --help prints it");
  auto name = std::make_shared<std::string>();
  add_name(command, "command", *name, "its name; default: an overview of all commands");
  command.footer("Example:\n  prostm help plan");
  command.callback([name, app, &work] {
    work = {nullptr, [name, app] {
              std::fputs(app.help_page(*name).c_str(), stdout);
              return 0;
            }};
  });
}

void add_general_commands(Command app, Work& work) {
  add_settings(app, work);
  add_help(app, work);
  add_unbuilt(app, "stim", "the stimuli of earlier studies");
  add_unbuilt(app, "play", "play a plan, field or samples");
}

/// A heading of the help page, with its commands.
struct CommandGroup {
  const char* title;
  void (*add)(Command app, Work& work);
};

constexpr CommandGroup kGroups[] = {
    {"Run", add_run_commands},         {"Plan", add_plan_commands},
    {"Field", add_field_commands},     {"Study", add_study},
    {"Devices", add_devices_commands}, {"Report", add_report_commands},
    {"Bench", add_bench_commands},     {"General", add_general_commands}};

void add_commands(Command app, Work& work) {
  for (const CommandGroup& group : kGroups) {
    const std::size_t before = app.commands().size();
    group.add(app, work);
    const std::vector<Command> commands = app.commands();
    for (std::size_t i = before; i < commands.size(); ++i) commands[i].group(group.title);
  }
}

/// Parses and runs a command. @return the exit status.
int obey(int argc, char** argv) {
  prostm::set_lock_warning(warn);
  const CommandLine line(
      "prostm: touch in mid-air from pressure fields, by path routing optimisation for ultrasound",
      prostm::version_text());
  Work work;
  add_commands(line.program(), work);
  try {
    if (argc < 2) {
      std::fputs(line.program().help_page("").c_str(), stderr);
      return kBadInput;
    }
    if (!line.parse(argc, argv)) return 0;
    if (work.files != nullptr) {
      work.files->check();
      // the files must be written even if the reader of standard output goes away
      if (work.files->any_output()) std::signal(SIGPIPE, SIG_IGN);
    }
    return work.run();
  } catch (const std::system_error&) {
    // a failure to print is reported by the exit status
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
