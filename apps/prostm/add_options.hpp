#pragma once
/// Options of the command line that several commands have.

#include <CLI/CLI.hpp>
#include <array>
#include <functional>
#include <optional>
#include <string>

#include "options.hpp"

namespace prostm::app {

/// The work of a command, which begins once all options are parsed and files are checked.
struct Work {
  const Files* files = nullptr;  ///< null: none
  std::function<int()> run;
};

/// An option, or a positional, whose value is a file that the command reads.
template <class Value>
CLI::Option* add_input(CLI::App& command, Files& files, const std::string& name, Value& value,
                       const std::string& help) {
  return command.add_option(name, value, help)
      ->type_name("INPUT")
      ->each([&files, name](const std::string& path) { files.reads(name, path); });
}

/// The same, where some values are built-in names. @param hint returns which of them was probably
/// meant by a file that does not exist.
template <class Value>
CLI::Option* add_input_or_name(CLI::App& command, Files& files, const std::string& name,
                               Value& value, bool (*is_file)(const std::string&),
                               const std::string& help,
                               std::string (*hint)(const std::string&) = nullptr) {
  return command.add_option(name, value, help)
      ->type_name("NAME|INPUT")
      ->each([&files, name, is_file, hint](const std::string& path) {
        if (is_file(path)) files.reads(name, path, hint != nullptr ? hint(path) : std::string());
      });
}

/// An option whose value is a file that the command writes.
template <class Value>
CLI::Option* add_output(CLI::App& command, Files& files, const std::string& name, Value& value,
                        Files::Check check, const std::string& help) {
  return command.add_option(name, value, help)
      ->type_name("OUTPUT")
      ->each([&files, name, check](const std::string& path) { files.writes(name, path, check); });
}

/// An option that takes one of a few words.
template <class Value>
CLI::Option* add_name(CLI::App& command, const std::string& name, Value& value,
                      const std::string& help) {
  return command.add_option(name, value, help)->type_name("NAME");
}

void add_json(CLI::App& command, Files& files, std::string& json);
/// Settings, JSON, seed, and the options of planning.
void add_common(CLI::App& command, CommonOptions& o);
void add_array(CLI::App& command, CommonOptions& o,
               const std::string& help = prostm::array_choices(" (default)"));
/// --device, with the forms of device names.
void add_device(CLI::App& command, CommonOptions& o);
void add_lock_memory(CLI::App& command, bool& lock_memory);
CLI::Option* add_figure(CLI::App& command, CommonOptions& o, const std::string& help);
/// Options for reading a field's file. @param of the option that names the file, or null if the
/// file is always given.
void add_field_file(CLI::App& command, prostm::FieldFileOptions& o, CLI::Option* of = nullptr);
/// Address and port of the pages. @return the two options.
std::array<CLI::Option*, 2> add_address(CLI::App& command, RunOptionsGiven& o);
/// --hand, --hand-size and --tracker.
void add_hand(CLI::App& command, CommonOptions& common, std::string& hand,
              std::optional<double>& hand_size);
/// The options of add_common(), and those that make up a run.
void add_pipeline(CLI::App& command, CommonOptions& common, std::optional<std::string>& scene,
                  std::string& hand, std::optional<double>& hand_size);

/// A planned command that does not exist yet: answers with a sentence, not with a usage error.
void add_unbuilt(CLI::App& app, const std::string& name, const std::string& help);

// The commands of each group of the help page, with their options; a group has a folder of its own.
void add_run_commands(CLI::App& app, Work& work);
void add_plan_commands(CLI::App& app, Work& work);
void add_field_commands(CLI::App& app, Work& work);
void add_study(CLI::App& app, Work& work);
void add_devices_commands(CLI::App& app, Work& work);
void add_report_commands(CLI::App& app, Work& work);
void add_bench_commands(CLI::App& app, Work& work);

}  // namespace prostm::app
