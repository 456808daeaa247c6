#include "usage.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string_view>
#include <vector>

#include "prostm/core/input_error.hpp"
#include "prostm/core/text/nearest_name.hpp"

namespace prostm::app {
namespace {

std::vector<std::string> command_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

/// Whether a help text lists a word as a value: "the array: usx (default), autd3, or a file".
bool lists(const std::string& help, const std::string& word) {
  const std::size_t at = help.find(word);
  if (at == help.npos) return false;
  const std::string before = help.substr(0, at), after = help.substr(at + word.size());
  return (before.empty() || before.ends_with(", ") || before.ends_with("or ") ||
          before.ends_with(": ")) &&
         (after.empty() || after.starts_with(",") || after.starts_with(" ("));
}

/// Returns '; did you mean "--array autd3"?' for a word that is a value of exactly one option.
std::string did_you_mean_value(const std::string& word, const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (lists(option->get_description(), word) && !option->get_lnames().empty())
      names.push_back(option->get_lnames().front());
  return names.size() == 1 ? fmt::format("; did you mean \"--{} {}\"?", names.front(), word) : "";
}

std::string unknown_command(const CLI::App& program, const std::string& name) {
  return fmt::format("there is no command \"{}\"{}", shown_name(name),
                     did_you_mean(name, command_names(program)));
}

/// Returns the arguments that were not recognised, options without their values.
std::vector<std::string> extras_of(const CLI::App& app) {
  if (app.get_prefix_command()) return {};
  std::vector<std::string> extras = app.remaining();
  std::erase(extras, "--");
  for (std::string& extra : extras) {
    if (extra.starts_with("--")) extra.resize(std::min(extra.find('='), extra.size()));
  }
  return extras;
}

/// @param name of the command, or of the program.
std::string about_extras(const CLI::App& command, const std::string& name,
                         const std::vector<std::string>& extras) {
  // a left-over value belongs to a misspelled option
  const auto is_dashed = [](const std::string& extra) { return extra.starts_with("-"); };
  const auto option = std::ranges::find_if(extras, is_dashed);
  const bool is_option = option != extras.end();
  const std::string& extra = is_option ? *option : extras.front();
  const std::vector<std::string> inner = command_names(command), known = option_names(command);
  if (is_option && std::ranges::find(known, extra) != known.end())
    return fmt::format("{} follows --, after which no word is an option; put options before it",
                       extra);
  if (!is_option && !inner.empty())
    return fmt::format("{} has no command \"{}\"{}", name, shown_name(extra),
                       did_you_mean(extra, inner));
  std::string hint = did_you_mean(is_option ? extra : "--" + extra, known);
  if (hint.empty() && !is_option) hint = did_you_mean_value(extra, command);
  return fmt::format("{} {} \"{}\"{}", name, is_option ? "has no option" : "does not expect",
                     shown_name(extra), hint);
}

/// Returns the kind of value that an option takes, for a message about an invalid one.
std::string wanted(const CLI::Option& option, const std::string& value) {
  if (option.get_type_name() == "FLOAT") return "a number";
  const bool is_whole = value.find_first_not_of("+-0123456789") == value.npos;
  return is_whole ? "a whole number within 32 bits" : "a whole number";
}

/// Returns a sentence about an option with too many or too few values, or an invalid one.
std::string about_value(const CLI::Option& option, const std::string& name) {
  if (option.count() > 1)
    return fmt::format("{} is given {} times; give it once", name, option.count());
  if (option.count() == 0)
    return fmt::format("{} needs a value ({})", name, option.get_type_name());
  const std::string value = option.results().front();
  return fmt::format("{} is \"{}\"; it must be {}", name, shown_name(value), wanted(option, value));
}

/// Returns the parser's sentence with other words in the middle.
std::string reworded(const std::string& what, std::string_view between, const char* words,
                     const char* end = "") {
  const std::size_t at = what.find(between);
  return what.substr(0, at) + words + what.substr(at + between.size()) + end;
}

/// Returns the option that a parser's error names: its first word, or one after a few words.
std::string option_of(const std::string& what) {
  constexpr std::string_view kBefore = "Could not convert: ";
  const std::size_t start = what.starts_with(kBefore) ? kBefore.size() : 0;
  return what.substr(start, what.find_first_of(": ", start) - start);
}

/// Returns the innermost command that was parsed, or the program without one.
const CLI::App& parsed_command(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return *command;
}

/// Returns a command's name after those of its parents: "study analyse".
std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  const bool is_inner = parent != nullptr && parent->get_parent() != nullptr;
  return is_inner ? full_name(*parent) + ' ' + command.get_name() : command.get_name();
}

std::string about_error(const CLI::App& command, const CLI::ParseError& error) {
  const std::vector<std::string> inner = command_names(command);
  if (!inner.empty())
    return fmt::format("{} needs one of its commands: {}", full_name(command),
                       fmt::join(inner, ", "));
  const std::string what = error.what(), name = option_of(what);
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    return reworded(what, " excludes ", " and ", " exclude each other; leave one of them out");
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    return reworded(what, " requires ", " needs ");
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr) return what;
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    // positional arguments are files
    const std::string missing =
        option->nonpositional() ? name + " is missing" : full_name(command) + " needs a file";
    return fmt::format("{}: {}", missing, option->get_description());
  }
  const bool of_value = dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr ||
                        dynamic_cast<const CLI::ConversionError*>(&error) != nullptr;
  return of_value ? about_value(*option, name) : what;
}

}  // namespace

std::string usage_sentence(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& command = parsed_command(program);
  const bool is_program = &command == &program;
  const std::string name = is_program ? "the program" : full_name(command);
  const std::vector<std::string> strays = extras_of(program), extras = extras_of(command);
  std::string sentence;
  if (!strays.empty() && !strays.front().starts_with("-")) {
    sentence = unknown_command(program, strays.front());
  } else if (!strays.empty()) {
    sentence = about_extras(program, "the program", strays);
  } else {
    sentence = extras.empty() ? about_error(command, error) : about_extras(command, name, extras);
  }
  const bool about_command = strays.empty() && !is_program;
  return fmt::format("{}{} prostm{} --help", sentence, sentence.ends_with('?') ? " See" : "; see",
                     about_command ? " " + name : "");
}

std::string help_page(const CLI::App& program, const std::string& command) {
  // not App::help(), which returns the page of the command that was parsed: help itself
  if (command.empty())
    return program.get_formatter()->make_help(&program, "prostm", CLI::AppFormatMode::Normal);
  for (const CLI::App* known : program.get_subcommands({})) {
    if (known->get_name() == command) return known->help("prostm");
  }
  throw InputError(unknown_command(program, command));
}

}  // namespace prostm::app
