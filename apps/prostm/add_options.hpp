#pragma once
/// Options of the command line that several commands have.

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "command_line.hpp"
#include "options.hpp"

namespace prostm::app {

/// The work of a command, which begins once all options are parsed and files are checked.
struct Work {
  const Files* files = nullptr;  ///< null: none
  std::function<int()> run;
};

/// Sets what runs once the command's options are parsed. @param files kept alive by `run`.
void set_work(Command command, Work& work, const Files& files, std::function<int()> run);

/// An option, or a positional, whose value is a file that the command reads.
Option add_input(Command command, Files& files, const std::string& name, OptionValue value,
                 const std::string& help);
/// The same, where some values are built-in names. @param hint returns which of them was probably
/// meant by a file that does not exist.
Option add_input_or_name(Command command, Files& files, const std::string& name, OptionValue value,
                         bool (*is_file)(const std::string&), const std::string& help,
                         std::string (*hint)(const std::string&) = nullptr);
/// An option whose value is a file that the command writes.
Option add_output(Command command, Files& files, const std::string& name, OptionValue value,
                  Files::Check check, const std::string& help);
/// An option that takes one of a few words.
Option add_name(Command command, const std::string& name, OptionValue value,
                const std::string& help);

void add_json(Command command, Files& files, std::string& json);
/// Settings, JSON, seed, and the options of planning.
void add_common(Command command, CommonOptions& o);
void add_array(Command command, CommonOptions& o,
               const std::string& help = prostm::array_choices(" (default)"));
/// --device, with the forms of device names.
void add_device(Command command, CommonOptions& o);
void add_lock_memory(Command command, bool& lock_memory);
Option add_figure(Command command, CommonOptions& o, const std::string& help);
/// Options for reading a field's file. @param of the option that names the file, or nothing if
/// the file is always given.
void add_field_file(Command command, prostm::FieldFileOptions& o, std::optional<Option> of = {});
/// Port, address and names of the pages. @return the three options.
std::array<Option, 3> add_address(Command command, RunOptionsGiven& o);
/// --hand, --hand-size and --tracker.
void add_hand(Command command, CommonOptions& common, std::string& hand,
              std::optional<double>& hand_size);
/// The options of add_common(), and those that make up a run.
void add_pipeline(Command command, CommonOptions& common, std::optional<std::string>& scene,
                  std::string& hand, std::optional<double>& hand_size);

/// A planned command that does not exist yet: answers with a sentence, not with a usage error.
void add_unbuilt(Command app, const std::string& name, const std::string& help);

// The commands of each group of the help page, with their options; a group has a folder of its own.
void add_run_commands(Command app, Work& work);
void add_plan_commands(Command app, Work& work);
void add_field_commands(Command app, Work& work);
void add_study(Command app, Work& work);
void add_devices_commands(Command app, Work& work);
void add_report_commands(Command app, Work& work);
void add_bench_commands(Command app, Work& work);

}  // namespace prostm::app
