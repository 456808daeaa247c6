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
#include "usage.hpp"

namespace {

using namespace prostm::app;

void add_settings(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "settings", "list the settings of a settings file, with defaults, bounds and meanings");
  auto o = std::make_shared<SettingsOptionsGiven>();
  add_common(*command, o->common);
  add_name(*command, "name", o->name, "list only these: a group, a key, or GROUP.KEY");
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
  add_name(*command, "command", *name, "its name; default: an overview of all commands");
  command->footer("Example:\n  prostm help plan");
  command->callback([name, &app, &work] {
    work = {nullptr, [name, &app] {
              std::fputs(help_page(app, *name).c_str(), stdout);
              return 0;
            }};
  });
}

void add_general_commands(CLI::App& app, Work& work) {
  add_settings(app, work);
  add_help(app, work);
  add_unbuilt(app, "stim", "the stimuli of earlier studies");
  add_unbuilt(app, "play", "play a plan, field or samples");
}

/// A heading of the help page, with its commands.
struct CommandGroup {
  const char* title;
  void (*add)(CLI::App& app, Work& work);
};

constexpr CommandGroup kGroups[] = {
    {"Run", add_run_commands},         {"Plan", add_plan_commands},
    {"Field", add_field_commands},     {"Study", add_study},
    {"Devices", add_devices_commands}, {"Report", add_report_commands},
    {"Bench", add_bench_commands},     {"General", add_general_commands}};

void add_commands(CLI::App& app, Work& work) {
  for (const CommandGroup& group : kGroups) {
    const std::size_t before = app.get_subcommands({}).size();
    group.add(app, work);
    const std::vector<CLI::App*> commands = app.get_subcommands({});
    for (std::size_t i = before; i < commands.size(); ++i) commands[i]->group(group.title);
  }
}

/// Makes the parser read whole numbers with leading zeros as decimal: 010 is ten. It would read
/// them as octal, so that participant 010 would be participant 8.
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
  add_commands(app, work);
  read_whole_numbers_as_decimal(app);
  try {
    if (argc < 2) {
      std::fputs(help_page(app, "").c_str(), stderr);
      return kBadInput;
    }
    app.parse(argc, argv);
    if (work.files != nullptr) {
      work.files->check();
      // the files must be written even if the reader of standard output goes away
      if (work.files->any_output()) std::signal(SIGPIPE, SIG_IGN);
    }
    return work.run();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    std::fprintf(stderr, "prostm: %s\n", usage_sentence(app, error).c_str());
    return kBadInput;
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
